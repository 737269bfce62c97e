#pragma once

#include <optional>
#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::experiments {

/// Design of the t test whose power a plan states.
enum class PlannedDesign { kPaired, kTwoSample, kOneSample };

/// Content of a table [plan]: what a preregistration states beside the other keys.
struct PlanTable {
  std::vector<std::string> hypotheses;
  std::vector<std::string> exclusions;
  std::string stopping;       // empty: when the planned participants have had every session
  std::vector<double> looks;  // numbers of participants
  std::string retain_until;   // "2036-12-31"
  std::optional<double> effect;
  PlannedDesign design{PlannedDesign::kPaired};
  double alpha{0.05};
};

/// Reads the table [plan], if it is there. Problems are noted.
PlanTable read_plan_table(Table& root);

}  // namespace haptrial::experiments
