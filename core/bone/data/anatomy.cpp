#include "core/bone/data/anatomy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <tuple>

#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::bone {
namespace {

struct Known {
  Anatomy label;
  const char* name;
  std::array<double, 3> colour;
  double hardness;
  bool vital;
  const char* others;  // other names, in plain form, between bars
};

/// Hardness beside bone: ossicles and the otic capsule are its hardest parts, soft tissue gives way
/// at once. The numbers are for the hand, not from measurements.
const std::array<Known, 19> kKnown{{
    {Anatomy::kBone, "bone", {0.90, 0.87, 0.78}, 1.0, false, "|temporal bone|cortical bone|skull|"},
    {Anatomy::kMalleus, "malleus", {0.93, 0.62, 0.44}, 1.2, true, "|"},
    {Anatomy::kIncus, "incus", {0.88, 0.50, 0.32}, 1.2, true, "|"},
    {Anatomy::kStapes, "stapes", {0.80, 0.38, 0.24}, 1.2, true, "|"},
    {Anatomy::kLabyrinth,
     "bony labyrinth",
     {0.35, 0.70, 0.86},
     1.5,
     true,
     "|labyrinth|inner ear|otic capsule|semicircular canals|cochlea|"},
    {Anatomy::kInternalCanal,
     "internal auditory canal",
     {0.45, 0.80, 0.62},
     0.3,
     true,
     "|iac|internal acoustic meatus|internal acoustic canal|"},
    {Anatomy::kSuperiorVestibularNerve,
     "superior vestibular nerve",
     {0.98, 0.86, 0.35},
     0.25,
     true,
     "|"},
    {Anatomy::kInferiorVestibularNerve,
     "inferior vestibular nerve",
     {0.96, 0.78, 0.30},
     0.25,
     true,
     "|"},
    {Anatomy::kCochlearNerve, "cochlear nerve", {0.94, 0.70, 0.26}, 0.25, true, "|"},
    {Anatomy::kFacialNerve,
     "facial nerve",
     {1.00, 0.90, 0.20},
     0.25,
     true,
     "|cn vii|cn7|nervus facialis|"},
    {Anatomy::kChordaTympani, "chorda tympani", {1.00, 0.95, 0.50}, 0.25, true, "|chorda|"},
    {Anatomy::kCarotid,
     "internal carotid artery",
     {0.85, 0.12, 0.12},
     0.25,
     true,
     "|ica|carotid|carotid artery|"},
    {Anatomy::kSinusAndDura,
     "sigmoid sinus and dura",
     {0.32, 0.38, 0.75},
     0.25,
     true,
     "|sinus dura|sinus and dura|sinus + dura|sigmoid sinus|dura|dura mater|"},
    {Anatomy::kVestibularAqueduct,
     "vestibular aqueduct",
     {0.25, 0.60, 0.75},
     0.3,
     true,
     "|vestibular aqueduct and endolymphatic sac|endolymphatic sac|"},
    {Anatomy::kJaw,
     "temporomandibular joint",
     {0.78, 0.70, 0.74},
     1.0,
     false,
     "|tmj|mandibular condyle|"},
    {Anatomy::kEarCanal,
     "external auditory canal",
     {0.80, 0.58, 0.52},
     0.25,
     false,
     "|eac|ear canal|external acoustic meatus|"},
    {Anatomy::kAlveolarNerve,
     "inferior alveolar nerve",
     {1.00, 0.85, 0.25},
     0.25,
     true,
     "|ian|mandibular nerve|mandibular canal|"},
    {Anatomy::kDrum,
     "tympanic membrane",
     {0.80, 0.78, 0.74},
     0.15,
     true,
     "|eardrum|ear drum|drum|membrana tympani|"},
    {Anatomy::kTooth, "tooth", {0.97, 0.96, 0.92}, 1.8, true, "|teeth|tooth root|dentition|"},
}};

/// Lower case, with single blanks between words.
std::string plain(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool blank = c == '_' || c == ' ' || c == '-' || c == '\t';
    if (!blank) {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!result.empty() && result.back() != ' ') {
      result += ' ';
    }
  }
  while (!result.empty() && result.back() == ' ') {
    result.pop_back();
  }
  return result;
}

