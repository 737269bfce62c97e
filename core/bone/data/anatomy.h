#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// The labels of the volumes that the program makes. The first sixteen are those of the labelled
/// temporal bones of Johns Hopkins.
enum class Anatomy : std::uint8_t {
  kNothing = 0,
  kBone = 1,
  kMalleus = 2,
  kIncus = 3,
  kStapes = 4,
  kLabyrinth = 5,
  kInternalCanal = 6,
  kSuperiorVestibularNerve = 7,
  kInferiorVestibularNerve = 8,
  kCochlearNerve = 9,
  kFacialNerve = 10,
  kChordaTympani = 11,
  kCarotid = 12,
  kSinusAndDura = 13,
  kVestibularAqueduct = 14,
  kJaw = 15,  // temporomandibular joint
  kEarCanal = 16,
  kAlveolarNerve = 17,
  kTooth = 18,
  kDrum = 19,  // of the ear
};

/// Name, colour, hardness and whether it is vital, of a structure known by any of its usual names:
/// "Facial_Nerve", "CN VII", "sigmoid sinus". Letters' case, "_" and blanks do not matter. A name
/// that is not known keeps its own, with a colour from the label and the properties of bone.
Structure structure_named(std::string_view name, std::uint8_t label);

/// Whether a name, or one of its usual forms, is known.
bool is_known_structure(std::string_view name);
/// The known name, as it is printed, that is nearest to one that is not: the fewest letters to
/// change, also in one of the usual names, or one with a word of it.
std::string nearest_structure(std::string_view name);

/// The label of the structure with this name, or a form of it, of which the bone has voxels.
std::optional<std::uint8_t> find_label(const BoneModel& model, const std::string& name);
/// The label of a structure that a definition asks for. @param table  of the definition, for the
/// sentence @throws InputError, with the names of those that have voxels, where the bone has none
/// of it
std::uint8_t label_named(const BoneModel& model, const std::string& name, const char* table);

/// All of Anatomy, by label; the first stands for nothing.
std::vector<Structure> known_structures();

}  // namespace haptrial::bone
