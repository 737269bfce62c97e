#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <span>

#include <linux/input.h>

namespace haptrial::device {

/// State of an input device's absolute axes and buttons, from its records (struct input_event, as
/// the kernel or a pipe delivers them). Values count once their report has ended. If the kernel had
/// to drop records, the rest of that report is ignored, too.
class InputReports {
 public:
  /// Records in any pieces, in their order.
  void take(std::span<const std::byte> bytes) noexcept;
  /// The value in the last whole report that had one; nothing before the first. @param axis  below
  /// ABS_CNT
  std::optional<int> axis(int axis) const noexcept {
    return whole_.axes[static_cast<std::size_t>(axis)];
  }
  /// @param button  below KEY_CNT
  bool held(int button) const noexcept { return whole_.buttons[static_cast<std::size_t>(button)]; }
  /// The device's own word.
  void set_axis(int axis, int value) noexcept;
  void set_button(int button, bool held) noexcept;
  /// Whether records were dropped since the last call: the device has to be asked for its values.
  bool take_dropped() noexcept;

 private:
  struct State {
    std::array<std::optional<int>, ABS_CNT> axes{};
    std::bitset<KEY_CNT> buttons;
  };
  void take_record(const input_event& record) noexcept;

  std::array<std::byte, sizeof(input_event)> piece_{};
  std::size_t filled_{0};  // of the piece
  State whole_;
  State reported_;    // with the report that has not ended
  bool void_{false};  // up to the end of the report
  bool dropped_{false};
};

}  // namespace haptrial::device
