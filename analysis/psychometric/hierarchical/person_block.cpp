#include "analysis/psychometric/hierarchical/person_block.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

namespace haptrial::analysis::hierarchical {
PersonBlock::PersonBlock(const Model& model, std::size_t person)
    : model_(model), person_(person), series_(model.family(kThresholds).first[person]) {
  const Family& thresholds = model.family(kThresholds);
  count_ = static_cast<Eigen::Index>(thresholds.first[person + 1] - series_);
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    for (std::size_t e = family.entries() > 0 ? family.first[person] : 0;
         family.entries() > 0 && e < family.first[person + 1]; ++e) {
      places_.push_back({f, e});
    }
  }
  const auto size = static_cast<Eigen::Index>(places_.size());
  information_ = prior_precision_ = Eigen::MatrixXd::Zero(size, size);
  pull_ = slope_ = prior_means_ = Eigen::VectorXd::Zero(size);
  own_likelihood_.resize(static_cast<std::size_t>(count_));
}

Eigen::VectorXd PersonBlock::values(const State& state) const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(places_.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = state[places_[i].family].values[places_[i].entry];
  }
  return all;
}

void PersonBlock::set_values(const Eigen::VectorXd& values, State& state) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    state[places_[i].family].values[places_[i].entry] = values[static_cast<Eigen::Index>(i)];
  }
}

void PersonBlock::set_prior(const State& state) {
  prior_precision_.setZero();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto [f, entry] = places_[i];
    const Family& family = model_.family(f);
    const EntryPrecision own =
        entry_precision(family, state[f], family.first[person_ + 1] - family.first[person_]);
    const auto row = static_cast<Eigen::Index>(i);
    prior_means_[row] = state[f].means[family.column[entry]];
    prior_precision_(row, row) = own.diagonal;
    for (std::size_t j = 0; j < places_.size(); ++j) {
      if (places_[j].family == f) {
        prior_precision_(row, static_cast<Eigen::Index>(j)) -= own.shared;
      }
    }
  }
}

namespace {

/// Rows of the block with the entries of one series: threshold, width, lapse and guess; -1: the
/// rate is known.
std::array<Eigen::Index, kFamilies> rows_of(const Model& model, Eigen::Index series,
                                            Eigen::Index count) {
  const bool lapse = model.family(kLapses).entries() > 0;
  const bool guess = model.family(kGuesses).entries() > 0;
  return {series, count + series, lapse ? 2 * count : -1, guess ? 2 * count + (lapse ? 1 : 0) : -1};
}

double entry(const Eigen::VectorXd& at, Eigen::Index row) { return row < 0 ? 0.0 : at[row]; }

}  // namespace

double PersonBlock::log_likelihood(const Eigen::VectorXd& at) {
  double sum = 0.0;
  const auto rows = rows_of(model_, 0, count_);
  const Model::Rates rates = model_.rates(entry(at, rows[kLapses]), entry(at, rows[kGuesses]));
  for (Eigen::Index s = 0; s < count_; ++s) {
    double& own = own_likelihood_[static_cast<std::size_t>(s)];
    own =
        model_.log_likelihood(series_ + static_cast<std::size_t>(s), at[s], at[count_ + s], rates);
    sum += own;
  }
  return sum;
}

void PersonBlock::set_curvature(const Eigen::VectorXd& at) {
  information_.setZero();
  slope_.setZero();
  for (Eigen::Index s = 0; s < count_; ++s) {
    const auto rows = rows_of(model_, s, count_);
    const Model::Curvature own =
        model_.curvature(series_ + static_cast<std::size_t>(s), at[s], at[count_ + s],
                         entry(at, rows[kLapses]), entry(at, rows[kGuesses]));
    for (std::size_t a = 0; a < kFamilies; ++a) {
      for (std::size_t b = 0; rows[a] >= 0 && b < kFamilies; ++b) {
        if (rows[b] >= 0) {
          information_(rows[a], rows[b]) += own.information[a][b];
        }
      }
      if (rows[a] >= 0) {
        slope_[rows[a]] += own.slope[a];
      }
    }
  }
}

