#include "analysis/psychophysics/study/pursuit_quantities.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/design/wording.h"
#include "core/base/parallel.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/rows/device_rows.h"

namespace haptrial::analysis::trials {
namespace {

using Places = std::vector<Eigen::Vector3d>;

Eigen::MatrixXd matrix_of(const Places& places) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(places.size()), 3);
  for (std::size_t i = 0; i < places.size(); ++i) {
    matrix.row(static_cast<Eigen::Index>(i)) = places[i];
  }
  return matrix;
}

constexpr Eigen::Index kLine = 2;  // columns of the basis that are no sines

/// A constant, a line, and cosine and sine of each frequency.
Eigen::MatrixXd basis_of(Eigen::Index ticks, double rate, const std::vector<double>& frequencies) {
  Eigen::MatrixXd basis(ticks, kLine + static_cast<Eigen::Index>(2 * frequencies.size()));
  for (Eigen::Index i = 0; i < ticks; ++i) {
    basis(i, 0) = 1.0;
    basis(i, 1) = static_cast<double>(i) / static_cast<double>(ticks) - 0.5;
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      const double angle = 2.0 * M_PI * frequencies[k] * static_cast<double>(i) / rate;
      basis(i, kLine + static_cast<Eigen::Index>(2 * k)) = std::cos(angle);
      basis(i, kLine + static_cast<Eigen::Index>(2 * k) + 1) = std::sin(angle);
    }
  }
  return basis;
}

std::complex<double> amplitude(const Eigen::VectorXd& fitted, std::size_t k) {
  return {fitted[kLine + static_cast<Eigen::Index>(2 * k)],
          -fitted[kLine + static_cast<Eigen::Index>(2 * k) + 1]};
}

double variance(const Eigen::VectorXd& values) {
  return (values.array() - values.mean()).square().mean();
}

/// Root mean square distance in the directions in which the target moves.
double tracking_error(const Eigen::MatrixXd& seen, const Eigen::MatrixXd& moved) {
  const Eigen::MatrixXd centred = seen.rowwise() - seen.colwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(centred.transpose() * centred);
  constexpr double kMoves = 1e-6;  // share of the greatest variance with which a direction counts
  const Eigen::MatrixXd error = moved - seen;
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (spread.eigenvalues()[axis] > kMoves * spread.eigenvalues()[2]) {
      square += (error * spread.eigenvectors().col(axis)).squaredNorm();
    }
  }
  return std::sqrt(square / static_cast<double>(seen.rows()));
}

/// The hand's sines over the target's, where the target has any: its amplitude is more than a
/// micrometre and far above what the sines leave of the target, which leaks into every frequency.
std::complex<double> response_at(std::size_t k, const Eigen::VectorXd& of_target,
                                 const Eigen::VectorXd& of_hand, double rest) {
  const bool swings = std::abs(amplitude(of_target, k)) > std::max(1e-6, 100.0 * rest);
  return swings ? amplitude(of_hand, k) / amplitude(of_target, k)
                : std::complex<double>(kNotKnown, kNotKnown);
}

/// The pursuits of one session.
class SessionPursuits {
 public:
  SessionPursuits(const std::filesystem::path& file, const PursuitPlan& plan)
      : reader_(file), plan_(plan), targets_(reader_.rows<record::TargetRow>()) {}

  std::optional<PursuitResponse> of(const StudyTrial& trial) const {
    const StageTime* stage = last_stage(trial, plan_.stage);
    if (stage == nullptr) {
      return std::nullopt;
    }
    const double rate = reader_.info().rate;
    const auto settle = static_cast<std::uint64_t>(std::lround(plan_.settle * rate));
    const std::uint64_t first = trial.first_sample + stage->first + settle;
    const std::uint64_t end = trial.first_sample + stage->first + stage->ticks;
    const auto begin = std::ranges::lower_bound(targets_, first, {}, &record::TargetRow::sequence);
    const std::uint64_t ticks = end > first ? end - first : 0;
    const std::vector<record::Sample> samples =
        record::rows_of_ticks(reader_, record::samples_table(), first, ticks);
    if (samples.size() != ticks) {
      return std::nullopt;  // some are missing, so that no frequency is known
    }
    Places target, hand;
    for (auto row = begin; row != targets_.end() && row->sequence < end; ++row) {
      if (std::cmp_equal(row->target, plan_.number)) {
        target.push_back(row->place);
        hand.push_back(samples.at(static_cast<std::size_t>(row->sequence - first)).position);
      }
    }
    return target.size() < 2 ? std::nullopt
                             : std::optional(pursuit_response(target, hand, rate, plan_.swing));
  }

 private:
  record::SessionReader reader_;
  const PursuitPlan& plan_;
  std::vector<record::TargetRow> targets_;
};

/// The trials of a participant under a condition.
struct Cell {
  double error{0.0}, followed{0.0}, trials{0.0};
  std::vector<std::complex<double>> response;  // summed
};

