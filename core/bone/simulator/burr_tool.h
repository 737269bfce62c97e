#pragma once

#include <optional>

#include "core/bone/drill/burr.h"
#include "core/bone/drill/feel.h"

namespace haptrial::bone {

/// The part of a tool behind its burr or its opening, as far as bone feels it and is not cut.
struct ShaftParameters {
  double radius{1e-3};    // > 0 [m]
  double length{0.02};    // from the burr's or the opening's end on > 0 [m]
  FeelParameters feel{};  // default_feel() of the ball of its volume
  BurrForm form{BurrForm::kRod};
  double thickness{0.0};  // of a blade > 0 [m]

  BurrDimensions dimensions() const noexcept { return {form, 2.0 * radius, length, thickness}; }
};
/// A shaft with the default feel. @throws std::invalid_argument where a number is not above 0.
ShaftParameters default_shaft(double radius, double length);

struct BurrTool {
  BurrParameters burr{};
  FeelParameters feel{};
  std::optional<ShaftParameters> shaft{};                         // none: it is not felt
  double radius() const noexcept { return 0.5 * burr.diameter; }  // [m]
};

}  // namespace haptrial::bone
