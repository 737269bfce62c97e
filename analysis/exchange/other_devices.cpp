#include "analysis/exchange/other_devices.h"

#include <algorithm>

#include "core/record/read/session_reader.h"

namespace haptrial::exchange {
namespace {

constexpr std::uint64_t kRowsOfDevices = 32768;  // rows read at a time

}  // namespace

OtherDevices::OtherDevices(const record::SessionReader& reader)
    : reader_(reader), rows_(reader.count<record::DeviceRow>()) {
  if (next() != nullptr) {
    const auto last = std::ranges::max_element(piece_, {}, &record::DeviceRow::device);
    count_ = static_cast<std::size_t>(std::max(last->device, 0));
  }
}

const record::DeviceRow* OtherDevices::next() {
  if (place_ == piece_.size() && read_ < rows_) {
    const std::uint64_t count = std::min(kRowsOfDevices, rows_ - read_);
    piece_ = reader_.rows<record::DeviceRow>(read_, count);
    read_ += count;
    place_ = 0;
  }
  return place_ < piece_.size() ? &piece_[place_] : nullptr;
}

std::span<const record::DeviceRow> OtherDevices::at_tick(std::uint64_t sequence) {
  tick_.clear();
  for (const record::DeviceRow* row = next(); row != nullptr && row->sequence <= sequence;
       row = next()) {
    const bool known = row->device >= 1 && static_cast<std::size_t>(row->device) <= count_;
    if (row->sequence == sequence && known) {
      tick_.push_back(*row);
    }
    ++place_;
  }
  return tick_;
}

}  // namespace haptrial::exchange
