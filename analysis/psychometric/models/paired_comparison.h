#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// How likely an item with the worth a is chosen over one with b: F(a - b).
enum class PairedModel : std::uint8_t {
  kBradleyTerry,  // logistic F; worths are log odds (Bradley and Terry 1952, Biometrika 39)
  kThurstone,     // normal F; worths are in standard deviations of a difference (Thurstone 1927,
                  // Psychological Review 34, case V)
};

/// Worths of items from how often each was chosen over each, by maximum likelihood; their mean is
/// 0.
/// @param wins   (items x items) how often the row's item was chosen over the column's, >= 0; 0 on
///   the diagonal
/// @param added  choices of either item that each presented pair is given besides, >= 0: with 1/2,
///   as in log odds of counts, nobody's worths are infinite, and few answers make them small
/// @returns (items); undefined for fewer than two items, if no chain of presented pairs links them,
/// and if the answers leave worths without an end: an item, or several, that were always or never
/// chosen over all others
Defined<Eigen::VectorXd> worths(const Eigen::MatrixXd& wins, PairedModel model, double added);

}  // namespace haptrial::analysis
