#pragma once

#include "core/base/definition/schema_forward.h"
#include "core/subject/drilling/cavity_chart.h"

namespace haptrial::subject {
struct SurgeonParameters;
}

namespace haptrial::protocols {

struct BoneDefinition;
struct Design;
struct DrillingParameters;

/// The keys of [design].
const Schema<Design>& procedures_schema();
/// The keys of [drilling].
const Schema<DrillingParameters>& drilling_schema();
/// The keys of [bone].
const Schema<BoneDefinition>& bone_schema();
/// The keys of [second_hand] about a virtual participant.
const Schema<BoneDefinition>& beside_schema();
/// The keys of [drilling] that other protocols have, too.
const Schema<BoneDefinition>& recovery_schema();
/// The keys of [practice].
const Schema<BoneDefinition>& bone_practice_schema();
/// The keys of [display].
const Schema<BoneDefinition>& bone_display_schema();
/// The keys of [virtual_surgeons] that need no other table.
const Schema<subject::SurgeonParameters>& surgeon_schema();
/// The keys of [sound] but for files of spectra.
const Schema<BoneDefinition>& bone_sound_schema();
/// The keys of [feedback].
const Schema<BoneDefinition>& feedback_schema();

/// The keys of [cavity]; every key is optional but `structures` goes with `margins`.
const Schema<subject::CavityParameters>& cavity_schema();

}  // namespace haptrial::protocols
