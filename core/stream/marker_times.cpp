#include "core/stream/marker_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::markers {
namespace {

double nearest_rank(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double rank = std::max(1.0, std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[static_cast<std::size_t>(rank) - 1];
}

}  // namespace

void MarkerLatencies::add(std::span<const record::MarkerRow> rows) {
  for (const record::MarkerRow& row : rows) {
    if (row.way == record::MarkerOutput::kNone) {
      continue;
    }
    OutputDelays& way = outputs_[row.way];
    if (std::isnan(row.latency)) {
      ++way.lost;
    } else {
      way.latencies.push_back(row.latency);
    }
  }
}

void MarkerLatencies::add(const MarkerLatencies& others) {
  for (const auto& [which, other] : others.outputs_) {
    OutputDelays& way = outputs_[which];
    way.lost += other.lost;
    way.latencies.insert(way.latencies.end(), other.latencies.begin(), other.latencies.end());
  }
}

std::vector<MarkerTimes> MarkerLatencies::times() const {
  std::vector<MarkerTimes> all;
  for (const auto& [which, way] : outputs_) {
    std::vector<double> sorted = way.latencies;
    std::ranges::sort(sorted);
    all.push_back({which, sorted.size(), way.lost, nearest_rank(sorted, 0.5),
                   nearest_rank(sorted, 0.99), nearest_rank(sorted, 1.0)});
  }
  return all;
}

std::string sentence_of(const MarkerTimes& times) {
  const std::string name = record::name_of(times.way);
  const std::string lost = times.lost > 0 ? fmt::format("; {} did not go", times.lost) : "";
  return times.sent == 0
             ? fmt::format("{}: no marker{}", name, lost)
             : fmt::format(
                   "{}: {} markers, median {:.3f} ms, 99 % {:.3f} ms, largest {:.3f} ms "
                   "after their tick{}",
                   name, times.sent, 1e3 * times.median, 1e3 * times.p99, 1e3 * times.largest,
                   lost);
}

}  // namespace haptrial::markers
