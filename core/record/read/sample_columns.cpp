#include "core/record/read/sample_columns.h"

#include <algorithm>
#include <array>
#include <bit>

namespace haptrial::record {
namespace {

// Rows are split in batches that stay in the first-level cache.
constexpr std::size_t kBatch = 256;

}  // namespace

void get_column_i64(const BytePlanes& planes, std::size_t offset, std::size_t at,
                    std::span<std::int64_t> values) {
  std::array<std::uint64_t, kBatch> bits;
  for (std::size_t i = 0; i < values.size(); i += kBatch) {
    const std::size_t count = std::min(kBatch, values.size() - i);
    planes.get_column<std::uint64_t>(offset, at + i, std::span(bits.data(), count));
    for (std::size_t k = 0; k < count; ++k) {
      values[i + k] = static_cast<std::int64_t>(bits[k]);
    }
  }
}

void get_column_f32(const BytePlanes& planes, std::size_t offset, std::size_t at, std::size_t count,
                    double* values, std::size_t stride) {
  std::array<std::uint32_t, kBatch> bits;
  for (std::size_t i = 0; i < count; i += kBatch) {
    const std::size_t n = std::min(kBatch, count - i);
    planes.get_column<std::uint32_t>(offset, at + i, std::span(bits.data(), n));
    for (std::size_t k = 0; k < n; ++k) {
      values[(i + k) * stride] = static_cast<double>(std::bit_cast<float>(bits[k]));
    }
  }
}

}  // namespace haptrial::record
