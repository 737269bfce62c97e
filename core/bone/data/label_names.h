#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// Structures by label as a volume's key/values name them: "label_NN:=Name", or the segments of 3D
/// Slicer ("Segment0_LabelValue", "Segment0_Name"). Names that nobody gave stay empty.
std::vector<Structure> structures_in(const std::map<std::string, std::string>& keys);

/// Names and colours that a file gives to the labels of a volume.
struct LabelTable {
  std::vector<Structure> structures;         // by label; names that nobody gave stay empty
  std::map<std::string, std::string> names;  // from those of the volume to those that are known
};

/// Structures by label, and other names for those that the volume has, from a table:
///
///     [labels.7]
///     name = "facial nerve"       # known names bring the rest
///     colour = [1.0, 0.9, 0.2]    # may be absent, as the following
///     hardness = 0.25
///     vital = true
///     [names]
///     "canalis n. facialis" = "facial nerve"
///
/// @throws InputError
LabelTable read_label_table(const std::filesystem::path& file);

/// A saved bone's keys of notes begin with it.
inline constexpr std::string_view kNoteKey = "haptrial_note_";

/// A text as it can stand in a NRRD header's line: neither line ends nor backslashes.
std::string one_line(std::string text);

/// The key/values that structures_in() reads back, and 3D Slicer as segments.
std::map<std::string, std::string> keys_of(const std::vector<Structure>& structures);

}  // namespace haptrial::bone
