#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"

namespace haptrial::analysis::trials {

/// The group of a participant; empty: the study has none.
using GroupOf = std::function<std::string(const std::string& participant)>;

/// Reads what sessions of protocol "trials" hold, practice and aborted passes too.
/// @param files    sessions, in the order of reports
/// @param threads  files are read by so many at once
/// @throws InputError naming a file that is damaged.
TrialsData read_trials(const std::vector<std::filesystem::path>& files, const GroupOf& group_of,
                       int threads);

}  // namespace haptrial::analysis::trials
