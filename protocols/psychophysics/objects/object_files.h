#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/object_rows.h"
#include "core/scene/field.h"
#include "core/sound/cue.h"
#include "protocols/psychophysics/objects/trial_object.h"

namespace haptrial::protocols {

/// Rows that a session file keeps of the meshes and sounds that are files, once they are loaded.
/// @throws InputError if the file of a sound can't be read any more
std::vector<record::ObjectFileRow> object_files(const std::vector<TrialObject>& objects,
                                                const std::vector<sound::Cue>& sounds);

/// Nothing for a session that was recorded without such files, or before they were kept.
/// @param to  what is to be done with the recording: "resume"
/// @throws InputError naming the first file that is another one than it was recorded with
void check_object_files(const record::SessionReader& recorded,
                        const std::vector<record::ObjectFileRow>& now, std::string_view to);

/// Lines about the means that keep each rigid object among fields from shaking at the rate of the
/// loop, or that nothing is proven of it; and that a body is a room.
/// @param rate  of the servo loop [Hz]  @param damping  of the hand of the definition [N·s/m]
std::vector<std::string> words_of_rigid_objects(const std::vector<scene::Field>& fields,
                                                double rate, double damping);

}  // namespace haptrial::protocols
