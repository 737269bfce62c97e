#pragma once

#include <memory>

#include "experiments/control/session_control.h"

namespace haptrial::experiments {

/// Puts the terminal back at once, for a signal handler that is about to let the program die.
/// Async-signal-safe; does nothing where no Keyboard reads.
void restore_terminal() noexcept;

/// The console's keys in the terminal: single keys, read on a thread of its own, asked of the same
/// SessionControl. While a pass runs whose study has live figures, a line says them once a second.
/// The terminal is put back at the end, on fatal signals that nobody else handles, and when a
/// library calls exit(). Ctrl-C still interrupts. Ctrl-Z does nothing while it lives: a program
/// that is suspended would leave its last force on. Ctrl-S likewise.
class Keyboard {
 public:
  /// Quiet where `input` is no terminal or the program runs in the background. At most one at a
  /// time reads a terminal. @param control  outlives the keyboard.
  /// @param output  where the note that is typed is shown; -1: nowhere
  explicit Keyboard(SessionControl& control, int input = 0, int output = 2);
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// Whether the input is a terminal, with the program in its foreground.
  static bool can_read(int input = 0);

  /// Whether keys are read.
  bool active() const;

  /// A line that names the keys.
  static const char* help();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace haptrial::experiments
