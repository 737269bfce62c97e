#include "analysis/psychophysics/study/paired_quantities.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

using Condition = std::pair<std::string, std::vector<std::string>>;  // a participant's
using Wins = std::map<std::pair<std::string, std::string>, double>;  // of an item over another

/// The plan whose factors every trial has.
TrialsPlan without_items(TrialsPlan plan) {
  std::erase(plan.by, kItem);
  return plan;
}

std::map<Condition, Wins> wins_of(const TrialsData& data, const TrialsPlan& plan) {
  const TrialsPlan of_trials = without_items(plan);
  std::map<Condition, Wins> all;
  for (const StudyTrial& trial : data.trials) {
    const std::string first = factor_level(data, trial, plan.paired.first);
    const std::string second = factor_level(data, trial, plan.paired.second);
    const int outcome = outcome_of(trial, plan);
    if (!trial.counts() || outcome < 0 || first.empty() || second.empty() || first == second) {
      continue;
    }
    Wins& wins = all[{data.session_of(trial).participant, factors_of(data, trial, of_trials)}];
    wins[{first, second}] += outcome;
    wins[{second, first}] += 1 - outcome;
  }
  return all;
}

/// The items that anybody met under a condition.
std::map<std::vector<std::string>, std::set<std::string>> items_of(
    const std::map<Condition, Wins>& all) {
  std::map<std::vector<std::string>, std::set<std::string>> items;
  for (const auto& [condition, wins] : all) {
    for (const auto& [pair, count] : wins) {
      items[condition.second].insert(pair.first);
    }
  }
  return items;
}

Eigen::MatrixXd counts_of(const Wins& wins, const std::vector<std::string>& items) {
  const auto n = static_cast<Eigen::Index>(items.size());
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto found =
          wins.find({items[static_cast<std::size_t>(i)], items[static_cast<std::size_t>(k)]});
      counts(i, k) = found == wins.end() ? 0.0 : found->second;
    }
  }
  return counts;
}

bool has_every_pair(const Eigen::MatrixXd& counts) {
  Eigen::MatrixXd presented = counts + counts.transpose();
  presented.diagonal().setOnes();
  return presented.minCoeff() > 0.0;
}

/// Values of a quantity, and the participants under a condition who have none.
struct CollectedPairs {
  std::vector<QuantityValue> values;
  std::map<std::string, std::vector<std::string>> missing;  // names by reason
};

void add_values(const Condition& condition, const std::vector<std::string>& items,
                const Defined<Eigen::VectorXd>& values, CollectedPairs& to) {
  if (!values) {
    const std::string levels = fmt::format("{}", fmt::join(condition.second, ", "));
    to.missing[values.because()].push_back(condition.first +
                                           (levels.empty() ? std::string() : ", " + levels));
    return;
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::vector<std::string> levels = condition.second;
    levels.push_back(items[i]);
    to.values.push_back({condition.first, levels, (*values)[static_cast<Eigen::Index>(i)]});
  }
}

Defined<Eigen::VectorXd> shares_chosen(const Eigen::MatrixXd& counts) {
  if (!has_every_pair(counts)) {
    return Undefined{"not every pair of items was presented, so that shares have other opponents"};
  }
  const Eigen::VectorXd chosen = counts.rowwise().sum();
  const Eigen::VectorXd other = counts.colwise().sum().transpose();
  return Eigen::VectorXd(chosen.array() / (chosen + other).array());
}

/// Participants with an open worth less those without one, by condition and item.
using OpenWorths = std::map<std::string, int>;

void count_open(const Condition& condition, const std::vector<std::string>& items,
                const Eigen::MatrixXd& counts, OpenWorths& to) {
  const Eigen::ArrayX<bool> open = open_worths(counts);
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::vector<std::string> levels = condition.second;
    levels.push_back(items[i]);
    to[fmt::format("{}", fmt::join(levels, ", "))] += open[static_cast<Eigen::Index>(i)] ? 1 : -1;
  }
}

/// Takes the intervals of worths that the choices of most participants leave open.
void remove_open_intervals(const OpenWorths& open, Quantity& worth) {
  for (std::size_t cell = 0; cell < worth.means.size(); ++cell) {
    const auto found = open.find(worth.table.names[cell]);
    if (found != open.end() && found->second > 0) {
      worth.means[cell] =
          Undefined{"for most participants it was always or never chosen, alone or with others"};
    }
  }
}

Quantity with_reasons(Quantity result, const CollectedPairs& from) {
  for (const auto& [because, names] : from.missing) {
    result.missing.push_back(fmt::format("{}: no values of {}, because {}",
                                         capitalized(result.title), fmt::join(names, "; "),
                                         because));
  }
  return result;
}

}  // namespace

std::vector<Quantity> paired_quantities(const TrialsData& data, const TrialsPlan& plan) {
  CollectedPairs worth, share;
  OpenWorths open;
  const auto all = wins_of(data, plan);
  const auto items_under = items_of(all);
  for (const auto& [condition, wins] : all) {
    const std::set<std::string>& met = items_under.at(condition.second);
    const std::vector<std::string> items(met.begin(), met.end());
    const Eigen::MatrixXd counts = counts_of(wins, items);
    const Defined<Eigen::VectorXd> fitted = worths(counts, plan.paired.model);
    add_values(condition, items, fitted, worth);
    if (fitted) {
      count_open(condition, items, counts, open);
    }
    add_values(condition, items, shares_chosen(counts), share);
  }
  const bool odds = plan.paired.model == PairedModel::kBradleyTerry;
  Quantity of_items = quantity("worth", odds ? "worth in log odds" : "worth in standard deviations",
                               "", worth.values, plan);
  remove_open_intervals(open, of_items);
  Quantity shares = quantity("share_chosen", "share of trials in which it was chosen", "",
                             share.values, plan, ValueRange::kShare);
  return {with_reasons(std::move(of_items), worth), with_reasons(std::move(shares), share)};
}

}  // namespace haptrial::analysis::trials
