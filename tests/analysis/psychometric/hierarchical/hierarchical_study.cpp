#include "tests/analysis/psychometric/hierarchical/hierarchical_study.h"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

#include "analysis/psychometric/hierarchical/sampler.h"
#include "core/base/parallel.h"

namespace haptrial::test {
namespace {

using namespace analysis;
using namespace analysis::hierarchical;

constexpr std::size_t kThinning = 20;  // draws so far apart are nearly independent
constexpr double kEffect = 0.1;        // of the second condition on the threshold

/// Not below a smallest share, as family_state.cpp has it.
double draw_half_t(double scale, RandomStream& random) {
  constexpr int kDegrees = 3;
  constexpr double kSmallestShare = 1e-5;
  double squares = 0.0;
  for (int i = 0; i < kDegrees; ++i) {
    const double z = random.normal();
    squares += z * z;
  }
  return scale *
         std::max(std::abs(random.normal()) / std::sqrt(squares / kDegrees), 2.0 * kSmallestShare);
}

/// Draws a family from its prior.
FamilyState draw_prior(const Family& family, RandomStream& random) {
  FamilyState state;
  state.between = draw_half_t(family.prior.spread, random);
  state.within = draw_half_t(family.prior.spread, random);
  for (std::size_t column = 0; column < family.columns; ++column) {
    state.means.push_back(family.prior.mean + family.prior.deviation * random.normal());
  }
  for (std::size_t person = 0; person + 1 < family.first.size(); ++person) {
    const double shared = state.between * random.normal();
    for (std::size_t e = family.first[person]; e < family.first[person + 1]; ++e) {
      state.values.push_back(state.means[family.column[e]] + shared +
                             (family.within ? state.within * random.normal() : 0.0));
    }
  }
  return state;
}

std::vector<PersonAnswers> design_of(const HierarchicalStudy& study) {
  std::vector<PersonAnswers> all;
  for (std::size_t person = 0; person < study.people; ++person) {
    for (std::size_t condition = 0; condition < study.conditions; ++condition) {
      PersonAnswers& made = all.emplace_back();
      made.person = person;
      made.condition = condition;
      for (std::size_t i = 0; i < study.levels; ++i) {
        made.blocks.push_back(
            {static_cast<double>(i) / static_cast<double>(study.levels - 1), 0, study.trials});
      }
    }
  }
  return all;
}

/// Names of the numbers of a state that are checked: those of the group and of the first person.
std::vector<std::pair<std::string, std::size_t>> checked_numbers(const Model& model) {
  constexpr const char* kNames[] = {"threshold", "log width", "lapse", "guess"};
  const NumberPlaces places(model);
  std::vector<std::pair<std::string, std::size_t>> all;
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    if (family.entries() == 0) {
      continue;
    }
    const auto& own = places.families[f];
    for (std::size_t c = 0; c < family.columns; ++c) {
      all.emplace_back(fmt::format("mean {} {}", kNames[f], c + 1), own.means + c);
    }
    all.emplace_back(fmt::format("spread between of {}", kNames[f]), own.between);
    if (family.within) {
      all.emplace_back(fmt::format("spread within of {}", kNames[f]), own.within);
    }
    all.emplace_back(fmt::format("{} of a person", kNames[f]), own.values);
  }
  return all;
}

}  // namespace

HierarchicalStudy small_study() {
  HierarchicalStudy study;
  study.options.function = psychometric::parameters_named("norm", 0.5);
  study.options.lapse = {0.0, 0.2};
  return study;
}

Model model_without_answers(const HierarchicalStudy& study) {
  return {design_of(study), study.options};
}

Model simulated_model(const HierarchicalStudy& study, const State& truth, RandomStream& random) {
  std::vector<PersonAnswers> answers = design_of(study);
  const Model model(answers, study.options);
  for (std::size_t s = 0; s < answers.size(); ++s) {
    const auto rate = [&](std::size_t f) {
      return truth[f].values.empty() ? 0.0 : truth[f].values[answers[s].person];
    };
    const std::vector<double> p =
        model.probabilities(s, truth[kThresholds].values[s], truth[kLogWidths].values[s],
                            model.rates(rate(kLapses), rate(kGuesses)));
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (int trial = 0; trial < study.trials; ++trial) {
        answers[s].blocks[i].correct += random.uniform() < p[i] ? 1 : 0;
      }
    }
  }
  return {std::move(answers), study.options};
}

