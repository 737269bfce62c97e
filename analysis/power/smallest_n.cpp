#include "analysis/power/smallest_n.h"

#include <cstddef>

namespace haptrial::analysis {
namespace {

struct Pool {
  double value{0.0};
  double weight{0.0};
  std::size_t points{1};
};

std::vector<double> rising(const std::vector<double>& values, const std::vector<double>& weights) {
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights[i]});
    while (pools.size() > 1 && pools[pools.size() - 2].value > pools.back().value) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& before = pools.back();
      const double weight = before.weight + last.weight;
      before.value = (before.value * before.weight + last.value * last.weight) / weight;
      before.weight = weight;
      before.points += last.points;
    }
  }
  std::vector<double> all;
  for (const Pool& pool : pools) {
    all.insert(all.end(), pool.points, pool.value);
  }
  return all;
}

std::optional<double> crossing(const std::vector<double>& n, const std::vector<double>& power,
                               double target) {
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (power[i] >= target) {
      if (i == 0) {
        return n.front();
      }
      const double share = (target - power[i - 1]) / (power[i] - power[i - 1]);
      return n[i - 1] + share * (n[i] - n[i - 1]);
    }
  }
  return std::nullopt;
}

}  // namespace

SmallestN smallest_n(const std::vector<PowerPoint>& points, double target) {
  std::vector<double> n, middle, low, high, weights;
  for (const PowerPoint& point : points) {
    const Share share = share_of(point.count.rejected, point.count.made);
    n.push_back(point.n);
    middle.push_back(share.value);
    low.push_back(share.low);
    high.push_back(share.high);
    weights.push_back(static_cast<double>(point.count.made));
  }
  return {crossing(n, rising(middle, weights), target), crossing(n, rising(high, weights), target),
          crossing(n, rising(low, weights), target)};
}

}  // namespace haptrial::analysis
