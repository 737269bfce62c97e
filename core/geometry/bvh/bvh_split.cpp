#include "core/geometry/bvh/bvh_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/bvh/bvh_data.h"

namespace haptrial::geometry {
namespace {

constexpr int kBins = 16;

/// Bins along the three axes at once.
struct Bins {
  FourBox box[3][kBins];
  std::uint32_t count[3][kBins]{};
};

/// Which bin a middle falls in, for each axis.
class Binning {
 public:
  /// @param middles  a box around twice the middles
  explicit Binning(const FourBox& middles) : low_(middles.low) {
    for (int axis = 0; axis < 3; ++axis) {
      const float side = middles.high[axis] - middles.low[axis];
      const float scale = kBins * 0.99999f / side;
      scale_[axis] = side > 0.0f && std::isfinite(scale) ? scale : 0.0f;
    }
  }
  FourInts operator()(Four middle) const {
    return __builtin_convertvector((middle - low_) * scale_, FourInts);
  }
  int along(int axis, const Item& item) const {
    const float middle = item.box.low[axis] + item.box.high[axis];
    return static_cast<int>((middle - low_[axis]) * scale_[axis]);
  }

 private:
  Four low_;
  Four scale_{0.0f, 0.0f, 0.0f, 0.0f};
};

struct Cut {
  int axis{-1};  // -1: all are in one bin
  int bin{0};    // the first bin of the right part
  FourBox left, right;
};

float cost_of(const FourBox& box, std::uint32_t count) {
  return box.half_area() * static_cast<float>((count + kWidth - 1) / kWidth);
}

/// The cheapest cut with something on either side.
Cut best_cut(const Bins& bins) {
  Cut best;
  constexpr float kNever = std::numeric_limits<float>::infinity();
  float least = kNever;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<FourBox, kBins> right;
    std::array<float, kBins> right_cost;
    FourBox hull;
    std::uint32_t count = 0;
    for (int bin = kBins - 1; bin > 0; --bin) {
      hull.add(bins.box[axis][bin]);
      count += bins.count[axis][bin];
      right[bin] = hull;
      right_cost[bin] = count == 0 ? kNever : cost_of(hull, count);
    }
    hull = FourBox();
    count = 0;
    for (int bin = 1; bin < kBins; ++bin) {
      hull.add(bins.box[axis][bin - 1]);
      count += bins.count[axis][bin - 1];
      const float cost = right_cost[bin] + (count == 0 ? kNever : cost_of(hull, count));
      if (cost < least) {
        least = cost;
        best = {axis, bin, hull, right[bin]};
      }
    }
  }
  return best;
}

Cut find_cut(std::span<const Item> items, const Binning& binning) {
  Bins bins;
  for (const Item& item : items) {
    const FourInts bin = binning(item.middle());
    for (int axis = 0; axis < 3; ++axis) {
      bins.box[axis][bin[axis]].add(item.box);
      ++bins.count[axis][bin[axis]];
    }
  }
  return best_cut(bins);
}

/// Each item goes to both sides and only one of them moves on: no branch to guess.
std::size_t sort_apart(std::span<Item> items, Item* scratch, const Binning& binning,
                       const Cut& cut) {
  std::size_t left = 0, right = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item item = items[i];
    const bool is_left = binning.along(cut.axis, item) < cut.bin;
    items[left] = item;
    scratch[right] = item;
    left += is_left ? 1 : 0;
    right += is_left ? 0 : 1;
  }
  std::copy_n(scratch, right, items.data() + left);
  return left;
}

FourBox middles_of(std::span<const Item> items) {
  FourBox middles;
  for (const Item& item : items) {
    middles.add(item.middle());
  }
  return middles;
}

}  // namespace

Range range_of(std::span<const Item> items, std::uint32_t begin, std::uint32_t end) {
  Range range{begin, end, {}};
  for (std::uint32_t i = begin; i < end; ++i) {
    range.box.add(items[i].box);
  }
  return range;
}

std::pair<Range, Range> halve(std::span<const Item> items, const Range& range) {
  const std::uint32_t middle = range.begin + range.count() / 2;
  return {range_of(items, range.begin, middle), range_of(items, middle, range.end)};
}

std::pair<Range, Range> split(std::span<Item> items, std::span<Item> scratch, const Range& range) {
  const std::span<Item> own = items.subspan(range.begin, range.count());
  const Four two = all_four(2.0f);
  Binning binning({two * range.box.low, two * range.box.high});
  Cut cut = find_cut(own, binning);
  if (cut.axis < 0) {  // large triangles one upon the other: look closer
    binning = Binning(middles_of(own));
    cut = find_cut(own, binning);
  }
  if (cut.axis < 0) {
    return halve(items, range);
  }
  const auto left =
      static_cast<std::uint32_t>(sort_apart(own, scratch.data() + range.begin, binning, cut));
  return {{range.begin, range.begin + left, cut.left}, {range.begin + left, range.end, cut.right}};
}

}  // namespace haptrial::geometry
