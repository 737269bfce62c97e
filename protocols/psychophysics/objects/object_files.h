#pragma once

#include <string_view>
#include <vector>

#include "core/record/rows/object_file_row.h"
#include "protocols/psychophysics/objects/trial_object.h"

namespace haptrial::record {
class SessionReader;
}

namespace haptrial::protocols {

/// Rows that a session file keeps of the meshes that are files, once they are loaded.
std::vector<record::ObjectFileRow> object_files(const std::vector<TrialObject>& objects);

/// Nothing for a session that was recorded without such files, or before they were kept.
/// @param to  what is to be done with the recording: "resume"
/// @throws InputError naming the first file that is another one than it was recorded with
void check_object_files(const record::SessionReader& recorded,
                        const std::vector<TrialObject>& objects, std::string_view to);

}  // namespace haptrial::protocols
