#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <linux/input.h>

namespace haptrial::device {

/// What an input device's records (struct input_event, as the kernel or a pipe delivers them) say
/// about one absolute axis. A value counts once its report has ended. If the kernel had to drop
/// records, the rest of that report is ignored, too.
class AxisRecords {
 public:
  explicit AxisRecords(int axis) noexcept : axis_(axis) {}

  /// Records in any pieces, in their order.
  void take(std::span<const std::byte> bytes) noexcept;
  /// The value in the last whole report that had one; nothing before the first.
  std::optional<int> value() const noexcept { return value_; }
  /// The device's own word.
  void set(int value) noexcept { value_ = value; }
  /// Whether records were dropped since the last call: the device has to be asked for its value.
  bool take_dropped() noexcept;

 private:
  void take_record(const input_event& record) noexcept;

  int axis_;
  std::array<std::byte, sizeof(input_event)> piece_{};
  std::size_t filled_{0};  // of the piece
  std::optional<int> reported_;
  std::optional<int> value_;
  bool void_{false};  // up to the end of the report
  bool dropped_{false};
};

}  // namespace haptrial::device
