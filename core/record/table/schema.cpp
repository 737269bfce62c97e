#include "core/record/table/schema.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace haptrial::record {

std::size_t TableSchema::row_bytes() const {
  std::size_t bytes = 0;
  for (const Column& column : columns) {
    bytes += column.bytes;
  }
  return bytes;
}

std::size_t TableSchema::offset(std::string_view column) const {
  std::size_t bytes = 0;
  for (const Column& each : columns) {
    if (column == each.name) {
      return bytes;
    }
    bytes += each.bytes;
  }
  throw std::invalid_argument("no column " + std::string(column) + " in /" + name);
}

std::size_t live_chunk_rows(double rate) {
  constexpr double kLongest = 0.8;  // [s]
  const double steps = kLongest * rate / static_cast<double>(kLiveChunkStep);
  const double most = static_cast<double>(kLongestChunk / kLiveChunkStep);
  return kLiveChunkStep * static_cast<std::size_t>(std::clamp(steps, 1.0, most));
}

void check_text(std::string_view text, std::size_t bytes, const char* what) {
  if (text.size() > bytes) {
    throw std::invalid_argument(std::string(what) + " '" + std::string(text) + "' has " +
                                std::to_string(text.size()) + " bytes; allowed: at most " +
                                std::to_string(bytes));
  }
  if (text.find('\0') != std::string_view::npos) {
    throw std::invalid_argument(std::string(what) + " holds a NUL byte; remove it");
  }
}

}  // namespace haptrial::record
