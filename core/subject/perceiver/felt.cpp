#include "core/subject/perceiver/felt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace haptrial::subject {

void check(const SenseParameters& p) {
  const auto require = [](bool good, const char* what) {
    if (!good) {
      throw std::invalid_argument(std::string("senses: ") + what);
    }
  };
  const auto spread = [](double x) { return x >= 0.0 && std::isfinite(x); };
  const auto size = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(spread(p.force_weber), "force_weber must be at least 0");
  require(spread(p.force_floor), "force_floor must be at least 0");
  require(p.displacement_bias >= 0.0 && p.displacement_bias < 1.0,
          "displacement_bias must be at least 0 and below 1");
  require(spread(p.displacement_weber), "displacement_weber must be at least 0");
  require(spread(p.speed_weber), "speed_weber must be at least 0");
  require(spread(p.extent_weber), "extent_weber must be at least 0");
  require(spread(p.frequency_weber), "frequency_weber must be at least 0");
  require(spread(p.mass_weber), "mass_weber must be at least 0");
  require(spread(p.duration_weber), "duration_weber must be at least 0");
  require(size(p.usual_deflection), "usual_deflection must be above 0");
  require(spread(p.contact_force), "contact_force must be at least 0");
  require(size(p.moving_speed), "moving_speed must be above 0");
}

FeltNoise draw_noise(RandomStream& random) noexcept {
  FeltNoise n;
  n.force = random.normal();
  n.floor = random.normal();
  n.displacement = random.normal();
  n.speed = random.normal();
  n.amount = random.normal();
  return n;
}

std::optional<double> weber_at_once(const SenseParameters& s, Quantity quantity) noexcept {
  switch (quantity) {
    case Quantity::kExtent:
    case Quantity::kUnevenness:
      return s.extent_weber;
    case Quantity::kFrequency:
      return s.frequency_weber;
    case Quantity::kMass:
      return s.mass_weber;
    case Quantity::kDuration:
      return s.duration_weber;
    default:
      return std::nullopt;
  }
}

double felt(const SenseParameters& s, Quantity quantity, const ContactEpisode& met,
            const FeltNoise& n) noexcept {
  const double gain = std::exp(s.force_weber * n.force);
  if (quantity == Quantity::kForce || quantity == Quantity::kFriction ||
      quantity == Quantity::kRoughness) {
    return met.amount * gain + s.force_floor * n.floor;
  }
  if (const std::optional<double> weber = weber_at_once(s, quantity)) {
    return met.amount * std::exp(*weber * n.amount);
  }
  if (quantity == Quantity::kContrast) {
    return met.amount *
           std::exp(std::numbers::sqrt2 * s.force_weber * n.force / (1.0 - s.displacement_bias));
  }
  // The force of a stiffness or a viscosity, relative to what it was; never a pull.
  const double floor = met.force > 0.0 ? s.force_floor * n.floor / met.force : 0.0;
  const double force = std::max(0.0, gain + floor);
  if (quantity == Quantity::kViscosity) {
    return met.amount * force * std::exp(-s.speed_weber * n.speed);
  }
  double stiffness = 0.0;
  if (met.amount > 0.0) {
    const double deflection = met.force / (met.amount * s.usual_deflection);  // D / D_0
    const double unfelt = deflection > 0.0 ? std::pow(deflection, s.displacement_bias) : 1.0;
    stiffness = met.amount * unfelt * force * std::exp(-s.displacement_weber * n.displacement);
  }
  if (quantity == Quantity::kStiffness) {
    return stiffness;
  }
  return stiffness > 0.0 ? 1.0 / stiffness : std::numeric_limits<double>::infinity();
}

}  // namespace haptrial::subject
