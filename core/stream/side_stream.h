#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/record/rows/rows.h"

namespace haptrial::stream {

/// Part of one row for a side stream.
struct SideSample {
  std::uint64_t sequence{0};       // of its tick
  double after{0.0};               // that tick >= 0 [s]
  std::span<const double> values;  // one for each channel; as long as the row lives
};

/// A stream beside the samples: what a protocol records in a table of its own, sent while the
/// session runs, each row at its time.
struct SideStream {
  using Take = std::function<void(const SideSample&)>;

  std::string name;                   // ends those of the stream and its source, such as "depth"
  std::string type;                   // of its content, in the layer's words, such as "EMG"
  std::string unit;                   // of all channels
  std::vector<std::string> channels;  // their labels
  double rate{0.0};                   // of its samples [Hz]; 0: they come unevenly
  /// Lines for its description: name and value.
  std::vector<std::pair<std::string, std::string>> about;
  /// Gives what rows have for the stream, in their order; nothing if they are of another table.
  /// Rows come in ascending order of their ticks. Session's thread.
  std::function<void(const record::Rows&, const Take&)> read;
};

/// SideStream::read for the rows of one table. @param sample  SideSample of a Row; its values may
/// point into the row
template <class Row, class Sample>
auto reads_rows(Sample sample) {
  return [sample](const record::Rows& rows, const SideStream::Take& take) {
    for (const Row& row : rows.as<Row>()) {
      take(sample(row));
    }
  };
}

}  // namespace haptrial::stream
