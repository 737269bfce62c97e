#include "protocols/bone_drilling/load_bones.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/kept.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/data/ear_variants.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/data/mandible.h"
#include "core/bone/data/temporal_bone.h"
#include "core/subject/drilling/cavity_plan.h"
#include "protocols/bone_drilling/bone_in_session.h"
#include "protocols/bone_drilling/definition/smallest_burr.h"
#include "protocols/definition/lab_file.h"

namespace haptrial::protocols {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMadeEar = "procedural temporal";

/// A procedural bone; one of the last few if it is the same, as a definition is read many times.
template <class Options>
std::shared_ptr<const bone::BoneModel> procedural(
    bone::BoneModel (*make)(const Options&, const geometry::WorkReport&), const BoneDefinition& d,
    Options options = {}) {
  static Kept<Options, bone::BoneModel> kept(6);  // an ear and its variants
  options.seed = d.bone_seed;
  options.spacing = d.spacing.value_or(options.spacing);
  return kept.get(options,
                  [&] { return std::make_shared<const bone::BoneModel>(make(options, {})); });
}

/// All that a chart depends on.
struct Charted {
  std::shared_ptr<const bone::BoneModel> model;
  BonePlacement placement;
  subject::CavityParameters cavity;
  bool operator==(const Charted&) const = default;
};

/// The chart of a bone; one of the last few if it is the same, likewise.
std::shared_ptr<const subject::DrillingChart> chart_of(
    const std::shared_ptr<const bone::BoneModel>& model, const BonePlacement& placement,
    const subject::CavityParameters& cavity) {
  static Kept<Charted, subject::DrillingChart> kept(4);
  return kept.get({model, placement, cavity}, [&] {
    return std::make_shared<const subject::DrillingChart>(
        make_chart(*model, pose_of(placement, model->grid), cavity));
  });
}

/// @param variant  what follows the name of the made ear: nothing, or a comma and a variant
std::shared_ptr<const bone::BoneModel> made_ear(std::string_view variant, const BoneDefinition& d) {
  constexpr std::string_view kBefore = ", ";
  if (!variant.empty() && !variant.starts_with(kBefore)) {
    throw InputError(fmt::format(
        "{}: \"{}{}\" among the bones; write \"{}\", or a variant after a comma: \"{}, {}\"",
        d.file_name, kMadeEar, variant, kMadeEar, kMadeEar, bone::ear_variants().front()));
  }
  bone::TemporalBoneOptions options;
  options.variant = variant.empty() ? "" : variant.substr(kBefore.size());
  try {
    return procedural<bone::TemporalBoneOptions>(bone::make_temporal_bone, d, std::move(options));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: bones: {}", d.file_name, error.what()));
  }
}

std::shared_ptr<const bone::BoneModel> load_source(const std::string& source,
                                                   const BoneDefinition& d,
                                                   const fs::path& folder) {
  if (source.starts_with(kMadeEar)) {
    return made_ear(std::string_view(source).substr(kMadeEar.size()), d);
  }
  if (source == "procedural mandible") {
    return procedural<bone::MandibleOptions>(bone::make_mandible, d);
  }
  const fs::path file = fs::path(source).is_absolute() ? fs::path(source) : folder / source;
  if (is_session(source)) {
    return std::make_shared<const bone::BoneModel>(bone_in_session(file, d.beginning));
  }
  bone::LoadOptions options;
  options.spacing = d.spacing;
  return std::make_shared<const bone::BoneModel>(bone::load_bone(file, options));
}

/// A bone whose cavity is removed, as the stills of its stages show it, down to a share of its
/// depth.
std::shared_ptr<const bone::BoneModel> carved(const BoneDefinition& d,
                                              const bone::BoneModel& model) {
  const std::vector<float> depths =
      subject::planned_depths(model, pose_of(d.placement, model.grid), *d.cavity, smallest_burr(d));
  const float deepest = *std::max_element(depths.begin(), depths.end());
  bone::BoneModel left = model;
  for (std::size_t at = 0; at < depths.size(); ++at) {
    if (subject::is_gone_at(depths[at], d.beginning.planned_to, deepest)) {
      left.labels[at] = 0;
      if (!left.density.empty()) {
        left.density[at] = 0.0F;
      }
    }
  }
  left.source += fmt::format("; its cavity removed to {:g} of the depth", d.beginning.planned_to);
  return std::make_shared<const bone::BoneModel>(std::move(left));
}

std::shared_ptr<const bone::RegionMap> region_map(const BoneDefinition& d,
                                                  const bone::BoneModel& model) {
  double largest = 0.0;  // reach of a burr [m]
  for (const bone::ToolSpec& tool : d.simulator.tools) {
    const auto* burr = tool.as<bone::BurrTool>();
    largest = std::max(largest, burr != nullptr ? burr->radius() : 0.0);
  }
  try {
    return std::make_shared<const bone::RegionMap>(*d.forbidden, model, largest);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", d.file_name, error.what()));
  }
}

std::shared_ptr<const hint::HintMap> hint_map(const BoneDefinition& d,
                                              const bone::BoneModel& model) {
  try {
    return std::make_shared<const hint::HintMap>(*d.hints, model);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", d.file_name, error.what()));
  }
}

/// Start of a hand that only sees: in the middle of the first picture, in front of all bone.
Eigen::Vector3d before_bones(const BoneDefinition& d) {
  constexpr double kBefore = 0.010;  // of the nearest bone; beyond the largest burr's radius [m]
  const Camera& camera = d.simulator.camera.start;
  const Eigen::Vector3d towards = camera.axes().col(2);
  double nearest = camera.distance();
  for (const auto& model : d.bones) {
    const geometry::VoxelGrid& grid = model->grid;
    const Eigen::Isometry3d pose = pose_of(d.placement, grid);
    const Eigen::Vector3d along = grid.spacing * (pose.linear().transpose() * -towards);
    const double first = towards.dot(camera.eye - pose * grid.origin);
    std::size_t voxel = 0;
    for (int k = 0; k < grid.size[2]; ++k) {
      for (int j = 0; j < grid.size[1]; ++j) {
        double depth = first + along.y() * j + along.z() * k;
        for (int i = 0; i < grid.size[0]; ++i, ++voxel, depth += along.x()) {
          nearest = model->labels[voxel] != 0 ? std::min(nearest, depth) : nearest;
        }
      }
    }
  }
  return camera.eye - std::max(0.25 * nearest, nearest - kBefore) * towards;
}

}  // namespace

