#include "analysis/reaching/two_rate.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "analysis/statistics/base/decomposition.h"

namespace haptrial::analysis {
namespace {

/// A_f, B_f, A_s, B_s, error_scale.
using Parameters = Eigen::Matrix<double, 5, 1>;
using Curvature = Eigen::Matrix<double, 5, 5>;

constexpr int kSteps = 200;
constexpr double kConverged = 1e-12;  // relative fall of the squares
constexpr std::size_t kFewestMeasured = 8;

Parameters parameters_of(const TwoRateModel& m) {
  return {m.fast.retention, m.fast.learning, m.slow.retention, m.slow.learning, m.error_scale};
}

TwoRateModel model_of(const Parameters& p) { return {{p[0], p[1]}, {p[2], p[3]}, p[4]}; }

/// The first four run over the whole line in the search: log(p / (1 - p)).
Parameters to_line(Parameters p) {
  p.head<4>() = (p.head<4>().array() / (1.0 - p.head<4>().array())).log();
  return p;
}

Parameters from_line(Parameters p) {
  p.head<4>() = 1.0 / (1.0 + (-p.head<4>().array()).exp());
  return p;
}

/// Sum of squared residuals, its gradient halved, and J'J, in the model's own parameters.
struct Squares {
  double sum{0.0};
  Parameters gradient{Parameters::Zero()};
  Curvature curvature{Curvature::Zero()};
  std::size_t count{0};
};

/// A trial of several participants with the same schedule: the mean of what was measured.
struct PooledTrial {
  double perturbation{0.0};
  bool error_clamp{false};
  double mean{0.0};
  double count{0.0};
};

struct PooledSequence {
  std::vector<PooledTrial> trials;
  double within{0.0};  // squared deviations from the means
};

void add_sequence(const Parameters& p, const std::vector<PooledTrial>& trials, Squares& squares) {
  double fast = 0.0, slow = 0.0;
  Eigen::Vector4d d_fast = Eigen::Vector4d::Zero(), d_slow = Eigen::Vector4d::Zero();
  for (const PooledTrial& trial : trials) {
    const double error = trial.error_clamp ? 0.0 : trial.perturbation - fast - slow;
    const Eigen::Vector4d d_state = d_fast + d_slow;
    const Eigen::Vector4d d_error =
        trial.error_clamp ? Eigen::Vector4d::Zero().eval() : (-d_state).eval();
    if (trial.count > 0.0) {
      Parameters slope;
      slope.head<4>() = trial.error_clamp ? d_state : (p[4] * d_error).eval();
      slope[4] = error;
      const double left = trial.mean - (trial.error_clamp ? fast + slow : p[4] * error);
      squares.sum += trial.count * left * left;
      squares.gradient += trial.count * left * slope;
      squares.curvature.selfadjointView<Eigen::Lower>().rankUpdate(slope, trial.count);
      squares.count += static_cast<std::size_t>(trial.count);
    }
    d_fast = p[0] * d_fast + p[1] * d_error;
    d_fast[0] += fast;
    d_fast[1] += error;
    d_slow = p[2] * d_slow + p[3] * d_error;
    d_slow[2] += slow;
    d_slow[3] += error;
    fast = p[0] * fast + p[1] * error;
    slow = p[2] * slow + p[3] * error;
  }
}

bool same_schedule(const AdaptationSequence& a, const std::vector<PooledTrial>& b) {
  return std::ranges::equal(a, b, [](const AdaptationTrial& x, const PooledTrial& y) {
    return x.perturbation == y.perturbation && x.error_clamp == y.error_clamp;
  });
}

void pool(const AdaptationSequence& sequence, PooledSequence& pooled) {
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const double value = sequence[i].measured;
    if (std::isnan(value)) {
      continue;
    }
    PooledTrial& trial = pooled.trials[i];
    trial.count += 1.0;
    const double off = value - trial.mean;
    trial.mean += off / trial.count;
    pooled.within += off * (value - trial.mean);
  }
}

/// Participants of the given rows; those with the same schedule are run through once.
struct Chosen {
  std::vector<PooledSequence> pooled;
  bool scale{false};

  Chosen(std::span<const AdaptationSequence> sequences, std::span<const std::size_t> rows,
         bool fit_scale)
      : scale(fit_scale) {
    for (const std::size_t row : rows) {
      const AdaptationSequence& own = sequences[row];
      auto at = std::ranges::find_if(
          pooled, [&](const PooledSequence& p) { return same_schedule(own, p.trials); });
      if (at == pooled.end()) {
        PooledSequence fresh;
        for (const AdaptationTrial& trial : own) {
          fresh.trials.push_back({trial.perturbation, trial.error_clamp, 0.0, 0.0});
        }
        at = pooled.insert(pooled.end(), std::move(fresh));
      }
      pool(own, *at);
    }
  }

