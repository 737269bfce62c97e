#include "protocols/bone_drilling/load_bones.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/shared_cache.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/data/procedural_bone.h"
#include "core/subject/drilling/cavity_plan.h"
#include "core/subject/drilling/work_row.h"
#include "protocols/bone_drilling/definition/placement.h"
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
  static SharedCache<Options, bone::BoneModel> kept(6);  // an ear and its variants
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
  static SharedCache<Charted, subject::DrillingChart> kept(4);
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

std::vector<std::string> absent_feedback(const BoneDefinition& d, const fs::path& folder) {
  std::vector<std::string> absent;
  const auto look_for = [&](const char* key, const std::string& file) {
    if (d.trainee_page && !file.empty() && !fs::exists(folder / file)) {
      absent.push_back(fmt::format("feedback.{} {}", key, file));
    }
  };
  look_for("study", d.experts_study);
  look_for("score", d.score_file);
  look_for("phases", d.phases_file);
  look_for("checklist", d.checklist_file);
  return absent;
}

}  // namespace

void load_bones(BoneDefinition& d, const fs::path& folder) {
  d.absent_files = absent_feedback(d, folder);
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

namespace {

/// When a virtual surgeon first began to work on something in a trial [s].
double start_of_phase(const record::SessionReader& reader, const BoneBeginning& beginning,
                      std::int32_t bone) {
  const std::vector<record::PassRow> passes = reader.passes();
  std::vector<std::string> known;
  for (const record::WorkRow& row : reader.rows<record::WorkRow>()) {
    const record::PassRow& pass = passes.at(static_cast<std::size_t>(row.pass));
    if (pass.trial != beginning.procedure || pass.repetition != bone) {
      continue;
    }
    if (record::word_of(row.work) == beginning.at_phase) {
      return row.time;
    }
    known.emplace_back(record::word_of(row.work));
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  throw InputError(fmt::format("{}: procedure {} has no phase \"{}\"; allowed: {}",
                               reader.path().string(), beginning.procedure, beginning.at_phase,
                               known.empty() ? "a time (bone.at), as the session tells no phases"
                                             : fmt::format("{}", fmt::join(known, ", "))));
}

/// The number of ticks after which the bone is taken.
std::uint64_t ticks_until(const BoneReplay& replay, const BoneBeginning& beginning,
                          std::int32_t bone) {
  if (!beginning.at && beginning.at_phase.empty()) {
    return replay.ticks(beginning.procedure);
  }
  const double time =
      beginning.at ? *beginning.at : start_of_phase(replay.reader(), beginning, bone);
  return static_cast<std::uint64_t>(std::llround(time * replay.rate()));
}

}  // namespace

bone::BoneModel bone_left(const BoneStage& stage) {
  bone::BoneModel left = *stage.model;
  const bone::BoneWorld& world = std::as_const(*stage.simulator).world();
  const bone::BoneVolume& volume = world.volume(0);
  left.density.assign(left.labels.size(), 0.0F);
  geometry::visit_voxels(left.grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (left.labels[at] != 0 && world.holder(voxel) == 0) {
      left.density[at] = volume.density(voxel);
    }
    left.labels[at] = left.density[at] > 0.0F ? left.labels[at] : 0;
  });
  return left;
}

bone::BoneModel bone_in_session(const std::filesystem::path& session,
                                const BoneBeginning& beginning) {
  const BoneReplay replay(session);
  const std::vector<int> trials = replay.trials();
  if (!std::binary_search(trials.begin(), trials.end(), beginning.procedure)) {
    throw InputError(fmt::format("{}: has no procedure {} (bone.procedure); allowed: {}",
                                 session.string(), beginning.procedure, fmt::join(trials, ", ")));
  }
  const std::int32_t bone = replay.last_bone(beginning.procedure);
  const std::uint64_t until = ticks_until(replay, beginning, bone);
  ReplayVerdict verdict;
  const auto stage = replay.restore_until(until, beginning.procedure, bone, verdict);
  if (!verdict.difference.empty()) {
    throw InputError(fmt::format("{}: procedure {} cannot be simulated again: {}", session.string(),
                                 beginning.procedure, verdict.difference));
  }
  const double end = static_cast<double>(verdict.ticks) / replay.rate();
  if (beginning.at && verdict.ticks < until) {
    throw InputError(
        fmt::format("{}: procedure {} ends after {:.3f} s; bone.at is {:g}, allowed: "
                    "0 to {:.3f} [s]",
                    session.string(), beginning.procedure, end, *beginning.at, end));
  }
  bone::BoneModel left = bone_left(*stage);
  left.source += fmt::format("; as procedure {} of {} left it after {:.3f} s", beginning.procedure,
                             session.filename().string(), end);
  return left;
}

}  // namespace haptrial::protocols
