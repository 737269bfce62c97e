#pragma once

#include <span>
#include <vector>

namespace haptrial::analysis {

/// How well several chains tell one number.
struct ChainDiagnostics {
  double r_hat{0.0};      // 1: chains agree; NaN: the draws do not vary or are not finite
  double effective{0.0};  // bulk effective sample size [draws]
};

/// Rank-normalised split R-hat, the larger one of the draws and of their distances from the median,
/// and the effective sample size of the rank-normalised halves by Geyer's initial monotone
/// sequence.
/// @param chains  at least one, all of one length of at least 8
/// @throws std::invalid_argument for fewer or shorter chains, or lengths that differ
/// Source: Vehtari, Gelman, Simpson, Carpenter and Bürkner 2021, Bayesian Analysis 16(2), 667.
ChainDiagnostics chain_diagnostics(const std::vector<std::span<const double>>& chains);

}  // namespace haptrial::analysis