  Squares squares(const Parameters& p) const {
    Squares all;
    for (const PooledSequence& sequence : pooled) {
      add_sequence(p, sequence.trials, all);
      all.sum += sequence.within;
    }
    const Curvature lower = all.curvature;
    all.curvature = lower.selfadjointView<Eigen::Lower>();
    if (!scale) {
      all.gradient[4] = 0.0;
      all.curvature.row(4).setZero();
      all.curvature.col(4).setZero();
      all.curvature(4, 4) = 1.0;
    }
    return all;
  }
};

/// Squares in coordinates of the search.
Squares on_line(const Chosen& chosen, const Parameters& line) {
  const Parameters p = from_line(line);
  Squares all = chosen.squares(p);
  Parameters chain = Parameters::Ones();
  chain.head<4>() = p.head<4>().array() * (1.0 - p.head<4>().array());
  all.gradient = chain.cwiseProduct(all.gradient).eval();
  all.curvature = (chain.asDiagonal() * all.curvature * chain.asDiagonal()).eval();
  return all;
}

struct Solution {
  Parameters at;
  double squares;
  bool converged;
};

Solution descend_from(const Chosen& chosen, const TwoRateModel& start) {
  Parameters line = to_line(parameters_of(start));
  Squares here = on_line(chosen, line);
  double damping = 1e-3;
  for (int step = 0; step < kSteps; ++step) {
    Curvature damped = here.curvature;
    damped.diagonal() += damping * here.curvature.diagonal().cwiseMax(1e-12);
    const Parameters move = solve_pivoted(damped, here.gradient).solved;
    const Parameters next = line + move;
    const Squares there = on_line(chosen, next);
    if (move.allFinite() && there.sum <= here.sum) {
      const bool done = here.sum - there.sum <= kConverged * here.sum;
      line = next;
      here = there;
      damping = std::max(1e-12, 0.2 * damping);
      if (done) {
        return {from_line(line), here.sum, true};
      }
    } else {
      damping *= 5.0;
      if (damping > 1e12) {  // no step, however small, gains anything
        return {from_line(line), here.sum, std::isfinite(here.sum)};
      }
    }
  }
  return {from_line(line), here.sum, false};
}

void order_by_retention(Parameters& p) {
  if (p[0] > p[2]) {
    std::swap(p[0], p[2]);
    std::swap(p[1], p[3]);
  }
}

Solution best_of(const Chosen& chosen, const std::vector<TwoRateModel>& starts) {
  Solution best{Parameters::Zero(), std::numeric_limits<double>::infinity(), false};
  for (const TwoRateModel& start : starts) {
    const Solution solution = descend_from(chosen, start);
    if (solution.converged && solution.squares < best.squares) {
      best = solution;
    }
  }
  order_by_retention(best.at);
  return best;
}

std::vector<TwoRateModel> starts_of(const TwoRateModel& given) {
  std::vector<TwoRateModel> starts{given};
  for (const auto& [fast, slow] :
       std::array<std::pair<TwoRateModel::Process, TwoRateModel::Process>, 4>{
           {{{0.59, 0.21}, {0.992, 0.02}},
            {{0.8, 0.1}, {0.98, 0.05}},
            {{0.3, 0.4}, {0.95, 0.1}},
            {{0.9, 0.3}, {0.999, 0.01}}}}) {
    starts.push_back({fast, slow, given.error_scale});
  }
  return starts;
}

Defined<TwoRateFit> described(const Chosen& chosen, const Solution& solution) {
  const Squares squares = chosen.squares(solution.at);
  const Parameters unit = squares.curvature.diagonal().cwiseSqrt().cwiseInverse();
  const Curvature scaled = unit.asDiagonal() * squares.curvature * unit.asDiagonal();
  const auto inverse = solve_positive(squares.curvature, Curvature::Identity());
  if (!unit.allFinite() || !(symmetric_eigen(scaled).values[0] > 1e-11) || !inverse) {
    return Undefined{"these trials cannot tell the two processes apart"};
  }
  const double df = static_cast<double>(squares.count) - (chosen.scale ? 5.0 : 4.0);
  TwoRateFit fit;
  fit.model = model_of(solution.at);
  fit.squares = squares.sum;
  fit.count = squares.count;
  fit.deviation = std::sqrt(squares.sum / df);
  fit.errors = model_of(fit.deviation * inverse->diagonal().cwiseMax(0.0).cwiseSqrt());
  fit.errors.error_scale = chosen.scale ? fit.errors.error_scale : 0.0;
  return fit;
}

bool all_perturbations_finite(std::span<const AdaptationSequence> sequences) {
  return std::ranges::all_of(sequences, [](const AdaptationSequence& trials) {
    return std::ranges::all_of(trials, [](const AdaptationTrial& t) {
      return std::isfinite(t.perturbation) && !std::isinf(t.measured);
    });
  });
}

std::vector<std::size_t> all_rows_of(std::span<const AdaptationSequence> sequences) {
  std::vector<std::size_t> rows(sequences.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

}  // namespace

Defined<TwoRateFit> fit_two_rate(std::span<const AdaptationSequence> sequences,
                                 const TwoRateOptions& options) {
  if (!all_perturbations_finite(sequences)) {
    return Undefined{"a perturbation or an error is not finite"};
  }
  const auto rows = all_rows_of(sequences);
  const Chosen chosen(sequences, rows, options.fit_error_scale);
  if (chosen.squares(parameters_of(options.start)).count < kFewestMeasured) {
    return Undefined{"there are fewer than eight measured trials"};
  }
  const Solution best = best_of(chosen, starts_of(options.start));
  if (!best.converged) {
    return Undefined{"the search for the least squares did not converge"};
  }
  return described(chosen, best);
}

Defined<TwoRateLearning> fit_two_rate_learning(std::span<const AdaptationSequence> participants,
                                               const TwoRateOptions& options,
                                               const ParticipantResampling& how) {
  const auto fit = fit_two_rate(participants, options);
  if (!fit) {
    return Undefined{fit.because()};
  }
  const auto estimate =
      [&](std::span<const std::size_t> rows) -> std::optional<std::vector<double>> {
    const Solution s = best_of(Chosen(participants, rows, options.fit_error_scale), {fit->model});
    if (!s.converged) {
      return std::nullopt;
    }
    return std::vector<double>(s.at.data(), s.at.data() + 4);
  };
  const Parameters all = parameters_of(fit->model);
  const auto intervals = participant_intervals(
      participants.size(), std::vector<double>(all.data(), all.data() + 4), estimate, how);
  return TwoRateLearning{*fit, intervals[0], intervals[1], intervals[2], intervals[3]};
}

}  // namespace haptrial::analysis
