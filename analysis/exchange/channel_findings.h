#pragma once

#include <filesystem>
#include <vector>

#include "analysis/document/finding.h"

namespace haptrial::analysis {

/// How well the sessions recorded their channels, a row for each channel of each session; no tables
/// where no session has one. @param sessions  files @throws InputError when one is damaged
FindingList channel_findings(const std::vector<std::filesystem::path>& sessions);

}  // namespace haptrial::analysis
