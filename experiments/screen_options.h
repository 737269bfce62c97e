#pragma once

#include <cstdint>
#include <string>

#include "core/render/text_screen.h"

namespace haptrial {
class Table;
}

namespace haptrial::experiments {

/// When the square for a photodiode is white; otherwise it is black.
enum class Photodiode : std::uint8_t {
  kOff,         // no square
  kEveryFrame,  // every other frame
  kRun,         // while the participant runs along the path
};

/// The participant's screen.
struct ScreenOptions {
  std::string title{"haptrial"};
  bool full_screen{true};  // else a window of the size in [display]
  int monitor{0};          // from 0, the primary one
  bool refresh_lock{true};
  Photodiode photodiode{Photodiode::kOff};
};

/// What the participant reads. The first line of a text is its title.
struct SessionTexts {
  std::string instructions;  // before the first trial
  std::string practice;      // before the practice trials
  std::string rest;          // during a break, above the countdown
  std::string thanks;        // at the end
};

/// Reads a [screen] table; every key is optional.
///
///     title         of the window
///     full_screen   true or false
///     monitor       from 0
///     refresh_lock  true or false: whether drawing waits for the monitor
///     photodiode    "off", "frames" (white every other frame) or "run" (white during the run)
ScreenOptions read_screen_options(Table& table);

/// Reads a [texts] table; every key is required: instructions, practice, rest, thanks.
SessionTexts read_session_texts(Table& table);

/// A page of a text. @param hint  how to go on; empty where nobody is asked to
render::TextPage page_of(const std::string& text, const std::string& hint = "");

}  // namespace haptrial::experiments
