#include "analysis/statistics/tests/wilcoxon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

constexpr std::size_t kExactBelow = 50;

using RankSumCounts = std::vector<double>;  // in which a sum of ranks of 0, 1, ... units can arise

/// Ranks as whole numbers of units: of halves where values tie.
struct WholeRanks {
  std::vector<long> ranks;
  long unit{1};  // of a rank
};

WholeRanks whole(const Ranks& ranks) {
  WholeRanks result{{}, ranks.ties > 0.0 ? 2 : 1};
  for (const double rank : ranks.ranks) {
    result.ranks.push_back(std::lround(static_cast<double>(result.unit) * rank));
  }
  return result;
}

/// Sums of the positive ranks: each rank is positive or not.
RankSumCounts signed_rank_counts(const WholeRanks& ranks) {
  const auto total = std::accumulate(ranks.ranks.begin(), ranks.ranks.end(), 0L);
  RankSumCounts counts(static_cast<std::size_t>(total) + 1, 0.0);
  counts[0] = 1.0;
  for (const long rank : ranks.ranks) {
    for (long sum = total; sum >= rank; --sum) {
      counts[static_cast<std::size_t>(sum)] += counts[static_cast<std::size_t>(sum - rank)];
    }
  }
  return counts;
}

/// Sums of the ranks of a sample: every choice of `count` ranks.
RankSumCounts chosen_rank_counts(const WholeRanks& ranks, std::size_t count) {
  const auto total = std::accumulate(ranks.ranks.begin(), ranks.ranks.end(), 0L);
  std::vector<RankSumCounts> counts(count + 1,
                                    RankSumCounts(static_cast<std::size_t>(total) + 1, 0.0));
  counts[0][0] = 1.0;
  long most = 0;  // sum of the ranks so far
  for (const long rank : ranks.ranks) {
    most += rank;
    for (std::size_t chosen = count; chosen > 0; --chosen) {
      for (long sum = most; sum >= rank; --sum) {
        counts[chosen][static_cast<std::size_t>(sum)] +=
            counts[chosen - 1][static_cast<std::size_t>(sum - rank)];
      }
    }
  }
  return counts[count];
}

/// The share of the choices whose sum is as far out as the one found.
/// @param twice_middle  twice the expected sum
double exact_p(const RankSumCounts& counts, long found, long twice_middle, Tail tail) {
  double beyond = 0.0, all = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto sum = static_cast<long>(i);
    const bool far = tail == Tail::kLess ? sum <= found
                     : tail == Tail::kGreater
                         ? sum >= found
                         : std::abs(2 * sum - twice_middle) >= std::abs(2 * found - twice_middle);
    beyond += far ? counts[i] : 0.0;
    all += counts[i];
  }
  return beyond / all;
}

// @param excess  statistic less its expectation.
double normal_p(double excess, double variance, Tail tail) {
  const double deviation = std::sqrt(variance);
  switch (tail) {
    case Tail::kLess:
      return normal_upper_tail(-(excess + 0.5) / deviation);
    case Tail::kGreater:
      return normal_upper_tail((excess - 0.5) / deviation);
    case Tail::kTwoSided:
      break;
  }
  const double beyond = std::max(0.0, std::abs(excess) - 0.5);
  return std::min(1.0, 2.0 * normal_upper_tail(beyond / deviation));
}

}  // namespace

Defined<RankTest> wilcoxon_signed_rank(std::span<const double> a, std::span<const double> b,
                                       Tail tail) {
  if (a.size() != b.size()) {
    throw std::invalid_argument("wilcoxon_signed_rank: the samples differ in length");
  }
  std::vector<double> differences(a.size());
  std::transform(a.begin(), a.end(), b.begin(), differences.begin(), std::minus<>{});
  if (const auto m = moments(differences); !m) {
    return Undefined{m.because()};
  }
  std::erase(differences, 0.0);
  if (differences.empty()) {
    return Undefined{"the values of every pair are equal"};
  }
  std::vector<double> sizes(differences.size());
  std::transform(differences.begin(), differences.end(), sizes.begin(),
                 [](double d) { return std::abs(d); });
  const Ranks ranks = *midranks(sizes);

  RankTest result;
  result.count = differences.size();
  for (std::size_t i = 0; i < differences.size(); ++i) {
    result.statistic += differences[i] > 0.0 ? ranks.ranks[i] : 0.0;
  }
  result.exact = result.count < kExactBelow;
  const auto n = static_cast<double>(result.count);
  if (result.exact) {
    const WholeRanks units = whole(ranks);
    const RankSumCounts counts = signed_rank_counts(units);
    result.p = exact_p(counts, std::lround(static_cast<double>(units.unit) * result.statistic),
                       static_cast<long>(counts.size()) - 1, tail);
  } else {
    result.p = normal_p(result.statistic - n * (n + 1.0) / 4.0,
                        n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranks.ties / 48.0, tail);
  }
  return result;
}

Defined<RankTest> mann_whitney(std::span<const double> a, std::span<const double> b, Tail tail) {
  std::vector<double> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  if (a.empty() || b.empty()) {
    return Undefined{"there are no values"};
  }
  const auto found = midranks(all);
  if (!found) {
    return Undefined{found.because()};
  }
  const Ranks& ranks = *found;
  if (ranks.all_tied()) {
    return Undefined{"all values are equal"};
  }
  const auto na = static_cast<double>(a.size());
  const auto nb = static_cast<double>(b.size());
  RankTest result;
  result.count = all.size();
  const double sum = std::accumulate(
      ranks.ranks.begin(), ranks.ranks.begin() + static_cast<std::ptrdiff_t>(a.size()), 0.0);
  result.statistic = sum - na * (na + 1.0) / 2.0;
  result.exact = a.size() < kExactBelow && b.size() < kExactBelow;
  const double n = na + nb;
  if (result.exact) {
    const WholeRanks units = whole(ranks);
    result.p = exact_p(chosen_rank_counts(units, a.size()),
                       std::lround(static_cast<double>(units.unit) * sum),
                       units.unit * static_cast<long>(a.size() * (all.size() + 1)), tail);
  } else {
    result.p = normal_p(result.statistic - na * nb / 2.0,
                        na * nb / 12.0 * (n + 1.0 - ranks.ties / (n * (n - 1.0))), tail);
  }
  return result;
}

}  // namespace haptrial::analysis
