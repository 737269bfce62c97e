#pragma once

#include <cstddef>
#include <span>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/base/resampling.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {

struct PermutationTest {
  double difference{0.0};  // mean(a) - mean(b)
  double p{0.0};           // for the tail asked for
  std::size_t arrangements{0};
  bool exact{false};  // every arrangement was looked at, else `arrangements` random ones
};

/// Up to so many arrangements are all looked at; of more, Resampling::count are drawn.
inline constexpr std::size_t kExactArrangements = 1'000'000;

/// Which values are whose, with no more assumed than that they could be exchanged. p is the share
/// of the arrangements whose difference is at least as far out as the one found, that one included;
/// of drawn arrangements (b + 1) / (m + 1). Differences equal but for rounding are ties.
/// Undefined with an empty sample or a value that is not finite.
/// Source: Phipson and Smyth 2010, Statistical Applications in Genetics and Molecular Biology 9.
Defined<PermutationTest> permutation_test(std::span<const double> a, std::span<const double> b,
                                          Tail tail, const Resampling& resampling);

/// The same of pairs: each difference a[i] - b[i] could have had the other sign.
/// @throws std::invalid_argument when the lengths differ.
Defined<PermutationTest> sign_flip_test(std::span<const double> a, std::span<const double> b,
                                        Tail tail, const Resampling& resampling);

}  // namespace haptrial::analysis
