#pragma once

#include <memory>

#include "core/deformable/touch/compliance.h"

namespace haptrial::deformable {

/// The compliance of a body of a tissue, made when it is first asked for and shared by all who ask
/// for the same (prepared_bodies.h): trials, participants, threads. Tissues of meshes that are
/// alike have one mesh. Any thread but the servo thread.
/// @throws InputError as check_tissue(), and before anything is made if the machine has not the
/// memory that it takes.
std::shared_ptr<const Compliance> prepared(const SharedHapticMesh& mesh, const Tissue& tissue);

/// @throws InputError naming the body if the machine has not the memory that it takes.
void check_memory(const HapticMesh& mesh);

/// A bound on how stiff a ball of this radius can be on the body, wherever it is: as
/// Compliance::stiffest(), with the corners of all faces that it could press [N/m].
double stiffest_touch(const Compliance& body, double radius);

}  // namespace haptrial::deformable
