#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "core/device/pedal/axis_records.h"

namespace haptrial::device {

/// One absolute axis of a Linux input device (/dev/input/eventN), or of a named pipe into which
/// another program writes the same records. One thread.
class InputAxis {
 public:
  /// As the device states it.
  struct Range {
    int lowest{0};
    int highest{0};
  };

  /// @param axis  the kernel's number
  /// @throws InputError in a sentence if the file is missing, may not be read, is neither an input
  /// device nor a pipe, or has no such axis; the sentence then lists those that it has
  InputAxis(const std::string& path, int axis);
  ~InputAxis();
  InputAxis(const InputAxis&) = delete;
  InputAxis& operator=(const InputAxis&) = delete;

  /// Waits for records, at most so long, and takes them in.
  /// @returns false when the device is gone; error() says why
  bool wait(std::chrono::milliseconds most) noexcept;
  /// The axis now; nothing before a pipe's first report.
  std::optional<int> value() const noexcept { return records_.value(); }
  /// Nothing of a pipe.
  std::optional<Range> range() const noexcept { return range_; }
  const char* error() const noexcept;

 private:
  bool ask() noexcept;

  int axis_;
  AxisRecords records_;
  std::optional<Range> range_;
  int file_{-1};
  int error_{0};  // errno; 0: the other end of the pipe was closed
};

}  // namespace haptrial::device
