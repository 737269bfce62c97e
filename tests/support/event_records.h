#pragma once

#include <linux/input.h>

#include <cstddef>
#include <cstring>
#include <vector>

namespace haptrial::test {

/// One record as the kernel's input layer delivers it.
inline void add_record(std::vector<std::byte>& bytes, int type, int code, int value) {
  input_event record{};
  record.type = static_cast<__u16>(type);
  record.code = static_cast<__u16>(code);
  record.value = value;
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof(record));
  std::memcpy(bytes.data() + size, &record, sizeof(record));
}

/// A report in which an axis has a new value.
inline std::vector<std::byte> report_of(int axis, int value) {
  std::vector<std::byte> bytes;
  add_record(bytes, EV_ABS, axis, value);
  add_record(bytes, EV_SYN, SYN_REPORT, 0);
  return bytes;
}

}  // namespace haptrial::test
