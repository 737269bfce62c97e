#pragma once

#include <string>

#include "core/psychometric/procedure/procedure.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {

/// A trial whose level is to be chosen.
struct LevelQuestion {
  int trial{1};  // of the study, or of practice
  bool practice{false};
  const std::string& name;  // of the track with its combination
  const Track& track;
  const psychometric::Level& proposed;  // by the track's own procedure
};

/// A chooser of other levels than the procedures ask for. Session's thread.
class LevelChooser {
 public:
  virtual ~LevelChooser() = default;
  /// @returns the level to ask for, with the dimensions of the proposed one
  virtual psychometric::Level choose(const LevelQuestion& question) = 0;
  /// Tells the chooser an outcome that the track's own procedure learns from, too.
  virtual void told(const std::string& name, const psychometric::Outcome& outcome) = 0;
};

}  // namespace haptrial::protocols