void PersonBlock::fit(const State& state) {
  constexpr int kMostSteps = 30;
  constexpr double kStill = 1e-6;
  set_prior(state);
  const auto density = [&](const Eigen::VectorXd& at) {
    const Eigen::VectorXd away = at - prior_means_;
    return log_likelihood(at) - 0.5 * away.dot(prior_precision_ * away);
  };
  Eigen::VectorXd at = values(state);
  double here = density(at);
  for (int step = 0; step < kMostSteps; ++step) {
    set_curvature(at);
    const Eigen::MatrixXd precision = prior_precision_ + information_;
    Eigen::VectorXd move = precision.llt().solve(slope_ - prior_precision_ * (at - prior_means_));
    double next = density(at + move);
    for (int halving = 0; !(next >= here) && halving < 20; ++halving) {
      move *= 0.5;
      next = density(at + move);
    }
    if (!(next >= here)) {
      break;
    }
    at += move;
    const bool still = next - here < kStill;
    here = next;
    if (still) {
      break;
    }
  }
  set_curvature(at);
  pull_ = slope_ + information_ * at;
}

/// Normal posterior of the block with the precision L L' around a mean.
struct PersonBlock::Normal {
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd mean;

  double log_root() const {  // log |L|
    return factor.matrixLLT().diagonal().array().log().sum();
  }
};

PersonBlock::Normal PersonBlock::normal_posterior() const {
  Normal made{(prior_precision_ + information_).llt(), {}};
  made.mean = made.factor.solve(prior_precision_ * prior_means_ + pull_);
  return made;
}

void PersonBlock::learn() {
  learnt_ = learner_.learnt();
  has_learnt_ = true;
  learner_ = {};
}

void PersonBlock::draw(State& state, std::vector<double>& likelihood, Around around,
                       RandomStream& random) {
  set_prior(state);
  if (around == Around::kPrior) {
    draw_around({prior_means_, prior_precision_}, state, likelihood, random);
  } else if (around == Around::kLearnt && has_learnt_) {
    draw_around(learnt_, state, likelihood, random);
  } else {
    const Normal normal = normal_posterior();
    draw_around({normal.mean, prior_precision_ + information_}, state, likelihood, random);
  }
}

void PersonBlock::draw_around(const TEllipse& ellipse, State& state,
                              std::vector<double>& likelihood, RandomStream& random) {
  const auto log_prior = [&](const Eigen::VectorXd& at) {
    const Eigen::VectorXd off = at - prior_means_;
    return -0.5 * off.dot(prior_precision_ * off);
  };
  const Eigen::VectorXd start = values(state);
  double here = log_prior(start);
  for (std::size_t s = 0; s < own_likelihood_.size(); ++s) {
    here += likelihood[series_ + s];
  }
  const auto target = [&](const Eigen::VectorXd& at) { return log_likelihood(at) + log_prior(at); };
  set_values(ellipse.draw(start, here, random, target), state);
  for (std::size_t s = 0; s < own_likelihood_.size(); ++s) {
    likelihood[series_ + s] = own_likelihood_[s];
  }
}

namespace {

/// Log-density of one person's values, up to a constant.
double log_prior(const Family& family, const FamilyState& state, std::size_t person) {
  const std::size_t first = family.first[person], end = family.first[person + 1];
  const auto count = static_cast<double>(end - first);
  const EntryPrecision p = entry_precision(family, state, end - first);
  double sum = 0.0, squares = 0.0;
  for (std::size_t e = first; e < end; ++e) {
    const double away = state.values[e] - state.means[family.column[e]];
    sum += away;
    squares += away * away;
  }
  return 0.5 * ((count - 1.0) * std::log(p.diagonal) + std::log(p.diagonal - count * p.shared)) -
         0.5 * (p.diagonal * squares - p.shared * sum * sum);
}

}  // namespace

double PersonBlock::log_prior_of(const State& state) const {
  double sum = 0.0;
  for (std::size_t f = 0; f < kFamilies; ++f) {
    sum += model_.family(f).entries() > 0 ? log_prior(model_.family(f), state[f], person_) : 0.0;
  }
  return sum;
}

void PersonBlock::begin_carrying(const State& state) {
  set_prior(state);
  const Normal own = normal_posterior();
  carried_ = own.factor.matrixU() * (values(state) - own.mean);
  carried_density_ = log_prior_of(state) - own.log_root();
}

double PersonBlock::carry(State& state) {
  set_prior(state);
  const Normal own = normal_posterior();
  set_values(own.mean + own.factor.matrixU().solve(carried_), state);
  return log_prior_of(state) - own.log_root() - carried_density_;
}

}  // namespace haptrial::analysis::hierarchical
