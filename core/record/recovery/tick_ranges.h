#pragma once

#include <cstdint>
#include <vector>

namespace haptrial::record {

/// Ticks that follow one another; both inclusive.
struct TickRange {
  std::uint64_t first{0};
  std::uint64_t last{0};
};

/// Sequence numbers as ranges, in ascending order.
class TickRanges {
 public:
  /// @param sequence  above all that were added before
  void add(std::uint64_t sequence) {
    if (!ranges_.empty() && ranges_.back().last + 1 == sequence) {
      ranges_.back().last = sequence;
    } else {
      ranges_.push_back({sequence, sequence});
    }
  }
  const std::vector<TickRange>& ranges() const { return ranges_; }

  bool holds(std::uint64_t first, std::uint64_t last) const;
  /// The ticks that both have.
  TickRanges shared_with(const TickRanges& other) const;
  /// The last tick of the range that has `sequence`; `sequence` itself where none has.
  std::uint64_t end_of_range(std::uint64_t sequence) const;

 private:
  const TickRange* find(std::uint64_t sequence) const;
  std::vector<TickRange> ranges_;
};

}  // namespace haptrial::record
