#pragma once

#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychophysics/data/trials_data.h"

namespace haptrial::analysis::trials {

/// A number with its interval, if it has one.
struct Estimated {
  double value{kNotKnown};
  double low{kNotKnown}, high{kNotKnown};  // 95 %; NaN: not defined; infinite: no end

  bool known() const { return value == value; }
};

void remove_interval(Estimated& e);

/// Makes a bootstrap's interval longer where answers scatter beyond chance.
/// @param factor  1: as chance has it
void widen(Estimated& e, double factor);
/// widen() works on the logarithm here, so that a number keeps its sign.
void widen_log(Estimated& e, double factor);
/// widen() stops at the bounds of the fit here. A rate at the lower bound loses its interval:
/// samples that are drawn without lapses do not tell how many there may be.
void widen_rate(Estimated& e, double factor, const RateBounds& bounds);

}  // namespace haptrial::analysis::trials
