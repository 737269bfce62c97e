#pragma once

#include <filesystem>
#include <string>

#include "experiments/study/roster.h"

namespace haptrial::experiments {

/// Takes a participant out of a study: moves all files of theirs that are no pilots into the folder
/// "excluded" beside the others, where no analysis reads them, and adds the reason as a row to
/// reasons.csv there.
/// @param roster  of the folder
/// @throws InputError for somebody who has no session there, whose session is being recorded, or
/// whose files are excluded under the same names; nothing is moved then
void exclude(const Roster& roster, const std::filesystem::path& folder, const std::string& subject,
             const std::string& reason);

}  // namespace haptrial::experiments
