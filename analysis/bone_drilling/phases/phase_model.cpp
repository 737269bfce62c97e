#include "analysis/bone_drilling/phases/phase_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::analysis::drilling {
namespace {

using Weights = std::vector<Eigen::MatrixXd>;  // (cases), each (actions x phases)

constexpr double kPriorCount = 0.5;       // of a word, a start or a transition
constexpr double kLeastDeviation = 0.05;  // of that of all actions together
constexpr int kStarts = 8;                // of the search without labels
constexpr int kMostRounds = 200;
constexpr double kGain = 1e-7;  // a smaller relative gain of likelihood ends the search

Eigen::RowVectorXd numbers_of(const Action& action) {
  return Eigen::Map<const Eigen::RowVectorXd>(action.numbers.data(), kActionNumbers);
}

/// Mean and standard deviation of all actions, from which phases begin; a deviation is above 0.
struct Spread {
  Eigen::RowVectorXd mean{Eigen::RowVectorXd::Zero(kActionNumbers)};
  Eigen::RowVectorXd deviation{Eigen::RowVectorXd::Ones(kActionNumbers)};
};

Spread spread_of(std::span<const PhaseCase> cases) {
  Spread spread;
  double count = 0.0;
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(kActionNumbers);
  for (const PhaseCase& each : cases) {
    for (const Action& action : each.actions) {
      count += 1.0;
      const Eigen::RowVectorXd off = numbers_of(action) - spread.mean;
      spread.mean += off / count;
      squares.array() += off.array() * (numbers_of(action) - spread.mean).array();
    }
  }
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const double deviation = std::sqrt(squares[i] / std::max(count, 1.0));
    spread.deviation[i] = deviation > 0.0 ? deviation : 1.0;
  }
  return spread;
}

std::vector<std::string> words_in(std::span<const PhaseCase> cases, std::size_t which) {
  std::vector<std::string> words;
  for (const PhaseCase& each : cases) {
    for (const Action& action : each.actions) {
      words.push_back(action.words[which]);
    }
  }
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

Eigen::Index column_of(const WordDensity& density, const std::string& word) {
  return std::find(density.words.begin(), density.words.end(), word) - density.words.begin();
}

template <class Use>
void for_each_action(std::span<const PhaseCase> cases, const Weights& weights, const Use& use) {
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (std::size_t t = 0; t < cases[c].actions.size(); ++t) {
      use(cases[c].actions[t], weights[c].row(static_cast<Eigen::Index>(t)).transpose().eval());
    }
  }
}

/// Sets words and numbers of the phases to those of the actions, each with the weight that it has
/// in each phase.
void fit_actions(std::span<const PhaseCase> cases, const Weights& weights, const Spread& spread,
                 PhaseModel& model) {
  const auto phases = static_cast<Eigen::Index>(model.phases.size());
  Eigen::VectorXd total = Eigen::VectorXd::Zero(phases);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(phases, kActionNumbers), squares = sum;
  std::array<Eigen::MatrixXd, kActionWords> counts;
  for (std::size_t w = 0; w < kActionWords; ++w) {
    const auto words = static_cast<Eigen::Index>(model.words[w].words.size());
    counts[w] = Eigen::MatrixXd::Constant(phases, words + 1, kPriorCount);
  }
  for_each_action(cases, weights, [&](const Action& action, const Eigen::VectorXd& weight) {
    const Eigen::RowVectorXd off = numbers_of(action) - spread.mean;
    total += weight;
    sum += weight * off;
    squares += weight * off.cwiseProduct(off);
    for (std::size_t w = 0; w < kActionWords; ++w) {
      counts[w].col(column_of(model.words[w], action.words[w])) += weight;
    }
  });
  model.mean.resize(phases, kActionNumbers);
  model.deviation.resize(phases, kActionNumbers);
  for (Eigen::Index phase = 0; phase < phases; ++phase) {
    const double count = std::max(total[phase], 1e-9);
    const Eigen::RowVectorXd mean = sum.row(phase) / count;
    const Eigen::ArrayXd variance =
        (squares.row(phase) / count - mean.cwiseProduct(mean)).cwiseMax(0.0).transpose().array();
    model.mean.row(phase) = spread.mean + mean;
    model.deviation.row(phase) =
        variance.sqrt().max(kLeastDeviation * spread.deviation.transpose().array()).transpose();
  }
  for (std::size_t w = 0; w < kActionWords; ++w) {
    const Eigen::VectorXd sums = counts[w].rowwise().sum();
    model.words[w].log_share = (counts[w].array().colwise() / sums.array()).log();
  }
}

PhaseModel empty_model(std::span<const PhaseCase> cases, std::vector<std::string> phases) {
  PhaseModel model;
  model.phases = std::move(phases);
  std::vector<std::string> people;
  for (const PhaseCase& each : cases) {
    people.push_back(each.participant);
  }
  std::sort(people.begin(), people.end());
  model.procedures = people.size();
  model.participants =
      static_cast<std::size_t>(std::unique(people.begin(), people.end()) - people.begin());
  for (std::size_t w = 0; w < kActionWords; ++w) {
    model.words[w].words = words_in(cases, w);
  }
  return model;
}

