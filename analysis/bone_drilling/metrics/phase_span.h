#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/procedure.h"

namespace haptrial::analysis::drilling {

class StudyBones;

/// A stretch of a procedure that belongs to one phase.
struct PhaseSpan {
  std::string phase;
  double start{0.0}, end{0.0};  // of the procedure's time, without the end [s]

  bool operator==(const PhaseSpan&) const = default;
};

/// Divides a procedure into phases that follow one another without gaps. Any thread.
using FindPhases = std::function<std::vector<PhaseSpan>(const Procedure&, StudyBones&)>;

/// One phase of a procedure, all its stretches together.
struct PhaseTime {
  std::string phase;
  double time{0.0};   // [s]
  double first{0.0};  // when it began first [s]
  int stretches{0};
};

/// The phases of a procedure in the order in which they began first.
std::vector<PhaseTime> phase_times(const std::vector<PhaseSpan>& spans);

/// Time in one phase [s]; 0 if the procedure has none of it.
double time_in(const std::vector<PhaseSpan>& spans, const std::string& phase);

/// Phases of several procedures, each once, by the mean share of a procedure after which they
/// began first.
std::vector<std::string> phases_in_order(const std::vector<std::vector<PhaseSpan>>& procedures);

/// The number of times that the phase changes.
int phase_changes(const std::vector<PhaseSpan>& spans);

}  // namespace haptrial::analysis::drilling
