#include "core/subject/perceiver/sight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/random.h"

namespace haptrial::subject {

double weight_of(const Cue& a, const Cue& b) noexcept {
  if (a.spread == b.spread) {
    return 0.5;
  }
  // The ratio alone counts, so that neither tiny nor infinite spreads overflow.
  const double ratio = a.spread / b.spread;
  return 1.0 / (1.0 + ratio * ratio);
}

Cue combine(const Cue& a, const Cue& b) noexcept {
  const double w = weight_of(a, b);
  Cue both;
  both.estimate = w == 0.0   ? b.estimate
                  : w == 1.0 ? a.estimate
                             : w * a.estimate + (1.0 - w) * b.estimate;
  // sigma^2 = w_a sigma_a^2; from the more reliable cue, whose spread is finite if any is.
  both.spread = a.spread <= b.spread ? std::sqrt(w) * a.spread : std::sqrt(1.0 - w) * b.spread;
  return both;
}

const Schema<SightParameters>& sight_schema() {
  using S = SightParameters;
  static const auto schema =
      Schema<S>()
          .numbers("noise", &S::noise, kNonNegative, "",
                   "Noises of a picture at which `sd` is known, rising")
          .required()
          .numbers("sd", &S::sd, kPositive, "m",
                   "Standard deviation of a seen size at each of the noises of the picture")
          .required()
          .number("spread", &S::spread, {0.0, 2.0}, "",
                  "Standard deviation of the precision of sight between people, as a logarithm")
          .check([](Table& table, S& sight) {
            try {
              check(sight);
            } catch (const std::invalid_argument& error) {
              table.reject("noise", fmt::format("cannot be used with sd: {}", error.what()));
            }
          });
  return schema;
}

void check(const SightParameters& sight) {
  const bool rising = std::adjacent_find(sight.noise.begin(), sight.noise.end(),
                                         std::greater_equal<>()) == sight.noise.end();
  if (sight.noise.empty() || !rising) {
    throw std::invalid_argument("noise must be one or more rising numbers");
  }
  if (sight.sd.size() != sight.noise.size()) {
    throw std::invalid_argument("sd must have as many numbers as noise");
  }
  if (std::any_of(sight.sd.begin(), sight.sd.end(), [](double sd) { return !(sd > 0.0); })) {
    throw std::invalid_argument("sd must be above 0");
  }
  if (!(sight.spread >= 0.0)) {
    throw std::invalid_argument("spread must be at least 0");
  }
}

Sight::Sight(const SightParameters& sight, std::uint64_t seed) : sight_(sight) {
  check(sight_);
  RandomStream random(seed, "observer sight");
  factor_ = std::exp(sight_.spread * random.normal());
}

double Sight::spread_at(double noise) const noexcept {
  const std::vector<double>& x = sight_.noise;
  const auto above =
      static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), noise) - x.begin());
  if (above == 0) {
    return factor_ * sight_.sd.front();
  }
  if (above == x.size()) {
    return factor_ * sight_.sd.back();
  }
  const double share = (noise - x[above - 1]) / (x[above] - x[above - 1]);
  return factor_ * ((1.0 - share) * sight_.sd[above - 1] + share * sight_.sd[above]);
}

Cue Sight::see(double size, double noise, double deviate) const noexcept {
  const double spread = spread_at(noise);
  return {size + spread * deviate, spread};
}

}  // namespace haptrial::subject
