#pragma once

#include <cstdint>
#include <vector>

#include "core/base/definition/schema_forward.h"

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

/// How well a size is seen: the standard deviation at each noise of the picture.
struct SightParameters {
  std::vector<double> noise;  // rising, at least one
  std::vector<double> sd;     // (noise) > 0 [m]
  double spread{0.0};         // between people: sd of the log of a factor on all of them >= 0
};

/// The keys of [observer.sight].
const Schema<SightParameters>& sight_schema();

/// @throws std::invalid_argument naming what breaks its bound.
void check(const SightParameters& sight);

/// The eyes of one person. Servo thread after construction: no allocation, lock, I/O or throw.
class Sight {
 public:
  /// @param sight  passes check(). @param seed  of the person; the stream is "observer sight"
  Sight(const SightParameters& sight, std::uint64_t seed);
  /// The standard deviation at a noise: straight lines between those that are known, the outermost
  /// ones beyond them [m].
  double spread_at(double noise) const noexcept;
  /// Visual estimate of a size. @param deviate  standard normal
  Cue see(double size, double noise, double deviate) const noexcept;

 private:
  SightParameters sight_;
  double factor_{1.0};
};

}  // namespace haptrial::subject
