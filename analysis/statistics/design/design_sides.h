#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_table.h"

namespace haptrial::analysis {

/// Places in DesignTable::cells.
using Cells = std::vector<std::size_t>;

/// The cells of a level of a factor.
Cells cells_at(const DesignTable& table, std::size_t factor, std::size_t level);

/// The cells of a condition, or of a level of one factor; none of a name that has no trials.
/// @throws InputError where several factors have a level of that name.
Cells cells_of(const DesignTable& table, const std::string& side);

/// Sides that cells_of() knows: conditions, and levels if there are several factors.
std::vector<std::string> known_sides(const DesignTable& table);

/// The reason why the means of two sides cannot be compared, if there is one: a side has no trials,
/// or some combinations of levels have none, so that two levels of a factor would differ in the
/// other factors, too.
std::optional<std::string> why_not_comparable(const DesignTable& table, const PlannedTest& sides,
                                              const Cells& a, const Cells& b);

/// The values of two sides: pairs of the same participants, or different people.
struct Sides {
  std::vector<double> a, b;
  /// The same, where other factors between participants lie across both sides.
  std::map<std::vector<std::size_t>, std::pair<std::vector<double>, std::vector<double>>> strata;
  std::vector<std::size_t> subjects_a, subjects_b;  // (a), (b) in DesignTable::subjects
  bool paired{false};
};

/// The means of participants' cells of each side. A side of one cell takes everybody who has it;
/// one of several takes who has all of their own.
Sides values_of(const DesignTable& table, const Cells& a, const Cells& b);

}  // namespace haptrial::analysis
