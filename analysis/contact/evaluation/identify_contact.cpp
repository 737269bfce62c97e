#include "analysis/contact/evaluation/identify_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLast = 10;  // samples of a phase that say where it ends
constexpr std::size_t kFewest = 4;

Vector3d along_surface(const Vector3d& v, const Vector3d& normal) {
  return v - v.dot(normal) * normal;
}

/// The parabola through values at 0, 1, …, half a step beyond the last: a hand that starts to move
/// speeds up.
Vector3d extrapolated(const std::vector<Vector3d>& values) {
  const auto n = static_cast<double>(values.size());
  const double middle = 0.5 * (n - 1.0), mean_square = (n * n - 1.0) / 12.0;
  Vector3d mean = Vector3d::Zero(), slope = Vector3d::Zero(), bend = Vector3d::Zero();
  double slopes = 0.0, bends = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double u = static_cast<double>(i) - middle, v = u * u - mean_square;
    mean += values[i] / n;
    slope += u * values[i];
    bend += v * values[i];
    slopes += u * u;
    bends += v * v;
  }
  const double end = n - 0.5 - middle;
  return mean + slope / slopes * end + bend / bends * (end * end - mean_square);
}

class PhaseSearch {
 public:
  PhaseSearch(const ContactSamples& samples, const StickOptions& options)
      : s_(samples), o_(options) {}

  bool touches(std::size_t i) const { return s_.force[i].dot(s_.normal[i]) > o_.least_force; }
  double speed(std::size_t i) const { return along_surface(s_.velocity[i], s_.normal[i]).norm(); }
  bool sticks(std::size_t i) const { return touches(i) && speed(i) < o_.slow; }

  /// The sample of fast slip after `last`, the last one that sticks.
  std::optional<std::size_t> slip_after(std::size_t last) const {
    for (std::size_t i = last + 1; i < s_.size() && touches(i) && !sticks(i); ++i) {
      if (speed(i) > o_.fast) {
        return i;
      }
    }
    return std::nullopt;
  }

  double ratio_at_end(std::size_t first, std::size_t last, std::size_t slip) const {
    std::vector<Vector3d> ratios;
    for (std::size_t i = std::max(first, last + 1 - std::min(last + 1, kLast)); i <= last; ++i) {
      const Vector3d& n = s_.normal[i];
      ratios.push_back(-along_surface(s_.force[i], n) / s_.force[i].dot(n));
    }
    const Vector3d ratio = extrapolated(ratios);
    return std::copysign(ratio.norm(), ratio.dot(s_.velocity[slip]));
  }

 private:
  const ContactSamples& s_;
  const StickOptions& o_;
};

}  // namespace

std::vector<double> break_away_ratios(const ContactSamples& samples, const StickOptions& options) {
  const PhaseSearch search(samples, options);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!search.sticks(i)) {
      continue;
    }
    const std::size_t first = i;
    while (i + 1 < samples.size() && search.sticks(i + 1)) {
      ++i;
    }
    const bool long_enough =
        i + 1 - first >= kFewest && samples.time[i] - samples.time[first] >= options.shortest_stick;
    const std::optional<std::size_t> slip = search.slip_after(i);
    if (long_enough && slip) {
      ratios.push_back(search.ratio_at_end(first, i, *slip));
    }
  }
  return ratios;
}