Structure structure_of(const Known& known) {
  return {known.name, known.colour, known.hardness, known.vital};
}

/// Colours that differ from neighbour to neighbour: steps of the golden ratio around the circle.
std::array<double, 3> colour_of(std::uint8_t label) {
  const double turn = std::fmod(0.618034 * label, 1.0);
  std::array<double, 3> colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = std::fmod(turn + static_cast<double>(i) / 3.0, 1.0);
    colour[i] = 0.55 + 0.35 * std::clamp(std::abs(6.0 * at - 3.0) - 1.0, 0.0, 1.0);
  }
  return colour;
}

const Known* known_by(const std::string& wanted) {
  for (const Known& known : kKnown) {
    if (wanted == known.name ||
        std::string_view(known.others).find('|' + wanted + '|') != std::string_view::npos) {
      return &known;
    }
  }
  return nullptr;
}

/// Name and usual names of a structure.
std::vector<std::string> forms_of(const Known& known) {
  std::vector<std::string> forms{known.name};
  const std::string_view others = known.others;
  for (std::size_t at = 1; at < others.size();) {
    const std::size_t end = others.find('|', at);
    forms.emplace_back(others.substr(at, end - at));
    at = end + 1;
  }
  return forms;
}

/// Words of more than three letters that both have.
int common_words(const std::string& a, const std::string& b) {
  constexpr std::size_t kShort = 3;
  int common = 0;
  std::istringstream words(a);
  for (std::string word; words >> word;) {
    common += word.size() > kShort && (" " + b + " ").find(" " + word + " ") != std::string::npos;
  }
  return common;
}

/// The labels that voxels have, in ascending order.
std::vector<std::uint8_t> labels_with_voxels(const BoneModel& model) {
  std::array<bool, 256> there{};
  for (const std::uint8_t label : model.labels) {
    there[label] = true;
  }
  std::vector<std::uint8_t> labels;
  for (std::size_t label = 1; label < there.size(); ++label) {
    if (there[label]) {
      labels.push_back(static_cast<std::uint8_t>(label));
    }
  }
  return labels;
}

}  // namespace

bool is_known_structure(std::string_view name) { return known_by(plain(name)) != nullptr; }

std::string nearest_structure(std::string_view name) {
  const std::string wanted = plain(name);
  std::tuple<int, std::size_t> best{1, 0};
  const char* found = kKnown.front().name;
  for (const Known& known : kKnown) {
    for (const std::string& form : forms_of(known)) {
      const std::tuple<int, std::size_t> here{-common_words(wanted, form),
                                              edit_distance(wanted, form)};
      if (here < best) {
        best = here;
        found = known.name;
      }
    }
  }
  return found;
}

Structure structure_named(std::string_view name, std::uint8_t label) {
  if (const Known* known = known_by(plain(name))) {
    return structure_of(*known);
  }
  return {std::string(name), colour_of(label), 1.0, false};
}

std::vector<Structure> known_structures() {
  std::vector<Structure> structures(kKnown.size() + 1);
  for (const Known& known : kKnown) {
    structures[static_cast<std::size_t>(known.label)] = structure_of(known);
  }
  return structures;
}

std::optional<std::uint8_t> find_label(const BoneModel& model, const std::string& name) {
  const std::string known = structure_named(name, 0).name;
  for (const std::uint8_t label : labels_with_voxels(model)) {
    const std::string& own = model.structures[label].name;
    if (own == name || own == known) {
      return label;
    }
  }
  return std::nullopt;
}

std::uint8_t label_named(const BoneModel& model, const std::string& name, const char* table) {
  if (const auto label = find_label(model, name)) {
    return *label;
  }
  std::string names;
  for (const std::uint8_t label : labels_with_voxels(model)) {
    names += (names.empty() ? "" : ", ") + model.structures[label].name;
  }
  throw InputError(fmt::format("{}: the bone {} has no structure '{}'; it has {}", table,
                               model.name, name, names));
}

}  // namespace haptrial::bone
