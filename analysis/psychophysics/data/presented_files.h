#pragma once

#include <string>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"

namespace haptrial::analysis::trials {

/// A sentence for each object or sound whose file was not the same in all sessions: which checksum
/// was presented in which sessions. Sessions that kept no file of it are not told apart.
std::vector<std::string> unlike_files(const std::vector<StudySession>& sessions);

}  // namespace haptrial::analysis::trials