std::size_t actions_in(std::span<const PhaseCase> cases) {
  std::size_t count = 0;
  for (const PhaseCase& each : cases) {
    count += each.actions.size();
  }
  return count;
}

/// Weight 1 in the phase that is nearest to a number of randomly chosen actions, or, without a
/// stream, in the phase that equal parts of each procedure's time give.
Weights first_weights(std::span<const PhaseCase> cases, int count, const Spread& spread,
                      RandomStream* random) {
  Eigen::MatrixXd middle(count, static_cast<Eigen::Index>(kActionNumbers));
  if (random != nullptr) {
    for (Eigen::Index phase = 0; phase < count; ++phase) {
      const PhaseCase& each = cases[random->below(cases.size())];
      middle.row(phase) = numbers_of(each.actions[random->below(each.actions.size())]);
    }
  }
  Weights weights;
  for (const PhaseCase& each : cases) {
    const auto actions = static_cast<Eigen::Index>(each.actions.size());
    weights.emplace_back(Eigen::MatrixXd::Zero(actions, count));
    for (Eigen::Index t = 0; t < actions; ++t) {
      Eigen::Index phase = t * count / actions;
      if (random != nullptr) {
        const Eigen::RowVectorXd here = numbers_of(each.actions[static_cast<std::size_t>(t)]);
        ((middle.rowwise() - here).array().rowwise() / spread.deviation.array())
            .square()
            .rowwise()
            .sum()
            .minCoeff(&phase);
      }
      weights.back()(t, phase) = 1.0;
    }
  }
  return weights;
}

/// Improves a model until its likelihood hardly grows. @returns the likelihood's logarithm
double improve(std::span<const PhaseCase> cases, Weights& weights, const Spread& spread,
               PhaseModel& model) {
  const auto phases = static_cast<Eigen::Index>(model.phases.size());
  model.chain = chain_of_counts(Eigen::VectorXd::Zero(phases),
                                8.0 * Eigen::MatrixXd::Identity(phases, phases), kPriorCount);
  double before = -std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostRounds; ++round) {
    fit_actions(cases, weights, spread, model);
    Eigen::VectorXd start = Eigen::VectorXd::Zero(phases);
    Eigen::MatrixXd transition = Eigen::MatrixXd::Zero(phases, phases);
    double likelihood = 0.0;
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const StatePosterior posterior =
          state_posterior(model.chain, emission_of(model, cases[c].actions));
      likelihood += posterior.log_likelihood;
      weights[c] = posterior.states;
      start += posterior.states.row(0).transpose();
      transition += posterior.transitions;
    }
    if (likelihood - before < kGain * std::abs(likelihood)) {
      return likelihood;
    }
    before = likelihood;
    model.chain = chain_of_counts(start, transition, kPriorCount);
  }
  return before;
}

/// Phases by the mean share of a procedure at which their actions are.
std::vector<Eigen::Index> in_order_of_time(std::span<const PhaseCase> cases,
                                           const Weights& weights) {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(weights.front().cols());
  Eigen::VectorXd total = share;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (Eigen::Index t = 0; t < weights[c].rows(); ++t) {
      share += static_cast<double>(t) / static_cast<double>(weights[c].rows()) *
               weights[c].row(t).transpose();
      total += weights[c].row(t).transpose();
    }
  }
  share.array() /= total.array().max(1e-9);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(share.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return share[a] < share[b]; });
  return order;
}

void put_in_order(const std::vector<Eigen::Index>& order, PhaseModel& model) {
  const PhaseModel old = model;
  for (std::size_t to = 0; to < order.size(); ++to) {
    const auto row = static_cast<Eigen::Index>(to);
    const Eigen::Index from = order[to];
    model.chain.start[row] = old.chain.start[from];
    for (std::size_t next = 0; next < order.size(); ++next) {
      model.chain.transition(row, static_cast<Eigen::Index>(next)) =
          old.chain.transition(from, order[next]);
    }
    model.mean.row(row) = old.mean.row(from);
    model.deviation.row(row) = old.deviation.row(from);
    for (std::size_t w = 0; w < kActionWords; ++w) {
      model.words[w].log_share.row(row) = old.words[w].log_share.row(from);
    }
  }
}

}  // namespace

Defined<PhaseModel> learn_phases(std::span<const PhaseCase> cases,
                                 const std::vector<std::string>& phases) {
  PhaseModel model = empty_model(cases, phases);
  model.labelled = true;
  const auto count = static_cast<Eigen::Index>(phases.size());
  Weights weights;
  Eigen::VectorXd start = Eigen::VectorXd::Zero(count), total = start;
  Eigen::MatrixXd transition = Eigen::MatrixXd::Zero(count, count);
  for (const PhaseCase& each : cases) {
    weights.emplace_back(
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(each.actions.size()), count));
    for (std::size_t t = 0; t < each.phase.size(); ++t) {
      const int phase = each.phase[t];
      if (phase < 0) {
        continue;
      }
      weights.back()(static_cast<Eigen::Index>(t), phase) = 1.0;
      total[phase] += 1.0;
      start[phase] += t == 0 ? 1.0 : 0.0;
      if (t > 0 && each.phase[t - 1] >= 0) {
        transition(each.phase[t - 1], phase) += 1.0;
      }
    }
  }
  for (Eigen::Index phase = 0; phase < count; ++phase) {
    if (total[phase] < 2.0) {
      return Undefined{fmt::format("phase \"{}\" has {} strokes or seconds; it needs at least 2",
                                   phases[static_cast<std::size_t>(phase)], total[phase])};
    }
  }
  model.chain = chain_of_counts(start, transition, kPriorCount);
  fit_actions(cases, weights, spread_of(cases), model);
  return model;
}

