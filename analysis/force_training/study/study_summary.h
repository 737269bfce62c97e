#pragma once

#include <string>
#include <vector>

namespace haptrial::analysis {

struct StudyResult;

/// The lines that matter, with participants as the unit: the mean recall error of each condition,
/// whether conditions differ, and the planned tests.
std::vector<std::string> summary_lines(const StudyResult& study);

}  // namespace haptrial::analysis
