#include "analysis/psychophysics/study/paired_quantities.h"

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "analysis/psychophysics/fit/series.h"

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

std::vector<std::string> items_of(const Wins& wins) {
  std::set<std::string> items;
  for (const auto& [pair, count] : wins) {
    items.insert(pair.first);
  }
  return {items.begin(), items.end()};
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

}  // namespace

std::vector<Quantity> paired_quantities(const TrialsData& data, const TrialsPlan& plan) {
  std::vector<QuantityValue> worth_values, share_values;
  for (const auto& [condition, wins] : wins_of(data, plan)) {
    const std::vector<std::string> items = items_of(wins);
    const Eigen::MatrixXd counts = counts_of(wins, items);
    const auto worth = worths(counts, plan.paired.model, kAddedChoices);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      std::vector<std::string> levels = condition.second;
      levels.push_back(items[i]);
      const double chosen = counts.row(at).sum();
      share_values.push_back({condition.first, levels, chosen / (chosen + counts.col(at).sum())});
      if (worth) {
        worth_values.push_back({condition.first, levels, (*worth)[at]});
      }
    }
  }
  const bool odds = plan.paired.model == PairedModel::kBradleyTerry;
  return {quantity("worth", odds ? "worth in log odds" : "worth in standard deviations", "",
                   worth_values, plan),
          quantity("share_chosen", "share of trials in which it was chosen", "", share_values, plan,
                   ValueRange::kShare)};
}

}  // namespace haptrial::analysis::trials
