#include "analysis/statistics/tests/permutation.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

using Values = std::vector<double>;

double largest(std::span<const double> values) {
  double result = 0.0;
  for (const double v : values) {
    result = std::max(result, std::abs(v));
  }
  return result;
}

/// Counts the sums that are at least as far out as the one found.
class Extremes {
 public:
  /// @param rounding  what sums that are equal by right may differ by.
  Extremes(double found, double rounding, Tail tail)
      : found_(found), rounding_(rounding), tail_(tail) {}

  bool holds(double sum) const {
    switch (tail_) {
      case Tail::kLess:
        return sum <= found_ + rounding_;
      case Tail::kGreater:
        return sum >= found_ - rounding_;
      case Tail::kTwoSided:
        break;
    }
    return std::abs(sum) >= std::abs(found_) - rounding_;
  }

 private:
  double found_;
  double rounding_;
  Tail tail_;
};

// n over k; kExactArrangements + 1 for more.
std::size_t combinations(std::size_t n, std::size_t k) {
  k = std::min(k, n - k);
  std::size_t result = 1;
  for (std::size_t i = 1; i <= k; ++i) {
    result = result * (n - k + i) / i;
    if (result > kExactArrangements) {
      return kExactArrangements + 1;
    }
  }
  return result;
}

// Steps to the next choice in lexicographic order; false after the last.
bool next_choice(std::vector<std::size_t>& chosen, std::size_t n) {
  const std::size_t k = chosen.size();
  for (std::size_t i = k; i-- > 0;) {
    if (chosen[i] < n - k + i) {
      ++chosen[i];
      std::iota(chosen.begin() + static_cast<std::ptrdiff_t>(i) + 1, chosen.end(), chosen[i] + 1);
      return true;
    }
  }
  return false;
}

std::size_t count_choices(const Values& values, std::size_t size, const Extremes& extreme) {
  std::vector<std::size_t> chosen(size);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  std::size_t count = 0;
  do {
    double sum = 0.0;
    for (const auto i : chosen) {
      sum += values[i];
    }
    count += extreme.holds(sum) ? 1 : 0;
  } while (next_choice(chosen, values.size()));
  return count;
}

// The sum of the first `size` values after a shuffle of just those.
double shuffled_sum(Values& values, std::size_t size, RandomStream& random) {
  double sum = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    std::swap(values[i], values[i + random.below(values.size() - i)]);
    sum += values[i];
  }
  return sum;
}

std::size_t count_shuffles(const Values& values, std::size_t size, const Extremes& extreme,
                           const Resampling& resampling) {
  std::atomic<std::size_t> count{0};
  for_each_part(resampling, [&](RandomStream& random, std::size_t first, std::size_t last) {
    Values own = values;
    std::size_t found = 0;
    for (std::size_t i = first; i < last; ++i) {
      found += extreme.holds(shuffled_sum(own, size, random)) ? 1 : 0;
    }
    count += found;
  });
  return count;
}

double signed_sum(const Values& values, std::uint64_t signs) {
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += (signs >> i & 1) != 0 ? -values[i] : values[i];
  }
  return sum;
}

double random_signed_sum(const Values& values, RandomStream& random) {
  double sum = 0.0;
  std::uint64_t signs = 0;
  for (std::size_t i = 0; i < values.size(); ++i, signs >>= 1) {
    signs = i % 64 == 0 ? random.bits() : signs;
    sum += (signs & 1) != 0 ? -values[i] : values[i];
  }
  return sum;
}

std::size_t count_signs(const Values& values, const Extremes& extreme) {
  std::size_t count = 0;
  for (std::uint64_t signs = 0; signs < std::uint64_t{1} << values.size(); ++signs) {
    count += extreme.holds(signed_sum(values, signs)) ? 1 : 0;
  }
  return count;
}

std::size_t count_random_signs(const Values& values, const Extremes& extreme,
                               const Resampling& resampling) {
  std::atomic<std::size_t> count{0};
  for_each_part(resampling, [&](RandomStream& random, std::size_t first, std::size_t last) {
    std::size_t found = 0;
    for (std::size_t i = first; i < last; ++i) {
      found += extreme.holds(random_signed_sum(values, random)) ? 1 : 0;
    }
    count += found;
  });
  return count;
}

PermutationTest all_looked_at(double difference, std::size_t extreme, std::size_t arrangements) {
  return {difference, static_cast<double>(extreme) / static_cast<double>(arrangements),
          arrangements, true};
}

PermutationTest drawn(double difference, std::size_t extreme, std::size_t arrangements) {
  return {difference,
          (static_cast<double>(extreme) + 1.0) / (static_cast<double>(arrangements) + 1.0),
          arrangements, false};
}

}  // namespace

Defined<PermutationTest> permutation_test(std::span<const double> a, std::span<const double> b,
                                          Tail tail, const Resampling& resampling) {
  const auto ma = moments(a);
  const auto mb = moments(b);
  if (!ma || !mb) {
    return Undefined{!ma ? ma.because() : mb.because()};
  }
  Values values(a.begin(), a.end());
  values.insert(values.end(), b.begin(), b.end());
  const auto n = static_cast<double>(values.size());
  const double rounding = n * std::numeric_limits<double>::epsilon() * largest(values);
  // Deviations from the common mean: the sum over one sample decides on the difference.
  const auto all = moments(values);
  if (!all) {
    return Undefined{all.because()};
  }
  for (auto& value : values) {
    value = (value - all->origin) - all->offset;
  }
  const double sum = std::accumulate(values.begin(), values.begin() + std::ssize(a), 0.0);
  const Extremes extreme(sum, rounding, tail);
  const double difference = mean_difference(*ma, *mb);
  const std::size_t arrangements = combinations(values.size(), a.size());
  if (arrangements <= kExactArrangements) {
    return all_looked_at(difference, count_choices(values, a.size(), extreme), arrangements);
  }
  return drawn(difference, count_shuffles(values, a.size(), extreme, resampling), resampling.count);
}

Defined<PermutationTest> sign_flip_test(std::span<const double> a, std::span<const double> b,
                                        Tail tail, const Resampling& resampling) {
  if (a.size() != b.size()) {
    throw std::invalid_argument("sign_flip_test: the samples differ in length");
  }
  Values differences(a.size());
  std::transform(a.begin(), a.end(), b.begin(), differences.begin(), std::minus<>{});
  const auto m = moments(differences);
  if (!m) {
    return Undefined{m.because()};
  }
  const auto n = static_cast<double>(a.size());
  const double rounding =
      2.0 * n * std::numeric_limits<double>::epsilon() * std::max(largest(a), largest(b));
  const Extremes extreme(std::accumulate(differences.begin(), differences.end(), 0.0), rounding,
                         tail);
  constexpr std::size_t kExactPairs = 19;  // 2^19 arrangements are below kExactArrangements
  if (a.size() <= kExactPairs) {
    return all_looked_at(m->mean(), count_signs(differences, extreme), std::size_t{1} << a.size());
  }
  return drawn(m->mean(), count_random_signs(differences, extreme, resampling), resampling.count);
}

}  // namespace haptrial::analysis
