#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::experiments {

/// A key of the definition that is varied.
struct VariedKey {
  std::string key;             // "observer.drift", "blocks.hard.shift"
  std::vector<double> values;  // at least one
  std::optional<double> none;  // the value without an effect; nothing: it makes no effect
};

/// How virtual participants take part.
enum class PowerDepth : std::uint8_t { kResponses, kSessions };

/// Content of a table [power].
struct PowerPlan {
  std::string definition;  // file, from the folder of this one; empty: it is this one
  std::string watch;       // a test of the report by its name
  double alpha{0.05};
  double target{0.8};           // power
  int replications{1000};       // of each cell
  int null_replications{2000};  // of each cell without an effect
  int block{100};               // replications of a part; of full sessions 1 unless stated
  std::uint64_t seed{1};
  PowerDepth depth{PowerDepth::kResponses};
  int checked_cells{0};  // cells that are also simulated in full
  int checked_replications{4};
  std::vector<VariedKey> vary;
};

/// Reads the table [power]. Problems are noted.
PowerPlan read_power_plan(Table& root);

/// Notes keys of [power] that recordings of version 0.2 may have, and no new question.
void check_new_power(Table& root);

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
