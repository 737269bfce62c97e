#pragma once

// Keys that all kinds of objects have.

#include "core/contact/objects/moving_objects.h"
#include "core/contact/proxy/proxy.h"
#include "core/scene/field.h"
#include "core/scene/read/field_reader.h"

namespace haptrial::scene {

/// [limit], [fade_in], [fade_out]
void read_limits(const FieldReader& read, Field& field);
/// [centre], [turn]
contact::ObjectPose read_pose(const FieldReader& read);
/// [friction]; a static coefficient below the dynamic one is noted
contact::Friction read_contact_friction(const FieldReader& read);

}  // namespace haptrial::scene
