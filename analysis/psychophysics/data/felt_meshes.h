#pragma once

#include <string>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"

namespace haptrial::analysis::trials {

/// A sentence for each object whose mesh file was not the same in all sessions: which checksum was
/// felt in which files. Sessions that kept no mesh of an object are not told apart.
std::vector<std::string> unlike_meshes(const std::vector<StudySession>& sessions);

}  // namespace haptrial::analysis::trials
