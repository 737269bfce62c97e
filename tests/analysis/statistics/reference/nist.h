#pragma once

#include <vector>

namespace haptrial::analysis::nist {

/// Correct digits of F, between and within squares that exact rational arithmetic reaches on a
/// NIST set as read into doubles: no program that takes doubles does better but by luck.
struct Cap {
  const char* file;
  double f, between, within;
};
const std::vector<Cap>& caps();

/// Correct digits that one_way_anova reaches: -log10 of the error relative to the certified value.
struct Digits {
  double f{0.0};
  double between{0.0};
  double within{0.0};
  double r_squared{0.0};
  bool same_df{false};
};
Digits digits(const char* file);

}  // namespace haptrial::analysis::nist
