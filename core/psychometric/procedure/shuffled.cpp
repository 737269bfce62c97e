#include "core/psychometric/procedure/shuffled.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/random.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {
namespace {

void shuffle(std::span<double> values, RandomStream& random) {
  for (std::size_t left = values.size(); left > 1; --left) {
    std::swap(values[left - 1], values[random.below(left)]);
  }
}

}  // namespace

std::vector<double> shuffled(const ListParameters& list, std::uint64_t seed, std::string_view name,
                             const char* who) {
  checks::require(!list.levels.empty(), who, "levels must not be empty");
  checks::require(std::all_of(list.levels.begin(), list.levels.end(),
                              [](double level) { return std::isfinite(level); }),
                  who, "levels must be finite");
  checks::require(list.repetitions >= 1 && list.repetitions <= 100'000, who,
                  "repetitions must be from 1 to 100000");
  RandomStream random(seed, name);
  std::vector<double> order;
  for (int i = 0; i < list.repetitions; ++i) {
    const std::size_t begin = order.size();
    order.insert(order.end(), list.levels.begin(), list.levels.end());
    if (list.in_rounds) {
      shuffle(std::span(order).subspan(begin), random);
    }
  }
  if (!list.in_rounds) {
    shuffle(order, random);
  }
  return order;
}

}  // namespace haptrial::psychometric
