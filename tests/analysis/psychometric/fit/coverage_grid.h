#pragma once

#include <string>
#include <vector>

namespace haptrial::test {

/// Observers who have the same trouble: cumulative Gaussians with sigma from 0.7 to 1.4, levels
/// from -2.1 to 2.1.
struct CoverageCell {
  std::string procedure;  // "listed", "staircase", "PEST", "Psi" or "QUEST+"
  int alternatives{2};    // 1: yes/no, with a quarter as many catch trials
  int place{0};           // threshold in [-1, 1]; 1: at 2.1, the last level; 2: 2 sigma beyond
  double lapse{0.02};
  double false_alarms{0.05};  // of yes/no
  double correlation{0.0};    // of answers to the same level
};
std::vector<CoverageCell> coverage_cells();

/// How often 95 % intervals hold the threshold.
struct CoverageCount {
  int observers{0};
  int stated{0}, held{0};  // intervals, with open sides
  int open{0};             // of them with an open side
  double share() const { return stated > 0 ? static_cast<double>(held) / stated : 0.0; }
};

struct CellCounts {
  CoverageCount fit;  // stated_fit(), as a report does
  CoverageCount own;  // of the procedure itself
};

/// @param observers  numbers 0 .. observers - 1, each with its own random stream
CellCounts count_coverage(const CoverageCell& cell, int observers, int threads);

}  // namespace haptrial::test
