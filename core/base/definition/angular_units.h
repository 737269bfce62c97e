#pragma once

#include <optional>
#include <string_view>

#include "core/base/definition/bounds.h"

namespace haptrial {

/// The units of what is stated of a rotation, where readers ask for those of the arc that fingers
/// travel at a radius r: angles for lengths, torques for forces, and what is made of them.
///
///     1 rad -> r m,   1 N·m -> 1/r N,   1 N·m/rad -> 1/r² N/m,   1 kg·m² -> 1/r² kg
class AngularUnits {
 public:
  /// A number as it is given, in place of the one that is asked for.
  struct GivenUnit {
    std::string_view unit;
    double factor;  // of what is asked for, to what is given
    Bounds bounds(const Bounds& asked) const {
      return {asked.low / factor, asked.high / factor, asked.open_low};
    }
  };

  /// @param radius  r > 0 [m]
  explicit AngularUnits(double radius) : radius_(radius) {}
  /// Nothing where the unit is the same: "s", "Hz", none.
  /// @param unit  that a reader asks for, as Schema has it
  std::optional<GivenUnit> given_for(std::string_view unit) const;

 private:
  double radius_;
};

}  // namespace haptrial
