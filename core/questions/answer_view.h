#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::questions {

/// A scale that is answered with a mark.
struct ScaleView {
  int steps{20};  // from end to end, >= 1
  std::string low_end, high_end;
  std::vector<std::string> numbers{};  // at the ticks, one for each; empty: none
  double length{0.0};  // of the line, of the screen's width; 0: as the text's column
};

/// A line of a small figure, from one point to another. The figure is a square: x to the right and
/// y up, each from -1 to 1.
struct FigureLine {
  std::array<double, 2> from{}, to{};
  bool marked{false};  // in the colour of what is chosen
};

/// Content of the screen below a question's text: how it is answered, and the answer so far. Every
/// kind of question is drawn from these parts, on pages and in trials alike; what none of them
/// shows, such as a picture, needs a part of its own here and in text_screen.cpp.
struct AnswerView {
  std::vector<std::string> choices{};  // lines below each other
  std::optional<ScaleView> scale{};    // below them
  std::vector<FigureLine> figure{};    // likewise
  std::optional<std::string> typed{};  // likewise; a cursor follows
  int chosen{-1};                      // choice, or step of the scale; -1: none yet
};

}  // namespace haptrial::questions
