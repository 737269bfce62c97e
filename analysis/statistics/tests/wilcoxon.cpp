#include "analysis/statistics/tests/wilcoxon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/ranks.h"

namespace haptrial::analysis {
namespace {

constexpr std::size_t kExactBelow = 50;

// Probabilities of V = 0, 1, ...: each rank is positive or not.
std::vector<double> signed_rank_distribution(std::size_t n) {
  std::vector<double> p(n * (n + 1) / 2 + 1, 0.0);
  p[0] = 1.0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t v = rank * (rank + 1) / 2 + 1; v-- > 0;) {
      p[v] = 0.5 * (p[v] + (v >= rank ? p[v - rank] : 0.0));
    }
  }
  return p;
}

// Probabilities of U = 0 .. m n. The largest of all values is of the first sample, and adds n to U,
// or of the second:  (m + n) P(u; m, n) = m P(u - n; m - 1, n) + n P(u; m, n - 1).
std::vector<double> mann_whitney_distribution(std::size_t m, std::size_t n) {
  std::vector<std::vector<double>> p(m + 1, std::vector<double>{1.0});  // by size of the first
  for (std::size_t second = 1; second <= n; ++second) {
    for (std::size_t first = 1; first <= m; ++first) {
      const std::vector<double> without = std::move(p[first]);
      const std::vector<double>& smaller = p[first - 1];
      const double of_first = static_cast<double>(first) / static_cast<double>(first + second);
      p[first].assign(first * second + 1, 0.0);
      for (std::size_t u = 0; u < without.size(); ++u) {
        p[first][u] += (1.0 - of_first) * without[u];
      }
      for (std::size_t u = 0; u < smaller.size(); ++u) {
        p[first][u + second] += of_first * smaller[u];
      }
    }
  }
  return p[m];
}

double exact_p(const std::vector<double>& distribution, double statistic, Tail tail) {
  const auto place = static_cast<std::ptrdiff_t>(std::llround(statistic));
  const auto at_most = std::accumulate(distribution.begin(), distribution.begin() + place + 1, 0.0);
  // Summed from its small end.
  const auto at_least = std::accumulate(distribution.rbegin(), distribution.rend() - place, 0.0);
  switch (tail) {
    case Tail::kLess:
      return std::min(1.0, at_most);  // sums may round to just above 1
    case Tail::kGreater:
      return std::min(1.0, at_least);
    case Tail::kTwoSided:
      break;
  }
  return std::min(1.0, 2.0 * std::min(at_most, at_least));
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
  result.exact = result.count < kExactBelow && ranks.ties == 0.0 && result.count == a.size();
  const auto n = static_cast<double>(result.count);
  result.p = result.exact
                 ? exact_p(signed_rank_distribution(result.count), result.statistic, tail)
                 : normal_p(result.statistic - n * (n + 1.0) / 4.0,
                            n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranks.ties / 48.0, tail);
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
  result.statistic = std::accumulate(ranks.ranks.begin(),
                                     ranks.ranks.begin() + static_cast<std::ptrdiff_t>(a.size()),
                                     -na * (na + 1.0) / 2.0);
  result.exact = a.size() < kExactBelow && b.size() < kExactBelow && ranks.ties == 0.0;
  const double n = na + nb;
  result.p = result.exact
                 ? exact_p(mann_whitney_distribution(a.size(), b.size()), result.statistic, tail)
                 : normal_p(result.statistic - na * nb / 2.0,
                            na * nb / 12.0 * (n + 1.0 - ranks.ties / (n * (n - 1.0))), tail);
  return result;
}

}  // namespace haptrial::analysis
