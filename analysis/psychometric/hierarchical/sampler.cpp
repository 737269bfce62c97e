#include "analysis/psychometric/hierarchical/sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/require.h"

namespace haptrial::analysis::hierarchical {

NumberPlaces::NumberPlaces(const Model& model) {
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    if (family.entries() == 0) {
      continue;
    }
    families[f].means = count;
    families[f].between = count + family.columns;
    families[f].within = families[f].between + 1;
    families[f].values = families[f].within + (family.within ? 1 : 0);
    count = families[f].values + family.entries();
  }
}

std::vector<double> numbers_of(const Model& model, const State& state) {
  std::vector<double> all;
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    if (family.entries() == 0) {
      continue;
    }
    all.insert(all.end(), state[f].means.begin(), state[f].means.end());
    all.push_back(state[f].between);
    if (family.within) {
      all.push_back(state[f].within);
    }
    all.insert(all.end(), state[f].values.begin(), state[f].values.end());
  }
  return all;
}

Sampler::Sampler(const Model& model, const Sampling& sampling)
    : model_(model), threads_(sampling.threads), drawn_(sampling.chains) {
  require(sampling.chains >= 1, "chains must be at least 1");
  require(sampling.draws >= 8, "draws must be at least 8");
  require(sampling.threads >= 1, "threads must be at least 1");
  for (std::size_t i = 0; i < sampling.chains; ++i) {
    chains_.emplace_back(model, sampling.seed, fmt::format("hierarchical chain {}", i));
  }
  parallel_for(chains_.size(), threads_,
               [&](std::size_t i) { chains_[i].warm_up(sampling.warm_up); });
}

void Sampler::extend(std::size_t draws) {
  parallel_for(chains_.size(), threads_, [&](std::size_t i) {
    for (std::size_t draw = 0; draw < draws; ++draw) {
      chains_[i].sweep();
      drawn_[i].push_back(numbers_of(model_, chains_[i].state()));
    }
  });
  length_ += draws;
}

std::vector<double> Sampler::draws(std::size_t number) const {
  std::vector<double> all;
  all.reserve(chains_.size() * length_);
  for (const auto& chain : drawn_) {
    for (const std::vector<double>& numbers : chain) {
      all.push_back(numbers[number]);
    }
  }
  return all;
}

namespace {

constexpr int kPeopleDraws = 2, kGroupDraws = 2;  // of each sweep
constexpr std::size_t kFirstPart = 16;            // of the warm-up is the first of its parts

/// A beginning with spreads of the priors' size, so that no chain begins where nothing moves.
FamilyState begin(const Family& family, RandomStream& random) {
  FamilyState state;
  state.between = family.prior.spread * std::exp(random.uniform(-1.0, 1.0));
  state.within = family.prior.spread * std::exp(random.uniform(-1.0, 1.0));
  for (std::size_t column = 0; column < family.columns; ++column) {
    state.means.push_back(family.prior.mean + 0.25 * family.prior.deviation * random.normal());
  }
  for (std::size_t e = 0; e < family.entries(); ++e) {
    state.values.push_back(state.means[family.column[e]] +
                           0.5 * family.prior.spread * random.normal());
  }
  return state;
}

}  // namespace

Chain::Chain(const Model& model, std::uint64_t seed, std::string_view name)
    : model_(model), random_(seed, name), likelihood_(model.answers().size()), group_(model) {
  for (std::size_t f = 0; f < kFamilies; ++f) {
    state_[f] = begin(model.family(f), random_);
  }
  for (std::size_t person = 0; person < model.people(); ++person) {
    people_.emplace_back(model, person);
  }
  set_likelihoods(state_, likelihood_);
  tried_ = state_;
  tried_likelihood_ = likelihood_;
}

void Chain::set_likelihoods(const State& state, std::vector<double>& all) const {
  const Family& family = model_.family(kThresholds);
  for (std::size_t person = 0; person < model_.people(); ++person) {
    const auto rate = [&](std::size_t f) {
      return model_.family(f).entries() > 0 ? state[f].values[person] : 0.0;
    };
    const Model::Rates rates = model_.rates(rate(kLapses), rate(kGuesses));
    for (std::size_t s = family.first[person]; s < family.first[person + 1]; ++s) {
      all[s] = model_.log_likelihood(s, state[kThresholds].values[s], state[kLogWidths].values[s],
                                     rates);
    }
  }
}

void Chain::fit_people() {
  for (PersonBlock& person : people_) {
    person.fit(state_);
  }
}

