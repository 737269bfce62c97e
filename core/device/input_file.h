#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "core/device/input_reports.h"

namespace haptrial::device {

/// A Linux input device (/dev/input/eventN), or a named pipe into which another program writes the
/// same records. One thread.
class InputFile {
 public:
  /// Range of an axis, as the device states it.
  struct Range {
    int lowest{0};
    int highest{0};
  };

  /// @param table  of the definition that names the file, as "pedal": sentences begin with it
  /// @throws InputError in a sentence if the file is missing, may not be read, or is neither an
  /// input device nor a pipe
  InputFile(std::string path, std::string table);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Range of an axis, whose value is known from now on: of a device at once, of a pipe from its
  /// first report on. @returns nothing of a pipe
  /// @throws InputError if a device has no such axis; the sentence lists those that it has
  std::optional<Range> follow_axis(int axis);
  /// Range of an axis; nothing if a device has no such axis.
  std::optional<Range> find_axis(int axis);
  /// The same of buttons. A device need not have them.
  void follow_buttons();
  bool is_pipe() const noexcept { return pipe_; }

  /// Waits for records, at most so long, and takes them in.
  /// @returns false when the device is gone; error() says why
  bool wait(std::chrono::milliseconds most) noexcept;
  const InputReports& reports() const noexcept { return reports_; }
  const char* error() const noexcept;

 private:
  [[noreturn]] void refuse(const std::string& why) const;
  std::optional<Range> ask_axis(int axis) noexcept;
  void ask_buttons() noexcept;

  std::string path_;
  std::string table_;
  InputReports reports_;
  std::vector<int> axes_;  // that are followed
  bool buttons_{false};    // likewise
  bool pipe_{false};
  int file_{-1};
  int error_{0};  // errno; 0: the other end of the pipe was closed
};

}  // namespace haptrial::device
