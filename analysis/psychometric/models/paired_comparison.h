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

/// Worths of items from how often each was chosen over each; their mean is 0. The bias of
/// first order of a likelihood is removed. With few answers it is large: means over participants
/// would lie too far out, and worths of items that were always or never chosen would be infinite.
/// @param wins  (items x items) how often the row's item was chosen over the column's, >= 0; 0 on
///   the diagonal
/// @returns (items); undefined for fewer than two items, and if no chain of presented pairs links
/// them
/// Source: Firth 1993, Biometrika 80; Kosmidis and Firth 2009, Biometrika 96.
Defined<Eigen::VectorXd> worths(const Eigen::MatrixXd& wins, PairedModel model);

/// The items whose distance to most others has no bound by the choices alone: chains of choices in
/// either direction link them to at most half of the items, themselves among these. An item that
/// was always or never chosen is one; so are both halves of items if one was always chosen over the
/// other.
/// @param wins  as of worths()
/// @returns (items)
/// Source: Ford 1957, American Mathematical Monthly 64, on when the likelihood has a maximum.
Eigen::ArrayX<bool> open_worths(const Eigen::MatrixXd& wins);

}  // namespace haptrial::analysis