void load_bones(BoneDefinition& d, const fs::path& folder) {
  if (d.hints) {
    hint::load_limits(*d.hints, folder);
  }
  for (const std::string& source : d.sources) {
    const auto loaded = load_source(source, d, folder);
    d.bones.push_back(d.mirror ? std::make_shared<const bone::BoneModel>(bone::mirrored(*loaded))
                               : loaded);
    if (d.beginning.planned_to > 0.0) {
      d.bones.back() = carved(d, *d.bones.back());
    }
    try {
      check_placement(d.placement, *d.bones.back(), d.simulator.camera.start,
                      d.cavity ? &*d.cavity : nullptr);
      bone::check_soft_tissue(*d.bones.back(), d.simulator.soft_tissue);
      bone::check_bleeding(*d.bones.back(), d.simulator.bleeding);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", d.file_name, error.what()));
    }
    if (d.cavity) {
      d.charts.push_back(chart_of(d.bones.back(), d.placement, *d.cavity));
    }
    if (d.nerves) {
      d.nerve_distances.push_back(
          std::make_shared<const nerve::NerveDistances>(*d.bones.back(), d.nerves->nerves));
    }
    if (d.forbidden) {
      d.region_maps.push_back(region_map(d, *d.bones.back()));
    }
    if (d.hints) {
      d.hint_maps.push_back(hint_map(d, *d.bones.back()));
    }
  }
  d.mouse.in_space = true;
  d.mouse.start = d.drilling.scale * before_bones(d);
}

BoneDefinition load_bone_definition(const fs::path& file) {
  const fs::path folder = file.parent_path();
  Table root = load_with_lab(file);
  BoneDefinition d = read_bone_definition(root, file.string(), &folder);
  root.finish();
  load_bones(d, folder);
  return d;
}

}  // namespace haptrial::protocols
