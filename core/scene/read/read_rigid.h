#pragma once

#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/contact/felt_body.h"
#include "core/scene/field.h"

namespace haptrial::scene {

/// Reads how one table [objects.NAME] is felt, as a field (core/scene/rigid_object.h).
/// Problems are noted in the table.
/// @param body  that its shape describes; null: it is not known yet, nothing is felt
Field read_rigid(Table& table, std::string name, const contact::SharedBody& body);

}  // namespace haptrial::scene
