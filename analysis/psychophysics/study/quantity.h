#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/psychophysics/fit/trials_plan.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/design/design_tests.h"

namespace haptrial::analysis::trials {

/// One number of a participant under a condition.
struct QuantityValue {
  std::string participant;
  std::vector<std::string> levels;  // of TrialsPlan::by
  double value{0.0};                // finite
  bool open{false};                 // the answers leave a side of its interval open
};

/// A quantity over participants: means of the conditions, and tests between them. A participant is
/// one value under a condition, however many trials it comes from.
struct Quantity {
  std::string name;     // as in results.json: "threshold"
  std::string title;    // "threshold"
  std::string unit;     // of the values; empty: a pure number
  bool on_axis{false};  // values are on the axis of levels, and their means are shown as levels
  DesignTable table;
  std::vector<Defined<MeanInterval>> means;  // (cells) over participants; none if a value is open,
                                             // or values do not vary
  std::vector<std::string> open;             // participants with open values, who are left out
  std::vector<std::string> missing;          // sentences: participants without a value, and why
  DesignTests tests;
  bool compared{false};  // there are at least two conditions
  bool headline{true};   // it stands on top of a report
};

/// The mean over participants where an interval may be missing; nothing if a value is open.
std::optional<double> mean_of(const Quantity& q, std::size_t cell);

/// The plan without the directions of its planned tests, which are of the study's first quantity:
/// for quantities of another kind, such as widths beside thresholds.
TrialsPlan without_directions(TrialsPlan plan);

/// The compared quantity of a name that a definition states; an empty name means the first, of
/// those on top of a report if there is one.
/// @param key  of the definition, for the sentence
/// @returns null if nothing is compared
/// @throws InputError if no compared quantity has the name
Quantity* compared_quantity(std::vector<Quantity>& all, const std::string& name,
                            std::string_view key);

/// Takes the plan's test of equivalence from all quantities but the one that its bound is of: a
/// bound has a unit.
/// @throws InputError as compared_quantity()
void keep_equivalence(std::vector<Quantity>& all, const TestsBeside& beside);

/// Leaves the planned tests to the quantity that they are of. Those of all others are secondary,
/// with p values that are adjusted over all of them, as one hypothesis is not planned of several
/// quantities.
/// @throws InputError as compared_quantity()
void separate_secondary(std::vector<Quantity>& all, const TrialsPlan& plan);

/// The range that holds every value of a quantity.
enum class ValueRange { kAny, kPositive, kShare };

/// A mean whose interval stays where values can lie: the delta method on logarithms of positive
/// values, on log odds of shares. A mean that is not inside its range stays as it is.
MeanInterval within_range(MeanInterval mean, ValueRange range);

/// Open values take no part, and their condition has no mean: that of the others is too near to
/// what was presented.
/// @param plan  its tests are of the conditions; those of names without values are not defined
/// @throws InputError for a planned test that compares trials with themselves, or a name that
/// stands for several conditions.
Quantity quantity(std::string name, std::string title, std::string unit,
                  const std::vector<QuantityValue>& values, const TrialsPlan& plan,
                  ValueRange range = ValueRange::kAny);

}  // namespace haptrial::analysis::trials
