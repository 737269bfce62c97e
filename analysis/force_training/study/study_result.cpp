#include "analysis/force_training/study/study_result.h"

#include <algorithm>

namespace haptrial::analysis {

bool StudyResult::simulated() const {
  return std::any_of(sessions.begin(), sessions.end(),
                     [](const auto& session) { return session.info.simulated; });
}

}  // namespace haptrial::analysis
