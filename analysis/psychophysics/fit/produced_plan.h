#pragma once

#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::analysis::trials {

/// A measure of a definition: a number that a stage of each trial produces, an answer by its name.
struct MeasureName {
  std::string name;
  std::string words;  // "peak force"
  std::string unit;
};

/// Names of a definition that the analysis of what is produced may use.
struct ProducedNames {
  std::vector<MeasureName> measures;
  std::vector<std::string> variables;  // that a trial has as numbers
};

/// Content of [analysis] of kind "produced".
struct ProducedPlan {
  std::string measure;  // whose values are compared
  std::string words;    // of it
  std::string unit;     // likewise
  std::string target;   // variable that it was to equal, in its unit; empty: none
};

/// Reads the keys of [analysis] of kind "produced". Problems are noted.
ProducedPlan read_produced_plan(Table& table, const ProducedNames& names);

}  // namespace haptrial::analysis::trials
