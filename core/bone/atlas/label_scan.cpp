#include "core/bone/atlas/label_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/bone/atlas/structure_masks.h"
#include "core/bone/data/added_structures.h"

namespace haptrial::bone {
namespace {

/// @throws InputError where nothing says which side it is, or a label is not to be had.
void turn_to_side(EarSide side, BoneModel& ear) {
  if (ear.structures.size() > kBeyondEar) {
    throw InputError(fmt::format("{}: has a label {}; allowed: to {}", ear.name,
                                 ear.structures.size() - 1, kBeyondEar - 1));
  }
  const auto own = ear_side(ear);
  if (!own) {
    throw InputError(fmt::format(
        "{}: its structures do not say whether it is a left or a right ear; label inner ear, ear "
        "canal and sigmoid sinus, by names that 'haptrial bone structures' knows",
        ear.name));
  }
  if (*own != side) {
    ear = mirrored(ear);
  }
}

/// An ear's labels become those that the bone has for the same names.
void rename_labels(const BoneModel& ear, BoneModel& model, std::vector<std::uint8_t>& labels) {
  std::array<bool, 256> used{};
  for (const std::uint8_t label : labels) {
    used[label] = true;
  }
  std::array<std::uint8_t, 256> to{};
  to[kBeyondEar] = kBeyondEar;
  for (std::size_t label = 1; label < ear.structures.size(); ++label) {
    if (used[label]) {
      to[label] = label_for(ear.structures[label], model);
    }
  }
  std::ranges::transform(labels, labels.begin(), [&to](std::uint8_t label) { return to[label]; });
}

std::string source_words(const BoneModel& model, const std::vector<CarriedStructure>& carried,
                         std::size_t ears) {
  std::string words = fmt::format("; labels of {} registered ear{}", ears, ears == 1 ? "" : "s");
  const char* before = ", 95 % of each expected within";
  for (const CarriedStructure& one : carried) {
    if (one.margin && one.voxels > 0) {
      words += fmt::format("{} {:.1f} mm ({})", before, 1e3 * *one.margin,
                           model.structures[one.label].name);
      before = ",";
    }
  }
  return words;
}

}  // namespace

CarriedLabels label_scan(BoneModel& scan, EarSide side, std::vector<BoneModel> ears,
                         const RegistrationOptions& options, const geometry::WorkReport& report) {
  for (BoneModel& ear : ears) {
    turn_to_side(side, ear);
  }
  CarriedLabels carried;
  std::vector<std::vector<std::uint8_t>> labels;
  for (RegisteredEar& one : register_ears(scan, ears, options, report)) {
    rename_labels(ears[labels.size()], scan, one.labels);
    labels.push_back(std::move(one.labels));
    carried.correlations.push_back(one.correlation);
  }
  carried.structures = fuse_labels(labels, scan, options.threads);
  scan.source += source_words(scan, carried.structures, ears.size());
  return carried;
}

}  // namespace haptrial::bone
