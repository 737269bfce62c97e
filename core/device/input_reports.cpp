#include "core/device/input_reports.h"

#include <cstring>
#include <utility>

namespace haptrial::device {

void InputReports::take(std::span<const std::byte> bytes) noexcept {
  for (const std::byte byte : bytes) {
    piece_[filled_++] = byte;
    if (filled_ == piece_.size()) {
      input_event record;
      std::memcpy(&record, piece_.data(), sizeof(record));
      take_record(record);
      filled_ = 0;
    }
  }
}

void InputReports::set_axis(int axis, int value) noexcept {
  const auto at = static_cast<std::size_t>(axis);
  whole_.axes[at] = reported_.axes[at] = value;
}

void InputReports::set_button(int button, bool held) noexcept {
  const auto at = static_cast<std::size_t>(button);
  whole_.buttons[at] = reported_.buttons[at] = held;
}

bool InputReports::take_dropped() noexcept { return std::exchange(dropped_, false); }

void InputReports::take_record(const input_event& record) noexcept {
  if (record.type == EV_SYN && record.code == SYN_DROPPED) {
    void_ = true;
    reported_ = whole_;
  } else if (record.type == EV_SYN && record.code == SYN_REPORT) {
    dropped_ = dropped_ || void_;
    whole_ = reported_;
    void_ = false;
  } else if (record.type == EV_ABS && record.code < ABS_CNT && !void_) {
    reported_.axes[record.code] = record.value;
  } else if (record.type == EV_KEY && record.code < KEY_CNT && !void_) {
    reported_.buttons[record.code] = record.value != 0;
  }
}

}  // namespace haptrial::device
