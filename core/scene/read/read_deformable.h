#pragma once

#include <memory>
#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/deformable/springs/spring_body.h"
#include "core/deformable/touch/haptic_mesh.h"
#include "core/scene/field.h"

namespace haptrial::scene {

/// Reads what a table [objects.NAME] of kind "deformable" is made of and how it is felt
/// (core/scene/deformable_object.h). Problems are noted in the table.
/// @param mesh  null: it is not known yet, nothing is felt
/// @param calibrated  the constants of `calibrated`; null: they are not known yet
Field read_deformable(Table& table, std::string name, const deformable::SharedHapticMesh& mesh,
                      std::shared_ptr<const deformable::SpringConstants> calibrated = nullptr);

}  // namespace haptrial::scene
