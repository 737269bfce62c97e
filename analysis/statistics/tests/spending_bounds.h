#pragma once

#include <span>
#include <vector>

namespace haptrial::analysis {

/// How much of the error is spent by the time that a share t of the study is done (Lan and DeMets
/// 1983, Biometrika 70). O'Brien and Fleming's spends little early, Pocock's about as much at each
/// look.
enum class Spending { kOBrienFleming, kPocock };

/// The bounds of a group-sequential test at its looks: the z at which it ends for an effect. The
/// looks' z are those of sums of independent normal values, a share of all of them each.
/// @param shares  of the study that is done at each look, ascending, in (0, 1]
/// @param error   that all looks have together without an effect, in (0, 0.5)
/// @param two_sided  half of the error lies beyond the bound, half beyond its negative
/// @returns (looks) z; infinite where a look has less than 1e-15 to spend
/// @throws std::invalid_argument for shares or an error outside of these ranges
std::vector<double> spending_bounds(std::span<const double> shares, double error, bool two_sided,
                                    Spending spending);

}  // namespace haptrial::analysis
