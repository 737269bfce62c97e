#pragma once

#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/scene/field.h"

namespace haptrial::scene {

/// Reads one table [fields.NAME]: `type`, the keys of its kind (field_kinds.h), and for
/// every kind limit (but for reliefs), fade_in and fade_out. Problems are noted
/// in the table; a field comes back all the same.
/// @param rate  of the servo loop [Hz]: vibrations stay below half of it
/// @param values  names of channels' values, which a field may follow
Field read_field(Table& table, std::string name, double rate,
                 const std::vector<std::string>& values = {});

/// Every table of [fields], and whether what lies `on` something lies on a wall, box, sphere or
/// cylinder of them, or on one of `objects`.
std::vector<Field> read_fields(Table& fields, double rate, const std::vector<Field>& objects = {},
                               const std::vector<std::string>& values = {});

}  // namespace haptrial::scene
