#include "analysis/psychometric/fit/profile_interval.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace haptrial::analysis {
namespace {

/// What both ends of an interval have in common.
struct Profile {
  const LikelihoodFitter& fitter;
  std::span<const int> correct;
  const LikelihoodFit& top;
  Held held;
  double root;   // sqrt(c)
  double first;  // distance from the estimate at which to look first
};

struct ProfileEnd {
  double value;
  bool open;
};

/// Where sqrt(2 (l - profile)), which is nearly a line, is sqrt(c): Newton's method between what is
/// known to lie inside and outside. @param way  -1 or +1
ProfileEnd end_of(const Profile& p, double way) noexcept {
  constexpr int kMost = 60;
  constexpr double kClose = 1e-7;  // of the root
  const SearchBounds bounds = p.fitter.bounds(p.held);
  const double bound = way < 0.0 ? bounds.low : bounds.high;
  const auto& at_top = p.top.parameters;
  const double centre = p.held == Held::kThreshold ? at_top.threshold : std::log(at_top.width);
  const double most = std::max(0.0, way * (bound - centre));
  FittedParameters from = at_top;
  double inside = 0.0, outside = std::numeric_limits<double>::infinity();
  double distance = std::min(p.first, most);  // of the value from the estimate
  for (int i = 0; i < kMost; ++i) {
    const HeldFit held = p.fitter.fit_holding(p.correct, p.held, centre + way * distance, from);
    const double root =
        std::sqrt(std::max(0.0, 2.0 * (p.top.log_likelihood - held.log_likelihood)));
    if (std::abs(root - p.root) < kClose * p.root || outside - inside < kClose * p.first) {
      break;
    }
    if (root < p.root && distance >= most) {
      return {bound, true};
    }
    (root < p.root ? inside : outside) = distance;
    from = held.parameters;
    double next = distance + (p.root - root) * root / (-way * held.slope);
    if (!(next > inside && next < outside)) {
      next = std::isinf(outside) ? 2.0 * distance : 0.5 * (inside + outside);
    }
    distance = std::min({next, 4.0 * distance, most});
  }
  return {centre + way * distance, false};
}

ProfileInterval interval_of(const Profile& profile) noexcept {
  const ProfileEnd low = end_of(profile, -1.0), high = end_of(profile, 1.0);
  if (profile.held == Held::kThreshold) {
    return {low.value, high.value, low.open, high.open};
  }
  return {low.open ? 0.0 : std::exp(low.value),
          high.open ? std::numeric_limits<double>::infinity() : std::exp(high.value), low.open,
          high.open};
}

}  // namespace

ProfiledFit profiled_fit(const LikelihoodFitter& fitter, std::span<const int> correct,
                         double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  ProfiledFit result;
  result.fit = fitter.fit(correct);
  const double root = std::sqrt(gsl_cdf_chisq_Pinv(level, 1.0));
  const double error = 1.0 / std::sqrt(fitter.trials());  // of some parameter, roughly
  const double width = result.fit.parameters.width;
  result.threshold =
      interval_of({fitter, correct, result.fit, Held::kThreshold, root, root * error * width});
  result.width = interval_of({fitter, correct, result.fit, Held::kWidth, root, 4.0 * root * error});
  return result;
}

ProfiledFit profiled_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                         double level) {
  std::vector<int> correct;
  for (const TrialBlock& block : blocks) {
    correct.push_back(block.correct);
  }
  return profiled_fit(LikelihoodFitter(options, blocks), correct, level);
}

}  // namespace haptrial::analysis
