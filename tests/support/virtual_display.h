#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace haptrial::test {

/// An X server without a monitor (Xvfb) on a display of its own, named by DISPLAY while it lives,
/// with a person at its keyboard and mouse.
class VirtualDisplay {
 public:
  /// @throws std::runtime_error when the server does not start within 20 s.
  VirtualDisplay(int width, int height);
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// Ends the server, as a logout does.
  void end();
  /// Picture of the monitor from the server's own memory, not by OpenGL.
  std::vector<std::uint8_t> screenshot() const;  // (height x width x 3), rows from the top
  int width() const { return width_; }
  int height() const { return height_; }

  /// Gives keys other characters, as another layout does, for windows that open later: the key of
  /// each first keysym types the second one instead.
  void relabel_keys(const std::vector<std::pair<unsigned long, unsigned long>>& labels) const;
  /// Presses a key in the window of that title. @param keysym  as X names it: 'p', ' ', 0xff1b for
  /// Escape
  void press_key(const std::string& title, unsigned long keysym) const;  // and let it go
  static constexpr unsigned long kEnter = 0xff0d;
  static constexpr unsigned long kEscape = 0xff1b;
  /// Presses a key if the window is there yet.
  void try_key(const std::string& title, unsigned long keysym) const;
  void hold_key(const std::string& title, unsigned long keysym) const;
  void release_key(const std::string& title, unsigned long keysym) const;
  /// @param button  1 left, 2 middle, 3 right, 4 and 5 the wheel up and down
  void press_button(const std::string& title, unsigned button) const;  // and hold it
  void release_button(const std::string& title, unsigned button) const;
  void ask_to_close(const std::string& title) const;    // as a window manager does
  void destroy_window(const std::string& title) const;  // as another program may
  void move_pointer(int x, int y) const;                // [px]

 private:
  TemporaryFolder folder_;
  int width_;
  int height_;
  pid_t server_{-1};
};

}  // namespace haptrial::test