void Chain::warm_up(std::size_t sweeps) {
  EllipseLearner group;
  std::size_t part = std::max<std::size_t>(sweeps / kFirstPart, 1);  // each is twice the one before
  fit_people();
  for (std::size_t i = 1; i <= sweeps; ++i) {
    sweep();
    group.add(group_.values(state_));
    for (PersonBlock& person : people_) {
      person.note(state_);
    }
    if (i != part && i != sweeps) {
      continue;
    }
    part *= 2;
    fit_people();
    if (group.count() > 2 * group_.size()) {
      group_ellipse_ = group.learnt();
      learnt_ = true;
      std::ranges::for_each(people_, &PersonBlock::learn);
    }
    group = {};
  }
}

void Chain::sweep() {
  constexpr std::array kAround{PersonBlock::Around::kApproximation, PersonBlock::Around::kLearnt,
                               PersonBlock::Around::kApproximation, PersonBlock::Around::kLearnt,
                               PersonBlock::Around::kPrior};
  for (int i = 0; i < kPeopleDraws; ++i) {
    const PersonBlock::Around around = kAround[people_draws_++ % kAround.size()];
    for (PersonBlock& person : people_) {
      person.draw(state_, likelihood_, around, random_);
    }
  }
  draw_group_given_people();
  for (int i = 0; learnt_ && i < kGroupDraws; ++i) {
    draw_group_with_people();
  }
}

void Chain::draw_group_given_people() {
  for (std::size_t f = 0; f < kFamilies; ++f) {
    if (model_.family(f).entries() > 0) {
      draw_spreads(model_.family(f), state_[f], random_);
      draw_means(model_.family(f), state_[f], random_);
    }
  }
}

double Chain::carry(const Eigen::VectorXd& group) {
  group_.set_values(group, tried_);
  double sum = group_.log_prior(tried_);
  if (!std::isfinite(sum)) {
    return sum;
  }
  for (PersonBlock& person : people_) {
    sum += person.carry(tried_);
  }
  set_likelihoods(tried_, tried_likelihood_);
  for (const double each : tried_likelihood_) {
    sum += each;
  }
  return sum;
}

void Chain::draw_group_with_people() {
  double here = group_.log_prior(state_);
  for (const double each : likelihood_) {
    here += each;
  }
  for (PersonBlock& person : people_) {
    person.begin_carrying(state_);
  }
  group_ellipse_.draw(group_.values(state_), here, random_,
                      [this](const Eigen::VectorXd& group) { return carry(group); });
  std::swap(state_, tried_);
  std::swap(likelihood_, tried_likelihood_);
}

namespace {

constexpr double kSmallestSpread = 1e-5;  // of the scale of its prior

}  // namespace

GroupBlock::GroupBlock(const Model& model) : model_(model) {
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    if (family.entries() == 0) {
      continue;
    }
    for (std::size_t column = 0; column < family.columns; ++column) {
      places_.push_back({f, column, nullptr});
    }
    places_.push_back({f, 0, &FamilyState::between});
    if (family.within) {
      places_.push_back({f, 0, &FamilyState::within});
    }
  }
}

Eigen::VectorXd GroupBlock::values(const State& state) const {
  Eigen::VectorXd all(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    const FamilyState& own = state[place.family];
    all[i] = place.spread == nullptr ? own.means[place.column] : own.*place.spread;
  }
  return all;
}

void GroupBlock::set_values(const Eigen::VectorXd& values, State& state) const {
  for (Eigen::Index i = 0; i < size(); ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    FamilyState& own = state[place.family];
    (place.spread == nullptr ? own.means[place.column] : own.*place.spread) = values[i];
  }
}

double GroupBlock::log_prior(const State& state) const {
  double sum = 0.0;
  for (const Place& place : places_) {
    const FamilyPrior& prior = model_.family(place.family).prior;
    const FamilyState& own = state[place.family];
    if (place.spread == nullptr) {
      const double z = (own.means[place.column] - prior.mean) / prior.deviation;
      sum -= 0.5 * z * z;
    } else if (own.*place.spread < kSmallestSpread * prior.spread ||
               !std::isfinite(own.*place.spread)) {
      return -std::numeric_limits<double>::infinity();
    } else {
      sum += log_spread_prior(prior, own.*place.spread) - std::log(own.*place.spread);
    }
  }
  return sum;
}

}  // namespace haptrial::analysis::hierarchical
