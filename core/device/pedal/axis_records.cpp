#include "core/device/pedal/axis_records.h"

#include <cstring>
#include <utility>

namespace haptrial::device {

void AxisRecords::take(std::span<const std::byte> bytes) noexcept {
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

bool AxisRecords::take_dropped() noexcept { return std::exchange(dropped_, false); }

void AxisRecords::take_record(const input_event& record) noexcept {
  if (record.type == EV_SYN && record.code == SYN_DROPPED) {
    void_ = true;
    reported_.reset();
  } else if (record.type == EV_SYN && record.code == SYN_REPORT) {
    dropped_ = dropped_ || void_;
    value_ = reported_ ? reported_ : value_;
    reported_.reset();
    void_ = false;
  } else if (record.type == EV_ABS && record.code == axis_ && !void_) {
    reported_ = record.value;
  }
}

}  // namespace haptrial::device
