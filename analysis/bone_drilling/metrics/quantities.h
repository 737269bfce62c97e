#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::analysis::drilling {

/// The names that quantity() knows of procedures on any bone; those of its structures are said by
/// their form, "bone_left_STRUCTURE_mm".
std::vector<std::string> quantity_names();

/// Those of procedures on one bone. @param osteotomy  whether one is planned
std::vector<std::string> quantity_names_on(const bone::BoneModel& bone, bool osteotomy);

/// Whether quantity() may know a name, on some bone.
bool is_quantity(std::string_view name);

/// Whether a name is that of the bone left over a structure.
bool is_bone_left(std::string_view name);

/// A quantity for people.
struct QuantityWords {
  std::string title;  // "planned cavity removed"
  std::string unit;   // "1": a pure number
};

/// The words of a name that is_quantity() knows. @throws std::invalid_argument for another one
QuantityWords words_of_quantity(std::string_view name);

}  // namespace haptrial::analysis::drilling
