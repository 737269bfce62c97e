#include "analysis/psychometric/fit/profile_interval.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

namespace haptrial::analysis {
namespace {

/// Inputs that both ends of an interval share.
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
  FittedParameters likeliest{};      // of those looked at,
  double log_likelihood{-HUGE_VAL};  // with this
};

/// End of the interval, where sqrt(2 (l - profile)), which is nearly a line, is sqrt(c): Newton's
/// method between places that are known to lie inside and outside. @param way  -1 or +1
ProfileEnd end_of(const Profile& p, double way) noexcept {
  constexpr int kMost = 60;
  constexpr double kClose = 1e-6;  // of the root
  const SearchBounds bounds = p.fitter.bounds(p.held);
  const double bound = way < 0.0 ? bounds.low : bounds.high;
  const FittedParameters& top = p.top.parameters;
  const double centre = p.held == Held::kThreshold ? top.threshold : std::log(top.width);
  const double most = std::max(0.0, way * (bound - centre));
  ProfileEnd end{bound, true, top, p.top.log_likelihood};
  FittedParameters from = top;
  double inside = 0.0, outside = std::numeric_limits<double>::infinity();
  double distance = std::min(p.first, most);  // of the value from the estimate
  for (int i = 0; i < kMost; ++i) {
    const HeldFit held = p.fitter.fit_holding(p.correct, p.held, centre + way * distance, from);
    if (held.log_likelihood > end.log_likelihood) {
      end.likeliest = held.parameters, end.log_likelihood = held.log_likelihood;
    }
    const double fall = p.top.log_likelihood - held.log_likelihood;
    const double root = std::sqrt(std::max(0.0, 2.0 * fall));
    if (std::abs(root - p.root) < kClose * p.root || outside - inside < kClose * p.first) {
      break;
    }
    if (root < p.root && distance >= most) {
      return end;
    }
    (root < p.root ? inside : outside) = distance;
    from = held.parameters;
    double next = distance + (p.root - root) * root / (-way * held.slope);
    if (!(next > inside && next < outside)) {
      next = std::isinf(outside) ? 2.0 * distance : 0.5 * (inside + outside);
    }
    distance = std::min({next, 4.0 * distance, most});
  }
  end.value = centre + way * distance, end.open = false;
  return end;
}

/// Fills the interval. @returns a place that is likelier than the fit itself, if one was met
std::optional<FittedParameters> find_interval(const Profile& p,
                                              ProfileInterval& interval) noexcept {
  constexpr double kLikelier = 1e-6;
  const ProfileEnd low = end_of(p, -1.0), high = end_of(p, 1.0);
  interval = {low.value, high.value, low.open, high.open};
  if (p.held == Held::kWidth) {
    interval.low = low.open ? 0.0 : std::exp(low.value);
    interval.high = high.open ? std::numeric_limits<double>::infinity() : std::exp(high.value);
  }
  const ProfileEnd& best = low.log_likelihood > high.log_likelihood ? low : high;
  if (best.log_likelihood > p.top.log_likelihood + kLikelier) {
    return best.likeliest;
  }
  return std::nullopt;
}

/// The likeliest of the maxima that flatter and steeper functions lead to.
LikelihoodFit likeliest_fit(const LikelihoodFitter& fitter, std::span<const int> correct) noexcept {
  LikelihoodFit best = fitter.fit(correct);
  const double width = best.parameters.width;
  for (const double factor : {0.25, 4.0}) {
    FittedParameters from = best.parameters;
    from.width = factor * width;
    const LikelihoodFit other = fitter.fit_from(correct, from);
    best = other.log_likelihood > best.log_likelihood + 1e-9 ? other : best;
  }
  return best;
}

}  // namespace

ProfiledFit profiled_fit(const LikelihoodFitter& fitter, std::span<const int> correct,
                         double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  constexpr int kTops = 4;
  ProfiledFit result;
  result.fit = likeliest_fit(fitter, correct);
  const LikelihoodFit& fit = result.fit;
  const double root = std::sqrt(gsl_cdf_chisq_Pinv(level, 1.0));
  const double near = root / std::sqrt(fitter.trials());  // a parameter's error, roughly
  for (int i = 0; i < kTops; ++i) {
    const double first = near * fit.parameters.width;
    auto likelier =
        find_interval({fitter, correct, fit, Held::kThreshold, root, first}, result.threshold);
    if (!likelier) {
      likelier =
          find_interval({fitter, correct, fit, Held::kWidth, root, 4.0 * near}, result.width);
    }
    if (!likelier) {
      break;
    }
    result.fit = fitter.fit_from(correct, *likelier);
  }
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
