#pragma once

#include <vector>

#include "experiments/command/deform/deform_body.h"

namespace haptrial::experiments {

/// The touches of a recorded session as loads: at moments evenly spread over the contact, the
/// force of the tool acts on the vertex of the body's surface that is nearest to the tool's place.
/// The session must have recorded the contact (record = true of the object), and the body must
/// stand in the file where it stood in the world.
/// @param fixed  what holds the body beside the touch
/// @throws InputError as read_session_contact(), for contacts without a force and for a touch of a
/// vertex that is held.
/// Source: Morris 2006, §5.3.2 ("acquired using a haptic simulation environment").
std::vector<NamedLoad> touches_of(const DeformBody& body, const deformable::SetupLoad& load,
                                  const deformable::LoadCase& fixed);

}  // namespace haptrial::experiments
