#include "analysis/psychophysics/study/cue_bias.h"

#include <cmath>
#include <deque>
#include <optional>
#include <vector>

#include "analysis/psychometric/fit/bootstrap_fit.h"
#include "analysis/psychometric/models/cue_combination.h"
#include "core/base/random.h"

namespace haptrial::analysis::trials {
namespace {

constexpr int kDraws = 200;  // the mean of a difference with a spread of 0.2 within 0.015

/// Answers to the levels of a fit, drawn from a function and fitted.
class Refit {
 public:
  Refit(const FunctionFit& fit, const FittedParameters& truth, const LikelihoodOptions& options)
      : fitter_(options, fit.blocks),
        draws_(fit.blocks, fitter_.function(truth)),
        correct_(fit.blocks.size()) {}

  /// Nothing where the answers do not tell it.
  std::optional<double> log_width(RandomStream& random) {
    draws_.draw(random, correct_);
    const LikelihoodFit fit = fitter_.fit(correct_);
    return fit.undetermined ? std::nullopt : std::optional(std::log(fit.parameters.width));
  }

 private:
  LikelihoodFitter fitter_;
  AnswerDraws draws_;
  std::vector<int> correct_;
};

/// Functions that count as one.
class Refits {
 public:
  /// @param log_width  of all of them; left out: each has its own
  Refits(FunctionFits fits, const LikelihoodOptions& options,
         std::optional<double> log_width = std::nullopt) {
    for (const FunctionFit* fit : fits) {
      FittedParameters truth = fit->fitted;
      truth.width = log_width ? std::exp(*log_width) : truth.width;
      each_.emplace_back(*fit, truth, options);
    }
  }

  std::optional<double> log_width(RandomStream& random) {
    double sum = 0.0;
    bool known = true;
    for (Refit& refit : each_) {
      const auto width = refit.log_width(random);
      known = known && width;
      sum += width.value_or(0.0);
    }
    return known ? std::optional(sum / static_cast<double>(each_.size())) : std::nullopt;
  }

 private:
  std::deque<Refit> each_;
};

double mean_log_width(FunctionFits fits) {
  double sum = 0.0;
  for (const FunctionFit* fit : fits) {
    sum += std::log(fit->fitted.width);
  }
  return sum / static_cast<double>(fits.size());
}

CombinedCues prediction_of(double first, double second) {
  return predict_combination({std::exp(first), 0.0}, {std::exp(second), 0.0});
}

}  // namespace

CueBias cue_bias(FunctionFits first, FunctionFits second, FunctionFits both, const TrialsPlan& plan,
                 const std::string& stream) {
  const LikelihoodOptions options = likelihood_options(plan);
  // Widths stand for standard deviations: one sigmoid has one ratio of the two.
  const CombinedCues truth = prediction_of(mean_log_width(first), mean_log_width(second));
  Refits one(first, options), other(second, options);
  Refits together(both, options, std::log(truth.combined_sd.value));
  RandomStream random(plan.seed, stream);
  CueBias sum;
  int counted = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto a = one.log_width(random), b = other.log_width(random);
    const auto observed = together.log_width(random);
    if (a && b && observed) {
      const CombinedCues predicted = prediction_of(*a, *b);
      sum.log_sd += *observed - std::log(predicted.combined_sd.value);
      sum.weight += predicted.first_weight.value - truth.first_weight.value;
      ++counted;
    }
  }
  return counted == 0 ? CueBias{} : CueBias{sum.log_sd / counted, sum.weight / counted};
}

}  // namespace haptrial::analysis::trials
