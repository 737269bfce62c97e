#include "core/base/definition/angular_units.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptrial {
namespace {

struct Pair {
  std::string_view along;  // the arc
  std::string_view about;  // the axis
  int power;               // of the radius, from what is given to what is asked for
};

constexpr std::array<Pair, 10> kPairs{{{"m", "rad", 1},
                                       {"m/s", "rad/s", 1},
                                       {"1/m", "1/rad", -1},
                                       {"N", "N·m", -1},
                                       {"N/s", "N·m/s", -1},
                                       {"N/m", "N·m/rad", -2},
                                       {"N·s/m", "N·m·s/rad", -2},
                                       {"kg", "kg·m²", -2},
                                       {"1/kg", "1/(kg·m²)", 2},
                                       {"m/N", "rad/(N·m)", 2}}};

}  // namespace

std::optional<AngularUnits::GivenUnit> AngularUnits::given_for(std::string_view unit) const {
  const auto* const pair = std::ranges::find(kPairs, unit, &Pair::along);
  if (pair == kPairs.end()) {
    return std::nullopt;
  }
  return GivenUnit{pair->about, std::pow(radius_, pair->power)};
}

}  // namespace haptrial
