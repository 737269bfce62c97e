#pragma once

#include <string>

#include "analysis/bone_drilling/metrics/live_figures.h"
#include "core/record/rows/live_figures.h"

namespace haptrial::experiments {

/// A procedure of a running session, or of one that has ended.
struct DrilledProcedure {
  int trial{0};  // from 1; 0 of practice
  bool practice{false};
  analysis::drilling::LiveFigures figures;
};

/// Figures of a procedure for people: in rows, and in one line, "procedure 1: 1:05, drilling 0:40,
/// ...".
record::LiveState state_of(const DrilledProcedure& procedure);

}  // namespace haptrial::experiments
