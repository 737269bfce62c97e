#include "analysis/psychometric/hierarchical/chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace haptrial::analysis::hierarchical {
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

}  // namespace haptrial::analysis::hierarchical
