#include "core/geometry/bvh_split.h"

#include <array>
#include <cmath>

#include "core/geometry/bvh_data.h"

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
  bool divides(int axis) const { return scale_[axis] > 0.0f; }

 private:
  Four low_;
  Four scale_{0.0f, 0.0f, 0.0f, 0.0f};
};

struct Cut {
  int axis{-1};  // -1: the middles all coincide
  int bin{0};    // the first bin of the right part
  FourBox left, right;
};

float cost_of(const FourBox& box, std::uint32_t count) {
  return box.half_area() * static_cast<float>((count + kWidth - 1) / kWidth);
}

/// The cheapest cut; the first and the last bin of an axis are never empty.
Cut best_cut(const Bins& bins, const Binning& binning) {
  Cut best;
  float least = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (!binning.divides(axis)) continue;
    std::array<FourBox, kBins> right;
    std::array<float, kBins> right_cost;
    FourBox hull;
    std::uint32_t count = 0;
    for (int bin = kBins - 1; bin > 0; --bin) {
      hull.add(bins.box[axis][bin]);
      count += bins.count[axis][bin];
      right[bin] = hull;
      right_cost[bin] = cost_of(hull, count);
    }
    hull = FourBox();
    count = 0;
    for (int bin = 1; bin < kBins; ++bin) {
      hull.add(bins.box[axis][bin - 1]);
      count += bins.count[axis][bin - 1];
      const float cost = right_cost[bin] + cost_of(hull, count);
      if (cost < least) {
        least = cost;
        best = {axis, bin, hull, right[bin]};
      }
    }
  }
  return best;
}

std::pair<Range, Range> part(std::span<Item> items, const Range& whole, const Binning& binning,
                             const Cut& cut) {
  Range left{whole.begin, whole.begin, cut.left, {}}, right{whole.end, whole.end, cut.right, {}};
  while (left.end < right.begin) {
    Item& item = items[left.end];
    const Four middle = item.middle();
    if (binning(middle)[cut.axis] < cut.bin) {
      left.middles.add(middle);
      ++left.end;
    } else {
      right.middles.add(middle);
      std::swap(item, items[--right.begin]);
    }
  }
  return {left, right};
}

}  // namespace

Range range_of(std::span<const Item> items, std::uint32_t begin, std::uint32_t end) {
  Range range{begin, end, {}, {}};
  for (std::uint32_t i = begin; i < end; ++i) {
    range.box.add(items[i].box);
    range.middles.add(items[i].middle());
  }
  return range;
}

std::pair<Range, Range> halve(std::span<const Item> items, const Range& whole) {
  const std::uint32_t middle = whole.begin + whole.count() / 2;
  return {range_of(items, whole.begin, middle), range_of(items, middle, whole.end)};
}

std::pair<Range, Range> split(std::span<Item> items, const Range& whole) {
  const Binning binning(whole.middles);
  Bins bins;
  for (std::uint32_t i = whole.begin; i < whole.end; ++i) {
    const FourBox box = items[i].box;
    const FourInts bin = binning(items[i].middle());
    for (int axis = 0; axis < 3; ++axis) {
      bins.box[axis][bin[axis]].add(box);
      ++bins.count[axis][bin[axis]];
    }
  }
  const Cut cut = best_cut(bins, binning);
  return cut.axis < 0 ? halve(items, whole) : part(items, whole, binning, cut);
}

}  // namespace haptrial::geometry
