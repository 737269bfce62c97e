#pragma once

namespace haptrial::subject {

/// One sense's estimate of a quantity.
struct Cue {
  double estimate{0.0};  // [unit of the quantity]
  double spread{1.0};    // sigma > 0, its standard deviation [same unit]
};

/// The estimate of least variance from two independent cues:
///
///     s = w_a s_a + w_b s_b,   w_i = sigma_i^-2 / (sigma_a^-2 + sigma_b^-2)
///     sigma^2 = sigma_a^2 sigma_b^2 / (sigma_a^2 + sigma_b^2)
///
/// A cue of spread 0 decides alone, two of them equally; a cue of infinite spread says nothing.
/// Source: Ernst and Banks 2002, Nature 415, eqs. 1 and 2. Servo thread.
Cue combine(const Cue& a, const Cue& b) noexcept;

/// w_a, the weight of the first cue.
double weight_of(const Cue& a, const Cue& b) noexcept;

}  // namespace haptrial::subject
