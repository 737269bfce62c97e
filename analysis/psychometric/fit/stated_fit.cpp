#include "analysis/psychometric/fit/stated_fit.h"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

#include "analysis/psychometric/fit/adaptive_posterior.h"

namespace haptrial::analysis {
namespace {

constexpr double kAtBound = 1e-3;      // of a rate
constexpr double kNotRejected = 0.15;  // exp(-1.92)
constexpr double kLevel = 0.95;
constexpr double kMostLevel = 1.0 - 1e-12;

bool at_bound(const RateBounds& bounds, double rate) {
  return bounds.high > bounds.low && rate > bounds.high - kAtBound;
}

/// Whether any lapse and guess rate would make the answers likelier by a factor sqrt(e).
bool bounds_decide(std::span<const TrialBlock> blocks, LikelihoodOptions options,
                   double log_likelihood) {
  for (RateBounds* rate : {&options.lapse, &options.guess}) {
    rate->high = rate->high > rate->low ? kLargestRate : rate->high;
  }
  return likelihood_fit(blocks, options).log_likelihood > log_likelihood + 0.5;
}

std::string no_interval(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                        const StatedFit& stated) {
  if ((stated.lapse_at_bound || stated.guess_at_bound) &&
      bounds_decide(blocks, options, stated.likeliest.log_likelihood)) {
    return fmt::format("there are more {} than the bound of {:g} allows",
                       stated.lapse_at_bound ? "lapses" : "guesses",
                       stated.lapse_at_bound ? options.lapse.high : options.guess.high);
  }
  return {};
}

/// How far the answers lie from the likeliest function.
struct Scatter {
  double deviance{0.0};
  double freedom{0.0};  // degrees of the deviance
};

Scatter scatter_of(std::span<const TrialBlock> blocks, const LikelihoodOptions& options) {
  const LikelihoodFitter fitter(options, blocks);
  const LikelihoodFit fit = likelihood_fit(blocks, options);
  return {deviance_of(fitter.function(fit.parameters), blocks).deviance,
          static_cast<double>(blocks.size()) - fitter.free_parameters()};
}

/// The cut of an F test over that of chi-square, whose scale is the deviance over its degrees of
/// freedom.
double scaled_cut(const Scatter& scatter) {
  const double freedom = std::max(1.0, scatter.freedom);
  return std::max(1.0, scatter.deviance / freedom * gsl_cdf_fdist_Pinv(kLevel, 1.0, freedom) /
                           gsl_cdf_chisq_Pinv(kLevel, 1.0));
}

/// The p of the deviance by chi-square; NaN if levels are too few, or have too few trials on
/// average.
double chi_square_p(const Scatter& scatter, std::span<const TrialBlock> blocks) {
  constexpr double kFewTrials = 5.0;  // at a level, on average
  double trials = 0.0;
  for (const TrialBlock& block : blocks) {
    trials += block.total;
  }
  return scatter.freedom < 1.0 || trials < kFewTrials * static_cast<double>(blocks.size())
             ? std::numeric_limits<double>::quiet_NaN()
             : gsl_cdf_chisq_Q(scatter.deviance, scatter.freedom);
}

/// The cut of intervals over that of chi-square: 1 unless answers scatter.
/// @param p  of the deviance by samples; NaN: none were drawn, and chi-square gives it
double judged_cut(std::span<const TrialBlock> blocks, const LikelihoodOptions& options, double& p) {
  if (p >= kUnusualScatter) {
    return 1.0;
  }
  const Scatter scatter = scatter_of(blocks, options);
  p = std::isnan(p) ? chi_square_p(scatter, blocks) : p;
  return p < kUnusualScatter ? scaled_cut(scatter) : 1.0;
}

/// @param stated  with `deviance_p` of samples
void take_profile(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                  StatedFit& stated) {
  const double cut = judged_cut(blocks, options, stated.deviance_p);
  stated.widening = std::sqrt(cut);
  const double level = gsl_cdf_chisq_P(cut * gsl_cdf_chisq_Pinv(kLevel, 1.0), 1.0);
  const ProfiledFit fit = profiled_fit(blocks, options, std::min(level, kMostLevel));
  stated.likeliest = fit.fit;
  stated.estimate = fit.fit.parameters;
  stated.threshold = fit.threshold;
  stated.width = fit.width;
  stated.told = !fit.fit.undetermined;
}

ProfileInterval closed(const CredibleInterval& interval) { return {interval.low, interval.high}; }

void take_posterior(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                    StatedFit& stated) {
  const AdaptivePosterior posterior = adaptive_posterior(blocks, options, kLevel, kPosteriorDraws);
  stated.likeliest = likelihood_fit(blocks, options);
  stated.estimate = posterior.median;
  stated.threshold = closed(posterior.threshold);
  stated.threshold.low_open = posterior.low_end > kNotRejected;
  stated.threshold.high_open = posterior.high_end > kNotRejected;
  stated.width = closed(posterior.width);
  stated.lapse = closed(posterior.lapse);
  stated.guess = closed(posterior.guess);
  stated.lapse_told = posterior.lapse_told;
  stated.draws = posterior.draws;
  stated.told = !(stated.threshold.low_open && stated.threshold.high_open);
}

}  // namespace

StatedFit stated_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                     bool adaptive, double deviance_p) {
  StatedFit stated;
  stated.deviance_p = deviance_p;
  if (adaptive) {
    take_posterior(blocks, options, stated);
  } else {
    take_profile(blocks, options, stated);
  }
  const FittedParameters& likeliest = stated.likeliest.parameters;
  stated.lapse_at_bound = at_bound(options.lapse, likeliest.lapse);
  stated.guess_at_bound = options.task == Task::kYesNo && at_bound(options.guess, likeliest.guess);
  stated.no_interval = no_interval(blocks, options, stated);
  return stated;
}

}  // namespace haptrial::analysis
