#include "core/bone/drill/burr.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/definition/table.h"

namespace haptrial::bone {
namespace {

constexpr Bounds kDiameter{0.0005, 0.03};
constexpr double kMostSamples = 1e6;
constexpr double kSphere = std::numbers::pi / 6.0;  // volume over diameter^3

double least_spacing(double diameter) { return diameter * std::cbrt(kSphere / kMostSamples); }

void check(const BurrParameters& p) {
  const auto need = [](bool good, const char* name, double value, const char* allowed) {
    if (!good) {
      throw std::invalid_argument(fmt::format("Burr: {} is {}; allowed: {}", name, value, allowed));
    }
  };
  need(p.diameter >= kDiameter.low && p.diameter <= kDiameter.high, "diameter", p.diameter,
       "from 0.0005 to 0.03 [m]");
  need(p.sample_spacing >= least_spacing(p.diameter) && p.sample_spacing <= 0.5 * p.diameter,
       "sample_spacing", p.sample_spacing, "at most half of the diameter, and 1e6 samples [m]");
  need(p.removal_rate >= 0.0 && p.removal_rate < 1e6, "removal_rate", p.removal_rate,
       "from 0 to 1e6 [1/(N·s)]");
  need(p.falloff >= 0.0 && p.falloff < 1e6, "falloff", p.falloff, "from 0 to 1e6 [1/(N·s·rad)]");
  need(p.tangential_gain >= 0.0 && std::isfinite(p.tangential_gain), "tangential_gain",
       p.tangential_gain, "at least 0 [N/m^4]");
}

/// Evenly spread places in a unit cube: the additive recurrence of Roberts (2018).
class Places {
 public:
  Eigen::Vector3d next() {
    for (int axis = 0; axis < 3; ++axis) {
      at_[axis] += kStep[static_cast<std::size_t>(axis)];
      at_[axis] -= std::floor(at_[axis]);
    }
    return at_;
  }

 private:
  // Powers of 1 / 1.2207440846057596, the root of x^4 = x + 1.
  static constexpr std::array<double, 3> kStep{0.8191725133961645, 0.6710436067037893,
                                               0.5497004779019703};
  Eigen::Vector3d at_{0.5, 0.5, 0.5};
};

/// Half of the samples, in units of the radius: those in cells of the upper half, row by row.
std::vector<Eigen::Vector3d> half_of_samples(double cell) {
  const int reach = static_cast<int>(std::ceil(1.0 / cell));
  std::vector<Eigen::Vector3d> samples;
  Places places;
  for (int k = 0; k < reach; ++k) {
    for (int j = -reach; j < reach; ++j) {
      for (int i = -reach; i < reach; ++i) {
        const Eigen::Vector3d at = cell * (Eigen::Vector3d(i, j, k) + places.next());
        if (at.squaredNorm() <= 1.0 && at.squaredNorm() > 0.0) {
          samples.push_back(at);
        }
      }
    }
  }
  return samples;
}

std::int16_t rounded(double value) { return static_cast<std::int16_t>(std::lround(value)); }

}  // namespace

BurrParameters default_burr(BurrKind kind, double diameter) {
  BurrParameters p;
  p.kind = kind;
  p.diameter = diameter;
  // Small burrs need as many samples as large ones to push as evenly.
  p.sample_spacing = std::min(0.25e-3, diameter / 28.0);
  const bool cutting = kind == BurrKind::kCutting;
  p.removal_rate = cutting ? 25.0 : 10.0;
  p.falloff = cutting ? 12.0 : 2.0;
  const double radius = 0.5 * diameter;
  p.tangential_gain = (cutting ? 1.2e6 : 0.4e6) / (radius * radius);
  return p;
}

BurrParameters read_burr_parameters(Table& table) {
  const BurrKind kind = table.choice("kind", {"diamond", "cutting"}) == "cutting"
                            ? BurrKind::kCutting
                            : BurrKind::kDiamond;
  BurrParameters p = default_burr(kind, table.number("diameter", kDiameter, "m"));
  const auto optional = [&](const char* key, const Bounds& bounds, const char* unit,
                            double& value) { value = table.number_or(key, value, bounds, unit); };
  optional("sample_spacing", {least_spacing(p.diameter), 0.5 * p.diameter}, "m", p.sample_spacing);
  optional("removal_rate", {0.0, 1e6}, "1/(N·s)", p.removal_rate);
  optional("falloff", {0.0, 1e6}, "1/(N·s·rad)", p.falloff);
  optional("tangential_gain", {0.0, 1e15}, "N/m^4", p.tangential_gain);
  if (table.has("right_handed")) {
    p.right_handed = table.boolean("right_handed");
  }
  return p;
}

Burr::Burr(const BurrParameters& parameters) : parameters_(parameters) {
  check(parameters);
  const auto half = half_of_samples(parameters.sample_spacing / radius());
  for (auto& axis : position_) {
    axis.reserve(2 * half.size());
  }
  // Lower half first, so that all samples run row by row.
  for (std::size_t n = 0; n < 2 * half.size(); ++n) {
    const bool mirrored = n < half.size();
    const Eigen::Vector3d at =
        mirrored ? Eigen::Vector3d(-half[half.size() - 1 - n]) : half[n - half.size()];
    const Eigen::Vector3d in = -at.normalized();
    for (int axis = 0; axis < 3; ++axis) {
      position_[axis].push_back(rounded(kRadius * at[axis]));
      direction_[axis].push_back(rounded(kUnit * in[axis]));
    }
    const double latitude = std::abs(std::asin(std::clamp(in.z(), -1.0, 1.0)));
    power_.push_back(
        static_cast<float>(std::max(0.0, parameters.removal_rate - parameters.falloff * latitude)));
  }
  if (half.empty()) {
    throw std::invalid_argument("Burr: no samples");
  }
  sample_volume_ = kSphere * std::pow(parameters.diameter, 3) / static_cast<double>(samples());
}

Eigen::Vector3d Burr::position(std::int32_t sample) const {
  const auto at = static_cast<std::size_t>(sample);
  return radius() / kRadius * Eigen::Vector3d(position_[0][at], position_[1][at], position_[2][at]);
}

Eigen::Vector3d Burr::direction(std::int32_t sample) const {
  const auto at = static_cast<std::size_t>(sample);
  return Eigen::Vector3d(direction_[0][at], direction_[1][at], direction_[2][at]) / kUnit;
}

Burr::Arrays Burr::arrays() const noexcept {
  return {position_[0].data(),  position_[1].data(),  position_[2].data(), direction_[0].data(),
          direction_[1].data(), direction_[2].data(), power_.data(),       samples()};
}

}  // namespace haptrial::bone
