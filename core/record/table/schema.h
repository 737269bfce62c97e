#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace haptrial::record {

/// Version of the layout below. Versions 1 to 4 are still read: 1 has no practice and attempt in
/// /trials, no /frames and no /attributes; 2 has no tables of a protocol's own; 3 has no /runs and
/// no /begun; 4 has no /responses and no /devices, and knows three phases.
inline constexpr std::int64_t kSchemaVersion = 5;

enum class ColumnType : std::uint8_t { kU8, kI32, kI64, kU64, kF32, kF64, kText };

struct Column {
  const char* name;
  ColumnType type;
  std::size_t bytes;  // of one value; the fixed length of a text
  const char* unit;   // "m", "N", "ns"; "1" for a pure number, "" for a text
  const char* description;
  double resolution{0.0};  // values are rounded to its multiples [unit]; 0: stored as given
};

/// A compound dataset of the session file: one packed little-endian row for each record.
struct TableSchema {
  const char* name;
  const char* description;
  std::size_t chunk_rows;
  std::span<const Column> columns;

  std::size_t row_bytes() const;
  /// The same with chunks of another length.
  TableSchema with_chunks(std::size_t rows) const { return {name, description, rows, columns}; }
  /// Offset of the column within a row [bytes].
  /// @throws std::invalid_argument when there is none of this name.
  std::size_t offset(std::string_view column) const;
};

/// Chunk length of /samples, and of tables with a row for each tick, on a real clock: at most 0.8
/// s, so that a chunk is in the file before a second has passed; a multiple of kLiveChunkStep, no
/// longer than samples_table() has it.
inline constexpr std::size_t kLiveChunkStep = 64;
/// Rows of a chunk of /samples at most: 270 kB, within the 1 MiB chunk cache that HDF5 gives every
/// reader.
inline constexpr std::size_t kLongestChunk = 4096;
std::size_t live_chunk_rows(double rate);

/// Lengths of the text columns [bytes of UTF-8].
inline constexpr std::size_t kConditionBytes = 64;
inline constexpr std::size_t kStatusBytes = 16;
inline constexpr std::size_t kKindBytes = 32;
inline constexpr std::size_t kTextBytes = 256;
inline constexpr std::size_t kNameBytes = 64;

/// Grids of the 32-bit columns of /samples, each a tenth of a device quantum or finer.
inline constexpr double kPositionResolution = 0x1p-20;     // about 1 micrometre [m]
inline constexpr double kVelocityResolution = 0x1p-16;     // about 15 micrometres a second [m/s]
inline constexpr double kForceResolution = 0x1p-13;        // about 0.12 mN [N]
inline constexpr double kOrientationResolution = 0x1p-20;  // about 2 microradians [1]
inline constexpr double kPedalResolution = 0x1p-10;

/// @throws std::invalid_argument for a text above `bytes` or with a NUL byte.
void check_text(std::string_view text, std::size_t bytes, const char* what);

/// The nearest multiple of `resolution` (a power of two), as the 32-bit columns of a session file
/// keep it: rounding again changes nothing. Adding and subtracting 1.5 * 2^52 rounds to a whole
/// number without a call, so that loops vectorise. NaN and infinity stay.
inline double on_grid(double value, double resolution) noexcept {
  constexpr double kMagic = 0x1.8p52;
  const double steps = value / resolution;
  const double rounded = (steps + kMagic) - kMagic;
  return std::abs(steps) < 0x1p51 ? rounded * resolution : value;
}

}  // namespace haptrial::record
