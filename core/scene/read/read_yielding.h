#pragma once

#include <memory>
#include <string>

#include "core/deformable/springs/law/spring_body.h"
#include "core/deformable/touch/haptic_mesh.h"
#include "core/scene/field.h"
#include "core/scene/read/number_source.h"

namespace haptrial::scene {

/// Reads what a table [objects.NAME] of kind "deformable" is made of and how it is felt
/// (core/scene/surface/deformable_object.h). Keys in brackets are optional; all numbers may be
/// formulas. Problems are noted in the table.
///
///     [model]            "elements", at rest on every tick, if left out:
///         young [Pa], poisson
///         [inclusions.NAME]  centre, in the body's frame [m]; radius [m]; young [Pa]: balls
///                        "springs", which move:
///         constants      of every edge, face and tetrahedron, three numbers [J]; or
///         calibrated     a file of constants (protocols/trials/objects/trial_object.h)
///         density        [kg/m³]
///         [decay]        a free motion dies down with exp(-decay t), 10 if left out [1/s]
///     [centre], [turn]   of the body in W, as of other objects
///     [tool_radius]      of the ball that stands for the hand, 0.005 if left out [m]
///     [spring]           between hand and ball, 5000 if left out [N/m]
///     [friction]         { static, dynamic }
///     [limit], [fade_in], [fade_out]  as of every field
///
/// @param mesh  null: it is not known yet, nothing is felt
/// @param calibrated  the constants of `calibrated`; null: they are not known yet
Field read_yielding(Table& table, std::string name, const deformable::SharedFeltMesh& mesh,
                    const NumberSource& source = {},
                    std::shared_ptr<const deformable::SpringConstants> calibrated = nullptr);

}  // namespace haptrial::scene
