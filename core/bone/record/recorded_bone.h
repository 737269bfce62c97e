#pragma once

#include <cstdint>

#include "core/bone/model/bone_model.h"
#include "core/bone/record/drilling_tables.h"

namespace haptrial::bone {

/// A bone as a session file keeps it. @param number  of the bone, from 0
record::BoneRecord record_of(const BoneModel& model, std::int32_t number);

/// Whether two records are of one bone, whatever it is called and wherever it came from.
bool same_bone(const record::BoneRecord& a, const record::BoneRecord& b);

/// The bone of a record. @throws std::invalid_argument where its rows do not fit together.
BoneModel bone_of(const record::BoneRecord& record);

/// The bone of a session file. @throws InputError where its rows do not fit together.
BoneModel model_of(const record::BoneRecord& record);

}  // namespace haptrial::bone
