#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <utility>

#include "core/geometry/mesh/four.h"

namespace haptrial::geometry {

/// A triangle while the tree is built: its box, its number in the fourth place of `low`. The number
/// is shifted to where floats are normal: vectors add it along, and denormal numbers are slow.
struct Item {
  static constexpr std::int32_t kLeastNormal = 0x00800000;
  FourBox box;

  std::int32_t triangle() const { return std::bit_cast<FourInts>(box.low)[3] - kLeastNormal; }
  void set_triangle(std::int32_t number) {
    auto bits = std::bit_cast<FourInts>(box.low);
    bits[3] = number + kLeastNormal;
    box.low = std::bit_cast<Four>(bits);
  }
  /// Twice the middle of the box.
  Four middle() const { return box.low + box.high; }
};

/// Consecutive items and the hull of their boxes.
struct Range {
  std::uint32_t begin{0}, end{0};
  FourBox box;

  std::uint32_t count() const { return end - begin; }
};

Range range_of(std::span<const Item> items, std::uint32_t begin, std::uint32_t end);

/// Divides a range of two items or more in two, sorting its items: by the binned surface-area
/// heuristic, where a part costs its surface times its leaves of sixteen triangles (Wald 2007).
/// @param scratch  as long as `items`; its part from range.begin to range.end is used
std::pair<Range, Range> split(std::span<Item> items, std::span<Item> scratch, const Range& range);

/// Divides it in the middle, whatever is where.
std::pair<Range, Range> halve(std::span<const Item> items, const Range& range);

}  // namespace haptrial::geometry
