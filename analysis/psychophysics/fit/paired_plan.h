#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/models/paired_comparison.h"

namespace haptrial {
class Table;
}

namespace haptrial::analysis::trials {

/// The name of the items as a factor, whose levels planned tests compare.
inline constexpr const char* kItem = "item";

/// Content of [analysis] of kind "paired": in each trial one of two items is chosen.
struct PairedPlan {
  std::string first, second;  // variables or factors that name the items of a trial
  PairedModel model{PairedModel::kBradleyTerry};
};

/// Reads the keys of [analysis] of kind "paired". Problems are noted.
/// @param known  factors and other variables of a trial; empty: they are not known
PairedPlan read_paired_plan(Table& table, const std::vector<std::string>& known);

}  // namespace haptrial::analysis::trials
