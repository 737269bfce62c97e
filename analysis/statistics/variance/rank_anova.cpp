#include "analysis/statistics/variance/rank_anova.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/variance/within_effect.h"

namespace haptrial::analysis {
namespace {

using Table = std::vector<std::vector<double>>;

using Counts = std::u16string;  // small whole numbers

/// Probabilities of what the participants so far gave.
using States = std::unordered_map<Counts, double>;

constexpr std::size_t kMostSteps = 2'000'000;  // half a second
constexpr std::size_t kMostOrders = 5'040;     // of a participant's ranks: seven conditions

/// A rank in halves, so that ties are whole.
char16_t halves(double rank) { return static_cast<char16_t>(std::lround(2.0 * rank)); }

/// The probability of statistics that are as large as the one found; equal ones differ by rounding.
template <class Statistic>
double share_beyond(const States& states, double found, const Statistic& statistic) {
  double share = 0.0;
  for (const auto& [state, probability] : states) {
    share += statistic(state) >= found * (1.0 - 1e-9) ? probability : 0.0;
  }
  return std::min(1.0, share);
}

/// Sums of ranks by condition, in rising order: conditions can be exchanged. Nothing if there are
/// too many.
std::optional<States> friedman_states(const Table& table) {
  States states{{Counts(table.front().size(), u'\0'), 1.0}};
  std::size_t steps = 0;
  for (const auto& row : table) {
    const Ranks ranks = *midranks(row);
    Counts own;
    for (const double rank : ranks.ranks) {
      own.push_back(halves(rank));
    }
    std::sort(own.begin(), own.end());
    std::vector<Counts> orders;
    do {
      orders.push_back(own);
    } while (orders.size() <= kMostOrders && std::next_permutation(own.begin(), own.end()));
    steps += states.size() * orders.size();
    if (orders.size() > kMostOrders || steps > kMostSteps) {
      return std::nullopt;
    }
    States next;
    for (const auto& [state, probability] : states) {
      for (const Counts& order : orders) {
        Counts sums = state;
        for (std::size_t i = 0; i < sums.size(); ++i) {
          sums[i] = static_cast<char16_t>(sums[i] + order[i]);
        }
        std::sort(sums.begin(), sums.end());
        next[sums] += probability / static_cast<double>(orders.size());
      }
    }
    states = std::move(next);
  }
  return states;
}

/// How many values each group has and the sum of their ranks, value after value. Nothing if there
/// are too many.
std::optional<States> kruskal_states(const std::vector<double>& ranks, const Table& groups) {
  States states{{Counts(2 * groups.size(), u'\0'), 1.0}};
  std::size_t steps = 0;
  for (std::size_t value = 0; value < ranks.size(); ++value) {
    steps += states.size() * groups.size();
    if (steps > kMostSteps) {
      return std::nullopt;
    }
    States next;
    for (const auto& [state, probability] : states) {
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const std::size_t left = groups[g].size() - static_cast<std::size_t>(state[2 * g]);
        if (left > 0) {
          Counts taken = state;
          ++taken[2 * g];
          taken[2 * g + 1] = static_cast<char16_t>(taken[2 * g + 1] + halves(ranks[value]));
          next[taken] +=
              probability * static_cast<double>(left) / static_cast<double>(ranks.size() - value);
        }
      }
    }
    states = std::move(next);
  }
  return states;
}

double square(double value) { return value * value; }

double sum_at(const Counts& state, std::size_t place) { return 0.5 * state[place]; }

RankAnova approximated(double chi_squared, double df) {
  return {chi_squared, df, chi_squared_upper_tail(chi_squared, df), false};
}

}  // namespace

Defined<RankAnova> kruskal_wallis(const Table& groups) {
  if (groups.size() < 2) {
    return Undefined{"there are fewer than two groups"};
  }
  std::vector<double> all;
  for (const auto& group : groups) {
    if (group.empty()) {
      return Undefined{"a group is empty"};
    }
    all.insert(all.end(), group.begin(), group.end());
  }
  const auto ranks = midranks(all);
  if (!ranks) {
    return Undefined{ranks.because()};
  }
  if (all.size() == groups.size()) {
    return Undefined{"every group has a single value"};
  }
  if (ranks->all_tied()) {
    return Undefined{"all values are equal"};
  }
  const auto total = static_cast<double>(all.size());
  double squares = 0.0;  // of the groups' mean ranks
  auto rank = ranks->ranks.begin();
  for (const auto& group : groups) {
    const auto count = static_cast<double>(group.size());
    double excess = 0.0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      excess += *rank++ - 0.5 * (total + 1.0);
    }
    squares += excess * excess / count;
  }
  const double untied = 1.0 - ranks->ties / (total * (total * total - 1.0));
  RankAnova result = approximated(12.0 * squares / (total * (total + 1.0)) / untied,
                                  static_cast<double>(groups.size() - 1));
  const auto states =
      all.size() <= kExactRanks ? kruskal_states(ranks->ranks, groups) : std::nullopt;
  if (states) {
    result.exact = true;
    result.p = share_beyond(*states, squares, [&](const Counts& state) {
      double sum = 0.0;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto count = static_cast<double>(groups[g].size());
        sum += square(sum_at(state, 2 * g + 1) - 0.5 * count * (total + 1.0)) / count;
      }
      return sum;
    });
  }
  return result;
}

Defined<RankAnova> friedman(const Table& table) {
  if (auto problem = within::problem(table); !problem.empty()) {
    return Undefined{std::move(problem)};
  }
  const std::size_t conditions = table.front().size();
  const auto n = static_cast<double>(table.size());
  const auto k = static_cast<double>(conditions);
  std::vector<double> excess(conditions, 0.0);  // of the conditions' rank sums
  double ties = 0.0;
  for (const auto& row : table) {
    const Ranks ranks = *midranks(row);
    ties += ranks.ties;
    for (std::size_t j = 0; j < conditions; ++j) {
      excess[j] += ranks.ranks[j] - 0.5 * (k + 1.0);
    }
  }
  const double spread = n * k * (k + 1.0) - ties / (k - 1.0);
  if (spread <= 0.0) {
    return Undefined{"every participant's values are all equal"};
  }
  double squares = 0.0;
  for (const double e : excess) {
    squares += e * e;
  }
  RankAnova result = approximated(12.0 * squares / spread, k - 1.0);
  const auto states = table.size() <= kExactRanks ? friedman_states(table) : std::nullopt;
  if (states) {
    result.exact = true;
    result.p = share_beyond(*states, squares, [&](const Counts& state) {
      double sum = 0.0;
      for (std::size_t j = 0; j < conditions; ++j) {
        sum += square(sum_at(state, j) - 0.5 * n * (k + 1.0));
      }
      return sum;
    });
  }
  return result;
}

}  // namespace haptrial::analysis
