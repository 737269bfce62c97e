#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/bone/atlas/compare_labels.h"
#include "core/bone/atlas/label_scan.h"
#include "core/bone/data/load_bone.h"
#include "experiments/command/bone/bone_carving.h"
#include "experiments/command/bone/bone_options.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct BoneAtlasOptions : BoneInput, BoneOutput, BoneBox {
  std::vector<std::string> ears;
  std::string side;
  std::string against;
  int iterations{bone::RegistrationOptions{}.iterations};
};

bone::EarSide side_of(const std::string& word) {
  if (word != "right" && word != "left") {
    throw InputError(not_allowed("--side", fmt::format("'{}'", word), {"right", "left"}));
  }
  return word == "left" ? bone::EarSide::kLeft : bone::EarSide::kRight;
}

/// Refuses a scan of far more than an ear: registration begins with middle on middle.
/// @throws InputError
void check_size(const bone::BoneModel& scan) {
  constexpr double kMost = 100e-3;  // [m]
  const auto& size = scan.grid.size;
  const double longest = scan.grid.spacing * *std::max_element(size.begin(), size.end());
  if (longest > kMost) {
    throw InputError(
        fmt::format("{}: its bone spans {:.0f} mm; allowed: to {:.0f} mm; keep the ear alone, as "
                    "with --around X,Y,Z,60 about the inner ear",
                    scan.name, longest / kMillimetre, kMost / kMillimetre));
  }
}

/// @throws InputError also for an ear that was given before: margins would be of one ear with
/// itself, and so nothing.
std::vector<bone::BoneModel> load_ears(const std::vector<std::string>& files) {
  std::vector<bone::BoneModel> ears;
  for (const std::string& file : files) {
    bone::BoneModel ear = bone::load_bone(file);
    ear.name = file;
    for (const bone::BoneModel& before : ears) {
      if (before.grid.size == ear.grid.size && before.labels == ear.labels) {
        throw InputError(
            fmt::format("{}: is the same ear as {}; give each ear once", file, before.name));
      }
    }
    ears.push_back(std::move(ear));
  }
  return ears;
}

std::string or_none(const std::optional<double>& value, double unit, int digits) {
  return value ? fmt::format("{:.{}f}", *value / unit, digits) : "-";
}

void print_carried(const bone::BoneModel& model, const std::vector<bone::CarriedStructure>& carried,
                   const std::optional<bone::BoneModel>& truth) {
  fmt::print("{:28} {:>8} {:>10}{}\n", "structure", "voxels", "margin mm",
             truth ? "   Dice  distance mm   held %" : "");
  for (const bone::CarriedStructure& one : carried) {
    fmt::print("{:28} {:8} {:>10}", model.structures[one.label].name, one.voxels,
               or_none(one.margin, kMillimetre, 2));
    if (truth) {
      if (const auto match = bone::compare_label(model, one.label, *truth, one.margin)) {
        fmt::print("   {:4.2f} {:>12} {:>8}", match->dice, or_none(match->distance, kMillimetre, 2),
                   or_none(match->held, 0.01, 1));
      }
    }
    fmt::print("\n");
  }
}

void print_doubts(const bone::BoneModel& model, const std::vector<bone::CarriedStructure>& carried,
                  std::size_t ears) {
  for (const bone::CarriedStructure& one : carried) {
    if (one.voxels == 0) {
      fmt::print("WARNING: nothing is left of '{}': the ears do not agree where it lies\n",
                 model.structures[one.label].name);
    }
  }
  if (ears == 1) {
    fmt::print("WARNING: one ear says nothing of how wrong the labels may be; give several\n");
  }
  fmt::print("note        the labels are a proposal: look them over, slice by slice\n");
}

int bone_atlas(const BoneAtlasOptions& options) {
  const MemoryBudget budget(options.max_memory);
  check_new_bone(options);
  const bone::EarSide side = side_of(options.side);
  bone::LoadOptions load = load_options(options, budget);
  load.crop = chosen_box(options);
  bone::BoneModel scan = bone::load_bone(options.in, load);
  check_size(scan);
  std::optional<bone::BoneModel> truth;
  if (!options.against.empty()) {
    truth = bone::load_bone(options.against);
  }
  std::vector<bone::BoneModel> ears = load_ears(options.ears);
  const auto begin = std::chrono::steady_clock::now();
  bone::CarriedLabels carried;
  {
    ShownWork work("registering");
    carried = bone::label_scan(scan, side, std::move(ears), {.iterations = options.iterations},
                               work.report());
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  fmt::print("registered  {} in {:.0f} s\n", counted(options.ears.size(), "ear", "ears"),
             took.count());
  for (std::size_t ear = 0; ear < options.ears.size(); ++ear) {
    fmt::print("ear         {}: correlation {:.2f}\n", options.ears[ear],
               carried.correlations[ear]);
  }
  print_carried(scan, carried.structures, truth);
  print_doubts(scan, carried.structures, options.ears.size());
  save_new_bone(options, scan);
  return 0;
}

}  // namespace

void add_bone_atlas(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "atlas", "Label a scan by other ears, whose labels are known",
                             "haptrial bone atlas scan.nii.gz ear.nrrd --side left "
                             "--around=-60,10,5,60 --ears ears/*.nrrd",
                             {"the bone OUT", "algorithms/atlas.md"});
  auto& o = options_of<BoneAtlasOptions>(*sub, status, bone_atlas);
  add_bone_input(*sub, o);
  add_bone_output(*sub, o);
  add_bone_box(*sub, o);
  sub->add_option("--ears", o.ears, "Labelled ears (.nrrd, .nii), of any side; best three or more")
      ->required();
  sub->add_option("--side", o.side, "Side of the scan's ear: left or right")->required();
  sub->add_option("--iterations", o.iterations,
                  with_default("Steps of each search, of which an ear takes nine; fewer are "
                               "faster and rougher",
                               o.iterations))
      ->check(CLI::Range(10, 5000));
  sub->add_option("--against", o.against,
                  "True labels of the scan, to see how good the labels of the ears are");
}

}  // namespace haptrial::experiments
