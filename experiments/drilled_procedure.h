#pragma once

#include <string>

#include "analysis/drilling/live_figures.h"

namespace haptrial::experiments {

/// A procedure of a running session, or of one that has ended.
struct DrilledProcedure {
  int trial{0};  // from 1; 0 of practice
  bool practice{false};
  analysis::drilling::LiveFigures figures;
};

/// Its figures in one line, for a terminal: "procedure 1: 1:05, drilling 0:40, ...".
/// @param simulated  the device is; says so
std::string line_of(const DrilledProcedure& procedure, bool simulated);

}  // namespace haptrial::experiments
