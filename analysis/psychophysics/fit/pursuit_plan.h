#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::analysis::trials {

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

}  // namespace haptrial::analysis::trials