/// A quantity, with the participants whose target did not swing as the analysis takes it to.
Quantity pursuit_quantity(const std::string& name, const std::string& title,
                          const std::string& unit, const std::vector<QuantityValue>& values,
                          const TrialsPlan& plan, ValueRange range) {
  Quantity made = quantity(name, title, unit, values, plan, range);
  std::set<std::string> without;
  for (const QuantityValue& each : values) {
    if (!std::isfinite(each.value)) {
      without.insert(each.participant);
    }
  }
  if (!without.empty()) {
    made.missing.push_back(fmt::format(
        "{}: values of {} are missing, because the target's swing is no sum of sines of the "
        "frequencies",
        capitalized(made.title), fmt::join(without, ", ")));
  }
  return made;
}

std::vector<Quantity> quantities_of(
    const std::map<std::pair<std::string, std::vector<std::string>>, Cell>& cells,
    const TrialsPlan& plan) {
  std::vector<Quantity> all;
  const auto add = [&](const std::string& name, const std::string& title, const std::string& unit,
                       ValueRange range, auto&& value) {
    std::vector<QuantityValue> values;
    for (const auto& [of, cell] : cells) {
      values.push_back({of.first, of.second, value(cell)});
    }
    all.push_back(pursuit_quantity(name, title, unit, values, plan, range));
  };
  const std::vector<double>& frequencies = plan.pursuit.frequencies;
  add("tracking_error", "tracking error", "m", ValueRange::kPositive,
      [](const Cell& c) { return c.error / c.trials; });
  if (!frequencies.empty()) {
    add("followed", "share of the movement that follows the target", "", ValueRange::kShare,
        [](const Cell& c) { return c.followed / c.trials; });
  }
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    const std::string at = fmt::format("at {:g} Hz", frequencies[k]);
    add(fmt::format("gain_{:g}_hz", frequencies[k]), "gain " + at, "", ValueRange::kPositive,
        [&](const Cell& c) { return std::abs(c.response[k]) / c.trials; });
    add(fmt::format("lag_{:g}_hz", frequencies[k]), "lag " + at, "s", ValueRange::kAny,
        [&](const Cell& c) { return -std::arg(c.response[k]) / (2.0 * M_PI * frequencies[k]); });
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    all[i].headline = false;
  }
  return all;
}

}  // namespace

PursuitResponse pursuit_response(const Places& target, const Places& hand, double rate,
                                 const std::vector<double>& frequencies) {
  const Eigen::MatrixXd seen = matrix_of(target), moved = matrix_of(hand);
  PursuitResponse found;
  found.error = tracking_error(seen, moved);
  if (frequencies.empty()) {
    return found;
  }
  const Eigen::MatrixXd basis = basis_of(seen.rows(), rate, frequencies);
  const auto line = basis.leftCols(kLine);
  const auto sines = basis.rightCols(basis.cols() - kLine);
  const Eigen::HouseholderQR<Eigen::MatrixXd> solver(basis);
  const Eigen::MatrixXd places = solver.solve(seen);  // (basis x 3)
  const Eigen::MatrixXd swing = sines * places.bottomRows(sines.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(swing.transpose() * swing);
  const Eigen::Vector3d along = spread.eigenvectors().col(2);
  const Eigen::VectorXd shown = seen * along, followed = moved * along;
  const Eigen::VectorXd of_target = places * along, of_hand = solver.solve(followed);
  const double rest =
      std::sqrt((shown - basis * of_target).squaredNorm() / static_cast<double>(target.size()));
  found.followed = variance(sines * of_hand.tail(sines.cols())) /
                   variance(followed - line * of_hand.head(kLine));
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    found.response.push_back(response_at(k, of_target, of_hand, rest));
    if (std::isnan(found.response.back().real())) {
      found.followed = kNotKnown;
    }
  }
  return found;
}

std::vector<Quantity> pursuit_quantities(const TrialsData& data,
                                         const std::vector<std::filesystem::path>& files,
                                         const TrialsPlan& plan, int threads) {
  std::vector<std::optional<PursuitResponse>> responses(data.trials.size());
  parallel_for(files.size(), threads_or_all(threads), [&](std::size_t session) {
    const SessionPursuits pursuits(files[session], plan.pursuit);
    for (std::size_t i = 0; i < data.trials.size(); ++i) {
      if (data.trials[i].session == session && data.trials[i].counts()) {
        responses[i] = pursuits.of(data.trials[i]);
      }
    }
  });
  std::map<std::pair<std::string, std::vector<std::string>>, Cell> cells;
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    if (!responses[i]) {
      continue;
    }
    const StudyTrial& trial = data.trials[i];
    Cell& cell = cells[{data.session_of(trial).participant, factors_of(data, trial, plan)}];
    cell.response.resize(responses[i]->response.size());
    cell.error += responses[i]->error;
    cell.followed += responses[i]->followed;
    cell.trials += 1.0;
    for (std::size_t k = 0; k < cell.response.size(); ++k) {
      cell.response[k] += responses[i]->response[k];
    }
  }
  return quantities_of(cells, plan);
}

}  // namespace haptrial::analysis::trials
