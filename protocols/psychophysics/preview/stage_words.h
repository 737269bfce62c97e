#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "protocols/psychophysics/definition/presented.h"

namespace haptrial::protocols {

/// One stage of an interval as a preview states it.
struct PreviewedStage {
  std::string name;
  bool fixed{false};        // its duration does not depend on the participant
  double shortest{0.0};     // [s]
  double longest{0.0};      // equal to shortest if fixed, else its time-out [s]
  std::string ends;         // "when the hand is inside start for 0.3 s"
  std::string late;         // "after 5 s the trial is aborted"; empty: it has no time-out
  std::string requirement;  // "depth of floor at least 0.003 m, else the interval begins again"
  std::string sound;        // that begins with it; empty: none
  int marker{0};            // code of its onset; 0: the session marks nothing
  std::vector<std::string> fields;
  std::vector<std::string> shows;
};

/// Place of a stage in a trial.
struct StagePlace {
  std::size_t interval{0}, stage{0};  // from 0
};

/// A stage with its conditions in words.
/// @param index  of the stage in its interval, from 0
PreviewedStage previewed_stage(const TrialsDefinition& definition, const Presented& presented,
                               std::size_t index);

}  // namespace haptrial::protocols
