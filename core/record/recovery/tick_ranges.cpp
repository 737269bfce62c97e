#include "core/record/recovery/tick_ranges.h"

#include <algorithm>

namespace haptrial::record {

const TickRange* TickRanges::find(std::uint64_t sequence) const {
  const auto at = std::lower_bound(
      ranges_.begin(), ranges_.end(), sequence,
      [](const TickRange& range, std::uint64_t value) { return range.last < value; });
  return at != ranges_.end() && at->first <= sequence ? &*at : nullptr;
}

bool TickRanges::holds(std::uint64_t first, std::uint64_t last) const {
  const TickRange* range = find(first);
  return range != nullptr && range->last >= last;
}

std::uint64_t TickRanges::end_of_range(std::uint64_t sequence) const {
  const TickRange* range = find(sequence);
  return range != nullptr ? range->last : sequence;
}

TickRanges TickRanges::shared_with(const TickRanges& other) const {
  TickRanges shared;
  std::size_t at = 0;
  for (const TickRange& range : ranges_) {
    while (at < other.ranges_.size() && other.ranges_[at].last < range.first) {
      ++at;
    }
    for (std::size_t i = at; i < other.ranges_.size() && other.ranges_[i].first <= range.last;
         ++i) {
      shared.ranges_.push_back({std::max(range.first, other.ranges_[i].first),
                                std::min(range.last, other.ranges_[i].last)});
    }
  }
  return shared;
}

}  // namespace haptrial::record
