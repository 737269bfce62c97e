#pragma once

#include <optional>
#include <string>

#include "core/record/read/session_reader.h"

namespace haptrial::record {

/// How far a session has come in its study; practice counts nowhere.
struct TrialProgress {
  std::optional<int> planned;  // nothing where the file does not say it
  int done{0};                 // the last pass of the trial was completed
  int skipped{0};              // by the experimenter
  int aborted{0};              // begun, and neither done nor skipped
  std::string ended_early;     // why the session ended with trials left; empty: it did not
};

TrialProgress trial_progress(const SessionReader& reader);

}  // namespace haptrial::record
