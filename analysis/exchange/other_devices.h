#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/device_rows.h"

namespace haptrial::exchange {

/// Ticks of the devices after the first, beside those of /samples. Memory does not grow with the
/// session.
class OtherDevices {
 public:
  /// @param reader  must outlive this object
  explicit OtherDevices(const record::SessionReader& reader);

  /// How many devices there are after the first.
  std::size_t count() const { return count_; }
  /// Rows of one tick, of devices from 1 to count() alone; fewer if some have none.
  /// @param sequence  of the tick; it must rise from call to call
  std::span<const record::DeviceRow> at_tick(std::uint64_t sequence);

 private:
  const record::DeviceRow* next();

  const record::SessionReader& reader_;
  std::uint64_t rows_{0}, read_{0};
  std::size_t count_{0}, place_{0};
  std::vector<record::DeviceRow> piece_;
  std::vector<record::DeviceRow> tick_;
};

}  // namespace haptrial::exchange
