#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/record/burr_rows.h"
#include "core/bone/record/drilling_types.h"
#include "core/bone/record/field_row.h"
#include "protocols/bone_drilling/display/bone_stage.h"

namespace haptrial::protocols {

/// Rows of /burrs: those of a definition's tools that are burrs.
std::vector<record::BurrRow> burr_rows(std::span<const bone::ToolSpec> tools);

/// Row of a bone's procedure up to now, once its companions have settled. The dust of an earlier
/// run of the session is not in it.
/// @param pass  row of /trials
/// @param bone  row of /bones
record::ProcedureRow procedure_of(const BoneStage& stage, std::int32_t pass, std::int32_t bone);

/// Blood and heat up to now.
record::FieldRow field_of(const BoneStage& stage, std::int32_t pass);

}  // namespace haptrial::protocols