State typical_people(const HierarchicalStudy& study, double effect, RandomStream& random) {
  const Model model = model_without_answers(study);
  State people;
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    FamilyState& own = people[f];
    own.between = f == kThresholds ? 0.15 : 0.3;
    own.within = f == kThresholds ? 0.08 : 0.1;
    own.means.assign(family.columns, f == kThresholds ? 0.0 : f == kLogWidths ? -0.5 : -2.0);
    if (f == kThresholds && family.columns > 1) {
      own.means[1] = effect;
    }
    std::vector<double> shared(study.people);
    std::ranges::generate(shared, [&] { return own.between * random.normal(); });
    for (std::size_t e = 0; e < family.entries(); ++e) {
      const std::size_t person = family.columns > 1 ? e / study.conditions : e;
      own.values.push_back(own.means[family.column[e]] + shared[person] +
                           (family.within ? own.within * random.normal() : 0.0));
    }
  }
  return people;
}

Calibration calibration(const HierarchicalStudy& study, std::size_t studies, std::uint64_t seed,
                        int threads) {
  const Model prior = model_without_answers(study);
  const auto checked = checked_numbers(prior);
  Calibration made;
  for (const auto& [name, number] : checked) {
    made.names.push_back(name);
    made.ranks.emplace_back(studies, 0);
  }
  parallel_for(studies, threads, [&](std::size_t i) {
    RandomStream random(seed, fmt::format("calibration {}", i));
    State truth;
    for (std::size_t f = 0; f < kFamilies; ++f) {
      truth[f] = draw_prior(prior.family(f), random);
    }
    const Model model = simulated_model(study, truth, random);
    Sampling sampling;
    sampling.seed = derived_seed(seed, fmt::format("chains {}", i));
    sampling.chains = 2;
    Sampler sampler(model, sampling);
    sampler.extend(kRanks * kThinning / sampling.chains);
    const std::vector<double> numbers = numbers_of(model, truth);
    for (std::size_t k = 0; k < checked.size(); ++k) {
      const std::vector<double> draws = sampler.draws(checked[k].second);
      for (std::size_t d = 1; d < kRanks; ++d) {
        made.ranks[k][i] += draws[d * kThinning] < numbers[checked[k].second] ? 1 : 0;
      }
    }
  });
  return made;
}

double uniform_p(const std::vector<std::size_t>& ranks, std::size_t bins) {
  std::vector<double> counts(bins, 0.0);
  for (const std::size_t rank : ranks) {
    counts[rank * bins / kRanks] += 1.0;
  }
  const double expected = static_cast<double>(ranks.size()) / static_cast<double>(bins);
  double sum = 0.0;
  for (const double count : counts) {
    sum += (count - expected) * (count - expected) / expected;
  }
  return gsl_cdf_chisq_Q(sum, static_cast<double>(bins - 1));
}

Coverage coverage(const HierarchicalStudy& study, std::size_t studies, std::uint64_t seed,
                  int threads) {
  Coverage made;
  made.names = {"threshold, first condition", "threshold, second condition",
                "difference of thresholds",   "width, first condition",
                "width, second condition",    "ratio of widths"};
  std::vector<std::vector<int>> held(studies, std::vector<int>(made.names.size(), 0));
  parallel_for(studies, threads, [&](std::size_t i) {
    RandomStream random(seed, fmt::format("coverage {}", i));
    const State truth = typical_people(study, kEffect, random);
    const Model model = simulated_model(study, truth, random);
    Sampling sampling;
    sampling.seed = derived_seed(seed, fmt::format("chains {}", i));
    sampling.chains = 2;
    sampling.most_draws = sampling.draws;  // the ends of an interval need no more
    const HierarchicalFit fit = hierarchical_fit(model, sampling);
    const auto holds = [](const Posterior& p, double value) {
      return p.low <= value && value <= p.high ? 1 : 0;
    };
    const double width = std::exp(-0.5) * model.range();
    held[i] = {holds(fit.conditions[0].threshold, model.middle()),
               holds(fit.conditions[1].threshold, model.middle() + kEffect * model.range()),
               holds(fit.differences[0].threshold, kEffect * model.range()),
               holds(fit.conditions[0].width, width),
               holds(fit.conditions[1].width, width),
               holds(fit.differences[0].width_ratio, 1.0)};
  });
  made.held.assign(made.names.size(), 0);
  for (const std::vector<int>& each : held) {
    for (std::size_t k = 0; k < each.size(); ++k) {
      made.held[k] += static_cast<std::size_t>(each[k]);
    }
  }
  return made;
}

}  // namespace haptrial::test
