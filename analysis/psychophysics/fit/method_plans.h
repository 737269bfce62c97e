#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/psychometric/models/paired_comparison.h"

namespace haptrial {

class Table;
}

namespace haptrial {

class Table;
}

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

/// A target that moves, as far as a definition says how without a formula.
struct PursuedTarget {
  std::string name;
  std::vector<double> frequencies;  // [Hz]; empty: it does not swing, or by formulas
};

/// Names of a definition that the analysis of pursuits may use.
struct PursuitNames {
  std::vector<std::string> stages;
  std::vector<PursuedTarget> targets;  // in the order of names, as /targets numbers them
  std::string first;                   // of the targets as they are written; empty: there is none
};

/// Content of [analysis] of kind "pursuit".
struct PursuitPlan {
  std::string stage{"pursue"};
  std::string target;               // empty: the definition has none
  std::size_t number{0};            // of the target in /targets
  double settle{2.0};               // from the stage's beginning, left out [s]
  std::vector<double> frequencies;  // at which the hand's response is found [Hz]
  std::vector<double> swing;        // these and the target's others, which are fitted beside [Hz]
};

/// Reads the keys of [analysis] of kind "pursuit", all of which may be left out. Problems are
/// noted.
PursuitPlan read_pursuit_plan(Table& table, const PursuitNames& names);

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
