#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/record/rounding.h"
#include "core/record/row_codec.h"
#include "core/record/schema.h"

namespace haptrial::record {
namespace {

// Rows are split in batches that stay in the first-level cache.
constexpr std::size_t kBatch = 256;

/// Writes one column of a batch after the other, each from `field(sample)`.
class BatchWriter {
 public:
  BatchWriter(BytePlanes& planes, std::size_t at, std::span<const Sample> rows)
      : planes_(planes), at_(at), rows_(rows) {}

  template <typename T, typename Field>
  void integers(Field field) {
    std::array<T, kBatch> values;
    for (std::size_t i = 0; i < rows_.size(); ++i) values[i] = static_cast<T>(field(rows_[i]));
    planes_.put_column<T>(offset_, at_, std::span<const T>(values.data(), rows_.size()));
    offset_ += sizeof(T);
  }

  template <typename Field>
  void floats(double resolution, Field field) {
    std::array<double, kBatch> values;
    std::array<std::uint32_t, kBatch> bits;
    for (std::size_t i = 0; i < rows_.size(); ++i) values[i] = field(rows_[i]);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      bits[i] = std::bit_cast<std::uint32_t>(static_cast<float>(on_grid(values[i], resolution)));
    }
    planes_.put_column<std::uint32_t>(offset_, at_,
                                      std::span<const std::uint32_t>(bits.data(), rows_.size()));
    offset_ += sizeof(std::uint32_t);
  }

 private:
  BytePlanes& planes_;
  std::size_t at_;
  std::span<const Sample> rows_;
  std::size_t offset_{0};
};

/// The counterpart: reads the columns in the same order.
class BatchReader {
 public:
  BatchReader(const BytePlanes& planes, std::size_t at, std::span<Sample> rows)
      : planes_(planes), at_(at), rows_(rows) {}

  template <typename T, typename Assign>
  void integers(Assign assign) {
    std::array<T, kBatch> values;
    planes_.get_column<T>(offset_, at_, std::span<T>(values.data(), rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i) assign(rows_[i], values[i]);
    offset_ += sizeof(T);
  }

  template <typename Assign>
  void floats(Assign assign) {
    integers<std::uint32_t>([&](Sample& sample, std::uint32_t bits) {
      assign(sample, static_cast<double>(std::bit_cast<float>(bits)));
    });
  }

 private:
  const BytePlanes& planes_;
  std::size_t at_;
  std::span<Sample> rows_;
  std::size_t offset_{0};
};

void put_batch(BytePlanes& planes, std::size_t at, std::span<const Sample> rows) {
  BatchWriter to(planes, at, rows);
  to.integers<std::uint64_t>([](const Sample& s) { return s.sequence; });
  to.integers<std::uint64_t>([](const Sample& s) { return s.time_ns; });
  to.integers<std::uint32_t>([](const Sample& s) { return s.pass; });
  to.integers<std::uint8_t>([](const Sample& s) { return s.stage; });
  for (Eigen::Index a = 0; a < 3; ++a) {
    to.floats(kPositionResolution, [a](const Sample& s) { return s.position[a]; });
  }
  for (Eigen::Index a = 0; a < 3; ++a) {
    to.floats(kVelocityResolution, [a](const Sample& s) { return s.velocity[a]; });
  }
  for (Eigen::Index a = 0; a < 3; ++a) {
    to.floats(kForceResolution, [a](const Sample& s) { return s.force[a]; });
  }
  to.floats(kForceResolution, [](const Sample& s) { return s.applied_force; });
  to.floats(kForceResolution, [](const Sample& s) { return s.target_force; });
  to.integers<std::uint8_t>([](const Sample& s) { return s.saturated; });
}

void get_batch(const BytePlanes& planes, std::size_t at, std::span<Sample> rows) {
  BatchReader from(planes, at, rows);
  from.integers<std::uint64_t>([](Sample& s, std::uint64_t v) { s.sequence = v; });
  from.integers<std::uint64_t>(
      [](Sample& s, std::uint64_t v) { s.time_ns = static_cast<std::int64_t>(v); });
  from.integers<std::uint32_t>(
      [](Sample& s, std::uint32_t v) { s.pass = static_cast<std::int32_t>(v); });
  from.integers<std::uint8_t>([](Sample& s, std::uint8_t v) { s.stage = static_cast<Stage>(v); });
  for (Eigen::Index a = 0; a < 3; ++a) {
    from.floats([a](Sample& s, double v) { s.position[a] = v; });
  }
  for (Eigen::Index a = 0; a < 3; ++a) {
    from.floats([a](Sample& s, double v) { s.velocity[a] = v; });
  }
  for (Eigen::Index a = 0; a < 3; ++a) {
    from.floats([a](Sample& s, double v) { s.force[a] = v; });
  }
  from.floats([](Sample& s, double v) { s.applied_force = v; });
  from.floats([](Sample& s, double v) { s.target_force = v; });
  from.integers<std::uint8_t>([](Sample& s, std::uint8_t v) { s.saturated = v != 0; });
}

}  // namespace

void put_samples(BytePlanes& planes, std::size_t at, std::span<const Sample> rows) {
  for (std::size_t i = 0; i < rows.size(); i += kBatch) {
    put_batch(planes, at + i, rows.subspan(i, std::min(kBatch, rows.size() - i)));
  }
}

void get_samples(const BytePlanes& planes, std::size_t at, std::span<Sample> rows) {
  for (std::size_t i = 0; i < rows.size(); i += kBatch) {
    get_batch(planes, at + i, rows.subspan(i, std::min(kBatch, rows.size() - i)));
  }
}

void get_column_i64(const BytePlanes& planes, std::size_t offset, std::size_t at,
                    std::span<std::int64_t> values) {
  std::array<std::uint64_t, kBatch> bits;
  for (std::size_t i = 0; i < values.size(); i += kBatch) {
    const std::size_t count = std::min(kBatch, values.size() - i);
    planes.get_column<std::uint64_t>(offset, at + i, std::span(bits.data(), count));
    for (std::size_t k = 0; k < count; ++k) values[i + k] = static_cast<std::int64_t>(bits[k]);
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
