#include "analysis/exchange/pass_spans.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ranges>

#include "core/record/read/session_reader.h"

namespace haptrial::exchange {
namespace {

/// Times of single ticks on the session's clock.
class TickTimes {
 public:
  explicit TickTimes(const record::SessionReader& reader)
      : reader_(reader),
        rows_(reader.sample_count()),
        first_(rows_ > 0 ? sample_of(0).sequence : 0) {}

  /// A tick that the file lacks is as far after the last one before it as its number says. [ns]
  std::int64_t time_of(std::uint64_t sequence) const {
    if (rows_ == 0 || sequence < first_) {
      return length_of(sequence);
    }
    const record::Sample last = last_until(sequence);
    return last.time_ns + length_of(sequence - last.sequence);
  }
  /// Duration of a number of ticks [ns].
  std::int64_t length_of(std::uint64_t ticks) const {
    return std::llround(1e9 * static_cast<double>(ticks) / reader_.info().rate);
  }

 private:
  record::Sample sample_of(std::uint64_t row) const { return reader_.samples(row, 1).front(); }

  /// Without gaps it is in the row of its number.
  record::Sample last_until(std::uint64_t sequence) const {
    const std::uint64_t latest = std::min(sequence - first_, rows_ - 1);
    const record::Sample sample = sample_of(latest);
    if (sample.sequence <= sequence) {
      return sample;
    }
    const auto rows = std::views::iota(std::uint64_t{0}, latest);
    const auto after = std::ranges::partition_point(
        rows, [&](std::uint64_t row) { return sample_of(row).sequence <= sequence; });
    return sample_of(static_cast<std::uint64_t>(after - rows.begin()) - 1);
  }

  const record::SessionReader& reader_;
  std::uint64_t rows_;
  std::uint64_t first_;
};

}  // namespace

std::vector<PassSpan> pass_spans(const record::SessionReader& reader) {
  const TickTimes times(reader);
  std::vector<PassSpan> spans;
  for (const record::PassRow& pass : reader.passes()) {
    const std::int64_t begin = times.time_of(pass.first_sample);
    const std::int64_t end = pass.last_sample < pass.first_sample
                                 ? begin
                                 : times.time_of(pass.last_sample) + times.length_of(1);
    spans.push_back({static_cast<double>(begin) / 1e9, static_cast<double>(end - begin) / 1e9});
  }
  return spans;
}

}  // namespace haptrial::exchange
