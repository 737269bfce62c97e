#pragma once

#include <filesystem>
#include <vector>

#include "analysis/document/finding.h"

namespace haptrial::analysis {

/// The certificates of the devices that sessions ran with, as their definitions state them: which
/// force reached the hand for a commanded newton, and what hid it. Each certificate has a row; no
/// table if none is stated.
/// @throws InputError for a file that is no session
FindingList certificate_findings(const std::vector<std::filesystem::path>& sessions);

}  // namespace haptrial::analysis
