#pragma once

#include <string>
#include <vector>

#include "analysis/contact/evaluation/evaluate_rendering.h"

namespace haptrial::evaluation {

/// Texts in rows as long as the heading; the first one of each names the renderer.
struct TextTable {
  std::vector<std::string> heading;
  std::vector<std::vector<std::string>> rows;
};

TextTable error_table(const Evaluation& evaluation);
TextTable cost_table(const Evaluation& evaluation);
/// Columns under each other, the first one to the left.
std::vector<std::string> text_lines(const TextTable& table);

/// A line for each identified parameter.
std::vector<std::string> identified_lines(const IdentifiedContact& found);

}  // namespace haptrial::evaluation
