#include "analysis/reaching/zero_phase_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

/// b0 + b1/z + b2/z² over 1 + a1/z + a2/z², with a gain of 1 for what is constant.
struct Section {
  double b0, b1, b2, a1, a2;
};

constexpr std::size_t kFewest = 4;
constexpr double kPeriodsBeyond = 3.0;

void check_filter(double rate, const ZeroPhaseFilter& filter) {
  if (!(rate > 0.0) || !std::isfinite(rate)) {
    throw std::invalid_argument("rate must be above 0 and finite");
  }
  if (filter.order < 2 || filter.order > 16 || filter.order % 2 != 0) {
    throw std::invalid_argument("order must be even and from 2 to 16");
  }
  if (!(filter.cutoff > 0.0 && filter.cutoff < 0.5 * rate)) {
    throw std::invalid_argument("cutoff must lie between 0 and half the rate");
  }
}

/// One run, by the bilinear transform of the analogue prototype.
std::vector<Section> sections_of(double rate, const ZeroPhaseFilter& filter) {
  using std::numbers::pi;
  const int order = filter.order / 2;
  // Two runs pass 1/√2 at the cut-off if one passes 2^(-1/4).
  const double w =
      std::tan(pi * filter.cutoff / rate) / std::pow(std::numbers::sqrt2 - 1.0, 1.0 / filter.order);
  std::vector<Section> sections;
  for (int k = 0; k < order / 2; ++k) {
    const double damping = 2.0 * std::sin(pi * (2.0 * k + 1.0) / (2.0 * order));
    const double scale = 1.0 + damping * w + w * w;
    const double b = w * w / scale;
    sections.push_back(
        {b, 2.0 * b, b, 2.0 * (w * w - 1.0) / scale, (1.0 - damping * w + w * w) / scale});
  }
  if (order % 2 == 1) {
    const double b = w / (1.0 + w);
    sections.push_back({b, b, 0.0, (w - 1.0) / (w + 1.0), 0.0});
  }
  return sections;
}

/// Filters in place, as if the first sample had been there forever.
void run(const std::vector<Section>& sections, std::vector<double>& samples) {
  for (const Section& s : sections) {
    double one = samples.front() * (1.0 - s.b0);
    double two = samples.front() * (s.b2 - s.a2);
    for (double& x : samples) {
      const double y = s.b0 * x + one;
      one = s.b1 * x - s.a1 * y + two;
      two = s.b2 * x - s.a2 * y;
      x = y;
    }
  }
}

std::vector<double> continued(std::span<const double> samples, std::size_t beyond) {
  std::vector<double> all;
  all.reserve(samples.size() + 2 * beyond);
  for (std::size_t i = beyond; i > 0; --i) {
    all.push_back(2.0 * samples.front() - samples[i]);
  }
  all.insert(all.end(), samples.begin(), samples.end());
  for (std::size_t i = 1; i <= beyond; ++i) {
    all.push_back(2.0 * samples.back() - samples[samples.size() - 1 - i]);
  }
  return all;
}

}  // namespace

Defined<std::vector<double>> filtered(std::span<const double> samples, double rate,
                                      const ZeroPhaseFilter& filter) {
  check_filter(rate, filter);
  if (samples.size() < kFewest) {
    return Undefined{"there are fewer than four samples"};
  }
  if (!std::ranges::all_of(samples, [](double v) { return std::isfinite(v); })) {
    return Undefined{"a sample is not finite"};
  }
  const auto wanted = static_cast<std::size_t>(std::min(
      std::ceil(kPeriodsBeyond * rate / filter.cutoff), static_cast<double>(samples.size() - 1)));
  const auto sections = sections_of(rate, filter);
  std::vector<double> all = continued(samples, wanted);
  run(sections, all);
  std::ranges::reverse(all);
  run(sections, all);
  std::ranges::reverse(all);
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(wanted);
  return std::vector<double>(first, first + std::ssize(samples));
}

std::vector<double> differentiated(std::span<const double> samples, double rate) {
  if (samples.size() < 3) {
    throw std::invalid_argument("samples: at least three have slopes");
  }
  const std::size_t n = samples.size();
  std::vector<double> slopes(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    slopes[i] = 0.5 * rate * (samples[i + 1] - samples[i - 1]);
  }
  slopes[0] = 0.5 * rate * (4.0 * samples[1] - 3.0 * samples[0] - samples[2]);
  slopes[n - 1] = 0.5 * rate * (3.0 * samples[n - 1] - 4.0 * samples[n - 2] + samples[n - 3]);
  return slopes;
}

Defined<SmoothMotion> smooth_motion(std::span<const Eigen::Vector3d> position, double rate,
                                    const ZeroPhaseFilter& filter) {
  SmoothMotion motion{std::vector<Eigen::Vector3d>(position.size()),
                      std::vector<Eigen::Vector3d>(position.size())};
  std::vector<double> samples(position.size());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::ranges::transform(position, samples.begin(),
                           [axis](const Eigen::Vector3d& p) { return p[axis]; });
    const auto smooth = filtered(samples, rate, filter);
    if (!smooth) {
      return Undefined{smooth.because()};
    }
    const auto slopes = differentiated(*smooth, rate);
    for (std::size_t i = 0; i < position.size(); ++i) {
      motion.position[i][axis] = (*smooth)[i];
      motion.velocity[i][axis] = slopes[i];
    }
  }
  return motion;
}

}  // namespace haptrial::analysis