namespace {

using Eigen::Index;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kPerBlock = 10;  // fewest samples of a block
constexpr std::size_t kFewestBlocks = 8;
constexpr std::size_t kFewestPhases = 3;
constexpr double kAboveNoise = 5.0;  // a velocity's direction is then right to 0.2 rad
constexpr double kStickAboveNoise = 3.0;

const char* const kStiffnessName = "compliance (1/stiffness)";
const char* const kFrictionName = "dynamic friction";

void check_identification(const IdentificationOptions& o) {
  const bool good = o.stick.least_force > 0.0 && o.stick.slow > 0.0 &&
                    o.stick.fast > o.stick.slow && o.stick.shortest_stick >= 0.0 &&
                    o.velocity_noise >= 0.0 && o.blocks >= static_cast<int>(kFewestBlocks) &&
                    o.level > 0.0 && o.level < 1.0;
  if (!good) {
    throw std::invalid_argument(
        "identification needs least_force > 0, 0 < slow < fast, 8 blocks or more and a level "
        "inside (0, 1)");
  }
  if (o.texture &&
      !(o.texture->wavelength > 0.0 && std::abs(o.texture->axis.norm() - 1.0) < 1e-6)) {
    throw std::invalid_argument("a texture needs a wavelength above 0 and an axis of unit length");
  }
}

int blocks_for(std::size_t samples, const IdentificationOptions& o) {
  return std::min(o.blocks, static_cast<int>(samples / kPerBlock));
}

/// The sentences that name one of what is asked for; those about offsets alone concern nobody.
void keep_sentences(const BlockFit& fit, std::initializer_list<const char*> names,
                    std::vector<std::string>& to) {
  for (const std::string& sentence : fit.confounded) {
    if (std::any_of(names.begin(), names.end(),
                    [&](const char* name) { return sentence.find(name) != std::string::npos; })) {
      to.push_back(sentence);
    }
  }
}

/// |c| of two terms whose covariance is known.
Interval amplitude_of(const Eigen::Vector2d& terms, const Eigen::Matrix2d& covariance, int blocks,
                      double level) {
  const double size = terms.norm();
  if (!covariance.allFinite() || !(covariance.trace() > 0.0)) {
    return {size, size, size};
  }
  const double freedom = blocks - 1.0;
  // Hotelling's T² of two terms: F(2, m) has a quantile without a table.
  const double m = freedom - 1.0;
  const double f = 0.5 * m * (std::pow(1.0 - level, -2.0 / m) - 1.0);
  const double limit = 2.0 * freedom / m * f;
  const Eigen::Matrix2d adjugate{{covariance(1, 1), -covariance(0, 1)},
                                 {-covariance(1, 0), covariance(0, 0)}};
  const double determinant =
      covariance(0, 0) * covariance(1, 1) - covariance(0, 1) * covariance(1, 0);
  const bool told = terms.dot(adjugate * terms) > limit * determinant;
  const double along =
      size > 0.0 ? terms.dot(covariance * terms) / (size * size) : 0.5 * covariance.trace();
  const double half = analysis::t_quantile(0.5 + 0.5 * level, freedom) * std::sqrt(along);
  // Noise alone makes an amplitude: its mean square is the trace.
  const double value = std::sqrt(std::max(0.0, size * size - covariance.trace()));
  return {value, told ? std::max(0.0, size - half) : 0.0, size + half};
}

void doubt_stiffness(IdentifiedContact& found) {
  if (found.compliance.high <= 0.0) {
    found.confounded.push_back(
        "The probe lies less deep the harder it presses: the registration or the sensor's load is "
        "off, and the stiffness means nothing.");
  } else if (found.compliance.low <= 0.0) {
    found.confounded.push_back(fmt::format(
        "The depth does not grow beyond its noise with the force: the stiffness has no upper "
        "bound, it is at least {:.4g} N/m.",
        found.stiffness.low));
  }
}

void find_stiffness(const ContactSamples& s, const std::vector<std::size_t>& touching,
                    const IdentificationOptions& o, IdentifiedContact& found) {
  std::vector<std::string> names{kStiffnessName, "offset", "shift x", "shift y", "shift z"};
  if (o.texture) {
    names.insert(names.end(), {"texture (sine)", "texture (cosine)"});
  }
  const auto rows = static_cast<Index>(touching.size());
  Eigen::MatrixXd x(rows, static_cast<Index>(names.size()));
  Eigen::VectorXd y(rows);
  for (Index r = 0; r < rows; ++r) {
    const std::size_t i = touching[static_cast<std::size_t>(r)];
    x.row(r).head<5>() << s.force[i].dot(s.normal[i]), 1.0, s.normal[i].transpose();
    if (o.texture) {
      const double phase =
          2.0 * std::numbers::pi * s.position[i].dot(o.texture->axis) / o.texture->wavelength;
      x.row(r).tail<2>() << -std::sin(phase), -std::cos(phase);
    }
    y[r] = s.depth[i];
  }
  const int blocks = blocks_for(touching.size(), o);
  const BlockFit fit = fit_blocks(x, y, names, {blocks, o.level});
  found.compliance = fit.intervals[0];
  const auto inverse = [](double c) { return c > 0.0 ? 1.0 / c : kInfinite; };
  found.stiffness = {inverse(found.compliance.value), inverse(found.compliance.high),
                     inverse(found.compliance.low)};
  keep_sentences(fit, {kStiffnessName, "texture"}, found.confounded);
  doubt_stiffness(found);
  if (o.texture) {
    const bool fixed = std::isfinite(fit.intervals[5].high) && std::isfinite(fit.intervals[6].high);
    found.texture = fixed ? amplitude_of(fit.coefficients.segment<2>(5),
                                         fit.covariance.block<2, 2>(5, 5), blocks, o.level)
                          : Interval{fit.coefficients.segment<2>(5).norm(), 0.0, kInfinite};
  }
}

/// Adds another source of error, which is independent of the noise, to an interval.
void widen(double half, Interval& interval) {
  interval.low = interval.value - std::hypot(interval.value - interval.low, half);
  interval.high = interval.value + std::hypot(interval.high - interval.value, half);
}

void find_dynamic_friction(const ContactSamples& s, const std::vector<std::size_t>& slipping,
                           const IdentificationOptions& o, IdentifiedContact& found) {
  found.slip_samples = slipping.size();
  if (slipping.size() < kPerBlock * kFewestBlocks) {
    found.confounded.push_back(
        fmt::format("Dynamic friction is not identifiable: {} samples slip; {} are needed.",
                    slipping.size(), kPerBlock * kFewestBlocks));
    return;
  }
  const auto rows = static_cast<Index>(slipping.size());
  Eigen::MatrixXd x(rows, 4);
  Eigen::VectorXd y(rows);
  for (Index r = 0; r < rows; ++r) {
    const std::size_t i = slipping[static_cast<std::size_t>(r)];
    const Vector3d& n = s.normal[i];
    const Vector3d way = (s.velocity[i] - s.velocity[i].dot(n) * n).normalized();
    x.row(r) << -s.force[i].dot(n), way.transpose();
    y[r] = s.force[i].dot(way);
  }
  const BlockFit fit = fit_blocks(x, y, {kFrictionName, "force x", "force y", "force z"},
                                  {blocks_for(slipping.size(), o), o.level});
  found.dynamic_friction = fit.intervals[0];
  widen(o.friction_by_lag, *found.dynamic_friction);
  if (o.lag_like_friction) {
    found.confounded.push_back(fmt::format(
        "Dynamic friction looks like a lag on this path: {}.",
        std::isfinite(o.friction_by_lag)
            ? fmt::format("what is open of the lag adds {:.3f} to its interval", o.friction_by_lag)
            : "without a known lag it has no interval"));
  }
  keep_sentences(fit, {kFrictionName}, found.confounded);
}

void find_static_friction(const ContactSamples& s, const IdentificationOptions& o,
                          IdentifiedContact& found) {
  if (kStickAboveNoise * o.velocity_noise > o.stick.slow) {
    found.confounded.push_back(fmt::format(
        "Static friction is not identifiable: velocities are good to {:.2g} mm/s, so that sticking "
        "cannot be told from slow slip; it is no less than the dynamic one.",
        1e3 * o.velocity_noise));
    return;
  }
  const std::vector<double> ratios = break_away_ratios(s, o.stick);
  found.stick_phases = ratios.size();
  if (ratios.size() < kFewestPhases) {
    found.confounded.push_back(fmt::format(
        "Static friction is not identifiable: {} phases of sticking end in slip; {} are needed. It "
        "is no less than the dynamic one.",
        ratios.size(), kFewestPhases));
    return;
  }
  const auto mean = analysis::mean_interval(ratios, o.level);
  if (!mean) {
    found.confounded.push_back("Static friction has no interval, because " + mean.because() + ".");
    return;
  }
  found.static_friction = Interval{mean->mean, mean->low, mean->high};
}

}  // namespace

IdentifiedContact identify_contact(const ContactSamples& samples,
                                   const IdentificationOptions& options) {
  check(samples);
  check_identification(options);
  std::vector<std::size_t> touching, slipping;
  const double fast = std::max(options.stick.fast, kAboveNoise * options.velocity_noise);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vector3d& n = samples.normal[i];
    if (samples.force[i].dot(n) > options.stick.least_force) {
      touching.push_back(i);
      if ((samples.velocity[i] - samples.velocity[i].dot(n) * n).norm() > fast) {
        slipping.push_back(i);
      }
    }
  }
  if (touching.size() < kPerBlock * kFewestBlocks) {
    throw std::invalid_argument(fmt::format("{} samples are in contact; {} or more are needed",
                                            touching.size(), kPerBlock * kFewestBlocks));
  }
  IdentifiedContact found;
  found.contact_samples = touching.size();
  find_stiffness(samples, touching, options, found);
  find_dynamic_friction(samples, slipping, options, found);
  find_static_friction(samples, options, found);
  return found;
}

}  // namespace haptrial::evaluation
