#pragma once

// Keys that all kinds of objects have.

#include "core/contact/proxy.h"
#include "core/contact/renderer.h"
#include "core/scene/field.h"
#include "core/scene/read/field_kinds.h"

namespace haptrial::scene {

/// limit, fade_in and fade_out
void read_limits(Table& table, Field& field);
/// centre and turn
contact::ObjectPose read_pose(Table& table);
/// friction; a static coefficient below the dynamic one is noted
contact::Friction read_contact_friction(Table& table);

}  // namespace haptrial::scene