Defined<PhaseModel> find_phases(std::span<const PhaseCase> given, int count, std::uint64_t seed) {
  std::vector<PhaseCase> cases(given.begin(), given.end());
  std::erase_if(cases, [](const PhaseCase& each) { return each.actions.empty(); });
  constexpr std::size_t kActionsAPhase = 4;
  if (actions_in(cases) < kActionsAPhase * static_cast<std::size_t>(count)) {
    return Undefined{fmt::format("there are {} strokes or seconds; {} phases need at least {}",
                                 actions_in(cases), count,
                                 kActionsAPhase * static_cast<std::size_t>(count))};
  }
  std::vector<std::string> names;
  for (int phase = 1; phase <= count; ++phase) {
    names.push_back(fmt::format("phase {}", phase));
  }
  const Spread spread = spread_of(cases);
  RandomStream random(seed, "starts of phases");
  std::optional<PhaseModel> best;
  double most = 0.0;
  for (int start = 0; start < kStarts; ++start) {
    PhaseModel model = empty_model(cases, names);
    Weights weights = first_weights(cases, count, spread, start == 0 ? nullptr : &random);
    const double likelihood = improve(cases, weights, spread, model);
    if (!best || likelihood > most) {
      put_in_order(in_order_of_time(cases, weights), model);
      best = std::move(model);
      most = likelihood;
    }
  }
  return *best;
}

Eigen::MatrixXd emission_of(const PhaseModel& model, std::span<const Action> actions) {
  const auto phases = static_cast<Eigen::Index>(model.phases.size());
  const double base = -0.5 * std::log(2.0 * std::numbers::pi) * kActionNumbers;
  const Eigen::VectorXd scale = base - model.deviation.array().log().rowwise().sum();
  Eigen::MatrixXd emission(static_cast<Eigen::Index>(actions.size()), phases);
  for (std::size_t t = 0; t < actions.size(); ++t) {
    const Eigen::RowVectorXd here = numbers_of(actions[t]);
    Eigen::VectorXd log_density =
        scale.array() - 0.5 * ((model.mean.rowwise() - here).array() / model.deviation.array())
                                  .square()
                                  .rowwise()
                                  .sum();
    for (std::size_t w = 0; w < kActionWords; ++w) {
      log_density += model.words[w].log_share.col(column_of(model.words[w], actions[t].words[w]));
    }
    emission.row(static_cast<Eigen::Index>(t)) = log_density.transpose();
  }
  return emission;
}

std::vector<int> phases_of(const PhaseModel& model, std::span<const Action> actions) {
  return actions.empty() ? std::vector<int>()
                         : most_probable_path(model.chain, emission_of(model, actions)).states;
}

namespace {

/// @throws InputError if a model knows no word of one fact about a procedure's actions, but "none"
void require_known(const PhaseModel& model, std::span<const Action> actions, ActionWord which,
                   const char* what) {
  const std::vector<std::string>& known = model.words[static_cast<std::size_t>(which)].words;
  std::set<std::string> own;
  for (const Action& action : actions) {
    own.insert(action.words[static_cast<std::size_t>(which)]);
  }
  own.erase("none");
  if (!own.empty() && std::ranges::none_of(own, [&](const std::string& word) {
        return std::ranges::find(known, word) != known.end();
      })) {
    throw InputError(
        fmt::format("phases of study \"{}\" know none of the {} of this procedure ({}); learn them "
                    "from a study with the same",
                    model.study, what, fmt::join(own, ", ")));
  }
}

}  // namespace

void require_known_words(const PhaseModel& model, std::span<const Action> actions) {
  require_known(model, actions, ActionWord::kTool, "tools");
  require_known(model, actions, ActionWord::kStructure, "vital structures");
}

std::vector<PhaseSpan> divide(const PhaseModel& model, const Procedure& procedure,
                              StudyBones& bones) {
  const std::vector<Action> actions = actions_of(procedure, bones);
  require_known_words(model, actions);
  const std::vector<int> phases = phases_of(model, actions);
  std::vector<PhaseSpan> spans;
  for (std::size_t t = 0; t < actions.size(); ++t) {
    if (t == 0 || phases[t] != phases[t - 1]) {
      const double start = static_cast<double>(actions[t].first) / procedure.rate;
      spans.push_back({model.phases[static_cast<std::size_t>(phases[t])], start, start});
    }
    spans.back().end = static_cast<double>(actions[t].last + 1) / procedure.rate;
  }
  return spans;
}

}  // namespace haptrial::analysis::drilling
