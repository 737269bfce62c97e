#include "analysis/psychometric/hierarchical/hierarchical_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace haptrial::analysis::hierarchical {
namespace {

double part_of(double count, double share, double probability) {
  return count > 0.0 ? 2.0 * count * std::log(share / probability) : 0.0;
}

/// Part of a block in the deviance of answers from a function.
double deviance(int ones, int total, double p) {
  const double n = total, one = ones;
  return part_of(one, one / n, std::max(p, 1e-300)) +
         part_of(n - one, 1.0 - one / n, std::max(1.0 - p, 1e-300));
}

int draw_ones(int total, double p, RandomStream& random) {
  int ones = 0;
  for (int i = 0; i < total; ++i) {
    ones += random.uniform() < p ? 1 : 0;
  }
  return ones;
}

/// Draws of one number of each person or series.
using Numbers = std::vector<std::vector<double>>;

Numbers family_draws(const Model& model, const Sampler& sampler, FamilyIndex family) {
  const NumberPlaces places(model);
  Numbers all;
  for (std::size_t e = 0; e < model.family(family).entries(); ++e) {
    all.push_back(sampler.draws(places.families[family].values + e));
  }
  return all;
}

/// For each person the share of draws from the posterior for which answers that are drawn from the
/// function deviate from it at least as much as those that were given: low if answers scatter more
/// than the function explains. Levels are those that were presented.
/// @param most  how many draws are taken, evenly over all chains
/// Source: Gelman, Meng and Stern 1996, Statistica Sinica 6, 733.
std::vector<double> predictive_p(const Model& model, const Sampler& sampler, std::size_t most,
                                 std::uint64_t seed) {
  const Numbers thresholds = family_draws(model, sampler, kThresholds);
  const Numbers widths = family_draws(model, sampler, kLogWidths);
  const Numbers lapses = family_draws(model, sampler, kLapses);
  const Numbers guesses = family_draws(model, sampler, kGuesses);
  const std::size_t all = thresholds.front().size(), step = std::max<std::size_t>(all / most, 1);
  RandomStream random(seed, "hierarchical predictive");
  const Family& family = model.family(kThresholds);
  std::vector<double> shares;
  for (std::size_t person = 0; person < model.people(); ++person) {
    double at_least = 0.0, count = 0.0;
    for (std::size_t draw = 0; draw < all; draw += step) {
      const Model::Rates rates = model.rates(lapses.empty() ? 0.0 : lapses[person][draw],
                                             guesses.empty() ? 0.0 : guesses[person][draw]);
      double given = 0.0, replicated = 0.0;
      for (std::size_t s = family.first[person]; s < family.first[person + 1]; ++s) {
        const std::vector<double> p =
            model.probabilities(s, thresholds[s][draw], widths[s][draw], rates);
        const std::vector<TrialBlock>& blocks = model.answers()[s].blocks;
        for (std::size_t i = 0; i < blocks.size(); ++i) {
          given += deviance(blocks[i].correct, blocks[i].total, p[i]);
          replicated += deviance(draw_ones(blocks[i].total, p[i], random), blocks[i].total, p[i]);
        }
      }
      at_least += replicated >= given ? 1.0 : 0.0;
      count += 1.0;
    }
    shares.push_back(at_least / count);
  }
  return shares;
}

constexpr std::size_t kReplications = 1000;  // of each person's answers

double quantile_of(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// Makes posteriors of a sampler's draws and keeps the worst of their diagnostics.
class Summary {
 public:
  Summary(const Model& model, const Sampler& sampler)
      : model_(model), sampler_(sampler), places_(model) {}

  Posterior of(std::vector<double> draws) {
    std::vector<std::span<const double>> chains;
    for (std::size_t i = 0; i < sampler_.chains(); ++i) {
      chains.emplace_back(draws.data() + i * sampler_.length(), sampler_.length());
    }
    Posterior made;
    made.chains = chain_diagnostics(chains);
    std::ranges::sort(draws);
    made.median = quantile_of(draws, 0.5);
    made.low = quantile_of(draws, 0.025);
    made.high = quantile_of(draws, 0.975);
    // A NaN stays, as no comparison with it holds.
    r_hat_ = made.chains.r_hat <= r_hat_ ? r_hat_ : made.chains.r_hat;
    effective_ = made.chains.effective >= effective_ ? effective_ : made.chains.effective;
    return made;
  }

  /// A number of the chains through a rising map, which keeps its quantiles.
  template <class Map>
  Posterior mapped(std::size_t number, const Map& map) {
    return mapped(of(sampler_.draws(number)), map);
  }
  template <class Map>
  static Posterior mapped(Posterior made, const Map& map) {
    for (double* each : {&made.median, &made.low, &made.high}) {
      *each = map(*each);
    }
    return made;
  }

  FunctionPosterior function(std::size_t threshold, std::size_t width) {
    const double middle = model_.middle(), range = model_.range();
    return {mapped(threshold, [=](double m) { return middle + range * m; }),
            mapped(width, [=](double v) { return range * std::exp(v); })};
  }

  Posterior rate(FamilyIndex family, std::size_t number) {
    return mapped(number, [&](double l) {
      const Model::Rates rates = model_.rates(l, l);
      return family == kLapses ? rates.lapse : rates.guess;
    });
  }

  ConditionDifference difference(std::size_t first, std::size_t second) {
    ConditionDifference made{first, second, {}, {}, 0.5};
    const std::vector<double> shift = differences(kThresholds, first, second);
    const double range = model_.range();
    made.threshold = mapped(of(shift), [=](double d) { return range * d; });
    made.width_ratio =
        mapped(of(differences(kLogWidths, first, second)), [](double d) { return std::exp(d); });
    made.share_above =
        static_cast<double>(std::ranges::count_if(shift, [](double d) { return d > 0.0; })) /
        static_cast<double>(shift.size());
    return made;
  }

  Spread spread(FamilyIndex family, double scale) {
    const auto& places = places_.families[family];
    std::vector<double> between = sampler_.draws(places.between);
    Spread made;
    if (model_.family(family).within) {
      const std::vector<double> within = sampler_.draws(places.within);
      for (std::size_t i = 0; i < between.size(); ++i) {
        between[i] = std::hypot(between[i], within[i]);
      }
      made.within = mapped(of(within), [=](double s) { return std::numbers::sqrt2 * scale * s; });
    }
    made.between = mapped(of(std::move(between)), [=](double s) { return scale * s; });
    return made;
  }

  const NumberPlaces& places() const { return places_; }
  double r_hat() const { return r_hat_; }
  double effective() const { return effective_; }

 private:
  std::vector<double> differences(FamilyIndex family, std::size_t first, std::size_t second) {
    const std::size_t means = places_.families[family].means;
    std::vector<double> a = sampler_.draws(means + first);
    const std::vector<double> b = sampler_.draws(means + second);
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = b[i] - a[i];
    }
    return a;
  }

  const Model& model_;
  const Sampler& sampler_;
  NumberPlaces places_;
  double r_hat_{1.0}, effective_{std::numeric_limits<double>::infinity()};
};

void add_group(const Model& model, Summary& summary, HierarchicalFit& fit) {
  const auto& places = summary.places().families;
  for (std::size_t c = 0; c < model.conditions(); ++c) {
    fit.conditions.push_back(
        summary.function(places[kThresholds].means + c, places[kLogWidths].means + c));
    for (std::size_t before = 0; before < c; ++before) {
      fit.differences.push_back(summary.difference(before, c));
    }
  }
  fit.thresholds = summary.spread(kThresholds, model.range());
  fit.log_widths = summary.spread(kLogWidths, 1.0);
  fit.has_within = model.family(kThresholds).within;
  fit.lapse_sought = model.family(kLapses).entries() > 0;
  fit.guess_sought = model.family(kGuesses).entries() > 0;
  if (fit.lapse_sought) {
    fit.lapse = summary.rate(kLapses, places[kLapses].means);
  }
  if (fit.guess_sought) {
    fit.guess = summary.rate(kGuesses, places[kGuesses].means);
  }
}

void add_people(const Model& model, Summary& summary, HierarchicalFit& fit) {
  const auto& places = summary.places().families;
  fit.people.resize(model.people());
  for (std::size_t s = 0; s < model.answers().size(); ++s) {
    fit.functions.push_back(
        summary.function(places[kThresholds].values + s, places[kLogWidths].values + s));
    fit.people[model.answers()[s].person].series.push_back(s);
  }
  for (std::size_t person = 0; person < model.people(); ++person) {
    if (fit.lapse_sought) {
      fit.people[person].lapse = summary.rate(kLapses, places[kLapses].values + person);
    }
    if (fit.guess_sought) {
      fit.people[person].guess = summary.rate(kGuesses, places[kGuesses].values + person);
    }
  }
}

HierarchicalFit summarised(const Model& model, const Sampler& sampler) {
  Summary summary(model, sampler);
  HierarchicalFit fit;
  add_group(model, summary, fit);
  add_people(model, summary, fit);
  fit.chains = sampler.chains();
  fit.draws = sampler.length();
  fit.r_hat = summary.r_hat();
  fit.effective = summary.effective();
  fit.converged = fit.r_hat < kMostRHat && fit.effective >= kFewestEffective;
  return fit;
}

}  // namespace

HierarchicalFit hierarchical_fit(const Model& model, const Sampling& sampling) {
  Sampler sampler(model, sampling);
  sampler.extend(sampling.draws);
  HierarchicalFit fit = summarised(model, sampler);
  while (!fit.converged && sampler.length() < sampling.most_draws) {
    sampler.extend(std::min(sampler.length() / 2, sampling.most_draws - sampler.length()));
    fit = summarised(model, sampler);
  }
  fit.warm_up = sampling.warm_up;
  const std::vector<double> p = predictive_p(model, sampler, kReplications, sampling.seed);
  for (std::size_t person = 0; person < p.size(); ++person) {
    fit.people[person].predictive_p = p[person];
  }
  return fit;
}

}  // namespace haptrial::analysis::hierarchical
