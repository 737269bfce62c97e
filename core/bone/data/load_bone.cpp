#include "core/bone/data/load_bone.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/data/label_names.h"
#include "core/bone/data/resample.h"
#include "core/bone/data/segments.h"
#include "core/bone/data/volume_source.h"

namespace haptrial::bone {
namespace fs = std::filesystem;
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSmallTurn = 1.0 * kDegree;  // taken as it is
constexpr double kSmallShift = 0.25;          // of a corner from its place [voxels]
constexpr double kGreySpacing = 0.5e-3;       // Morris 2006, §3.2.1 [m]
constexpr double kThreshold = 300.0;          // [HU]
constexpr double kDense = 1500.0;             // [HU]
constexpr double kAirBelow = -500.0;          // a CT in Hounsfield units has values down here [HU]

/// State that the steps of an import share.
struct Import {
  std::string name;
  const LoadOptions& options;
  const Room& room;
  const geometry::WorkReport& report;
};

void check_options(const LoadOptions& options) {
  if (options.spacing && !(*options.spacing >= 0.05e-3 && *options.spacing <= 10e-3)) {
    throw InputError(
        fmt::format("the spacing is {:.4g} mm; allowed: 0.05 to 10 mm", 1e3 * *options.spacing));
  }
}

bool whole_from_0_to_255(std::span<const float> values) {
  return std::ranges::all_of(values, [](float value) {
    return value >= 0.0F && value <= 255.0F && value == std::floor(value);
  });
}

VolumeKind kind_of(const VolumeHead& head, std::span<const float> values,
                   const LoadOptions& options) {
  if (options.kind != VolumeKind::kAuto) {
    return options.kind;
  }
  if (head.labels) {
    return VolumeKind::kLabels;
  }
  if (head.hounsfield || !whole_from_0_to_255(values)) {
    return VolumeKind::kGrey;
  }
  std::array<bool, 256> seen{};
  for (const float value : values) {
    seen[static_cast<std::size_t>(value)] = true;
  }
  constexpr auto kManyLabels = 64;
  return std::ranges::count(seen, true) <= kManyLabels ? VolumeKind::kLabels : VolumeKind::kGrey;
}

void check_room(const Import& job, const geometry::VoxelGrid& grid, double bytes_per_voxel) {
  const double count = static_cast<double>(grid.size[0]) * grid.size[1] * grid.size[2];
  constexpr double kMost = 2e9;
  if (count > kMost) {
    throw InputError(
        fmt::format("{}: would have {} x {} x {} voxels of {:.4g} mm; allowed: {:.1e} in all; "
                    "choose a larger spacing",
                    job.name, grid.size[0], grid.size[1], grid.size[2], 1e3 * grid.spacing, kMost));
  }
  job.room(
      fmt::format("{}: {} x {} x {} voxels", job.name, grid.size[0], grid.size[1], grid.size[2]),
      bytes_per_voxel * count);
}

/// Whether the volume's own axes become those of the bone.
bool keeps_axes(const Pose& pose) { return pose.turn < kSmallTurn && pose.skew <= kSmallShift; }

/// Transform from B to the patient's axes, LPS.
Eigen::Affine3d patient_frame(const UprightVolume& volume) {
  const VoxelMap map = map_to(volume, keeps_axes(pose_of(volume)));
  Eigen::Affine3d X_PB;
  X_PB.linear() = volume.steps * map.turn;
  X_PB.translation() = volume.origin + volume.steps * map.offset;
  return X_PB;
}

/// How the volume lies, if it does not lie along the patient's axes.
std::string lie_of(const Pose& pose) {
  constexpr double kNone = 0.01 * kDegree;
  const char* now = keeps_axes(pose) ? "whose axes are kept" : "now along the axes of the patient";
  if (!keeps_axes(pose) && pose.slant > kNone) {
    return fmt::format("; its axes {:.2f} degrees off a right angle, {}", pose.slant / kDegree,
                       now);
  }
  return pose.turn > kNone ? fmt::format("; turned by {:.2f} degrees, {}", pose.turn / kDegree, now)
                           : "";
}

/// A warning about places of the patient's frame in a bone that keeps its own axes: those that come
/// with the volume are turned with it, and later ones are not.
void note_turn(const UprightVolume& volume, BoneModel& model) {
  const Pose pose = pose_of(volume);
  if (keeps_axes(pose) && pose.off > kSmallShift * volume.steps.colwise().norm().minCoeff()) {
    model.notes.push_back(fmt::format(
        "its axes, turned by {:.2f} degrees, are kept as the patient's: what is added to it after "
        "it was saved, and what is exported of it, lies up to {:.2g} mm beside the scan; add "
        "structures in the same import",
        pose.turn / kDegree, 1e3 * pose.off));
  }
}

/// How a volume becomes cubes.
struct Plan {
  geometry::VoxelGrid grid;
  bool own_axes;  // the grid's axes are the volume's
  bool as_it_is;  // its voxels are the grid's
  std::string sentence;
};

/// @throws InputError where nothing is left.
void crop_plan(const Import& job, Plan& plan) {
  if (!job.options.crop) {
    return;
  }
  const geometry::VoxelGrid whole = plan.grid;
  plan.grid = grid_within(whole, *job.options.crop);
  if (plan.grid.count() == 0) {
    const Eigen::Vector3d low = 1e3 * whole.origin;
    const Eigen::Vector3d high = 1e3 * whole.centre(whole.last());
    throw InputError(
        fmt::format("{}: the box to crop holds none of its voxels, which span {:.1f} {:.1f} {:.1f} "
                    "to {:.1f} {:.1f} {:.1f} mm",
                    job.name, low.x(), low.y(), low.z(), high.x(), high.y(), high.z()));
  }
  if (plan.grid.size != whole.size) {
    plan.as_it_is = false;
    plan.sentence += ", cropped";
  }
}

Plan plan_for(const Import& job, const UprightVolume& volume, std::optional<double> spacing) {
  const Pose pose = pose_of(volume);
  const double edge = std::cbrt(std::abs(volume.steps.determinant()));
  const double smallest = volume.steps.colwise().norm().minCoeff();
  const bool cubes = pose.shape <= kSmallShift;
  Plan plan;
  plan.own_axes = keeps_axes(pose);
  const double wanted = spacing.value_or(cubes ? edge : smallest);
  plan.as_it_is = plan.own_axes && cubes && std::abs(wanted - edge) < 1e-3 * edge;
  if (plan.as_it_is) {
    plan.grid = {volume.size, volume.origin, edge};
    plan.sentence = fmt::format("as it is, in voxels of {:.4g} mm", 1e3 * edge);
  } else {
    plan.grid = grid_over(volume, wanted, plan.own_axes);
    const Eigen::Vector3d edges = 1e3 * volume.steps.colwise().norm();
    plan.sentence = fmt::format("resampled from {:.4g} x {:.4g} x {:.4g} to {:.4g} mm", edges[0],
                                edges[1], edges[2], 1e3 * wanted);
  }
  plan.sentence += lie_of(pose);
  crop_plan(job, plan);
  return plan;
}

std::vector<std::uint8_t> labels_of(const Import& job, std::span<const float> values) {
  if (!whole_from_0_to_255(values)) {
    const auto [low, high] = std::ranges::minmax(values);
    throw InputError(
        fmt::format("{}: its labels run from {} to {}; allowed: whole numbers from 0 to 255",
                    job.name, low, high));
  }
  std::vector<std::uint8_t> labels(values.size());
  std::ranges::transform(values, labels.begin(),
                         [](float value) { return static_cast<std::uint8_t>(value); });
  return labels;
}

std::array<bool, 256> used_labels(const BoneModel& model) {
  std::array<bool, 256> used{};
  for (const std::uint8_t label : model.labels) {
    used[label] = true;
  }
  return used;
}

/// Every label that is used, in the bone or before in its file, gets a structure, named or not.
void name_labels(const Import& job, std::vector<Structure> structures, const LabelVolumes& before,
                 BoneModel& model) {
  if (!job.options.label_file.empty()) {
    LabelTable table = read_label_table(job.options.label_file);
    for (std::size_t label = 1; label < structures.size(); ++label) {
      const auto other = table.names.find(structures[label].name);
      if (other != table.names.end()) {
        structures[label] = structure_named(other->second, static_cast<std::uint8_t>(label));
      }
    }
    std::vector<Structure>& named = table.structures;
    structures.resize(std::max(structures.size(), named.size()));
    for (std::size_t label = 1; label < named.size(); ++label) {
      if (!named[label].name.empty()) {
        structures[label] = std::move(named[label]);
      }
    }
  }
  std::array<bool, 256> used = used_labels(model);
  for (std::size_t label = 1; label < used.size(); ++label) {
    used[label] = used[label] || before[label] > 0.0;
  }
  for (std::size_t label = 1; label < used.size(); ++label) {
    if (!used[label]) {
      continue;
    }
    if (structures.size() <= label) {
      structures.resize(label + 1);
    }
    if (structures[label].name.empty()) {
      const bool alone = std::ranges::count(used.begin() + 1, used.end(), true) == 1;
      structures[label] = structure_named(alone ? "bone" : fmt::format("label {}", label),
                                          static_cast<std::uint8_t>(label));
    }
  }
  model.structures = std::move(structures);
}

/// A name stands for one structure, and several names of a file can be forms of one known name, as
/// "sigmoid sinus" and "dura" are. The first label with a name takes the voxels of all others.
void join_equal_names(BoneModel& model) {
  const std::array<bool, 256> used = used_labels(model);
  std::array<std::uint8_t, 256> joined{};
  std::iota(joined.begin(), joined.end(), std::uint8_t{0});
  std::vector<Structure>& structures = model.structures;
  for (std::size_t label = 2; label < structures.size(); ++label) {
    const Structure& other = structures[label];
    const auto first =
        std::ranges::find(structures.begin() + 1, structures.end(), other.name, &Structure::name);
    const auto kept = static_cast<std::size_t>(first - structures.begin());
    if (other.name.empty() || kept == label) {
      continue;
    }
    first->vital = first->vital || other.vital;
    joined[label] = static_cast<std::uint8_t>(kept);
    if (used[kept] && used[label]) {
      model.notes.push_back(
          fmt::format("labels {} and {} are one structure here, {}", kept, label, first->name));
    }
    structures[label] = {};
  }
  for (std::uint8_t& label : model.labels) {
    label = joined[label];
  }
}

void leave_out(const Import& job, BoneModel& model) {
  const std::array<bool, 256> used = used_labels(model);
  for (const std::string& name : job.options.without) {
    const Structure wanted = structure_named(name, 0);
    std::vector<std::string> known;
    std::size_t label = 0;
    for (std::size_t i = 1; i < model.structures.size(); ++i) {
      if (model.structures[i].name.empty() || !used[i]) {
        continue;
      }
      known.push_back(model.structures[i].name);
      if (model.structures[i].name == wanted.name) {
        label = i;
      }
    }
    if (label == 0) {
      const std::string hint = did_you_mean(name, known);
      throw InputError(fmt::format("{}: has no '{}' to leave out{} allowed: {}", job.name, name,
                                   hint.empty() ? ";" : hint, fmt::join(known, ", ")));
    }
    for (std::size_t i = 0; i < model.labels.size(); ++i) {
      if (model.labels[i] != label) {
        continue;
      }
      model.labels[i] = 0;
      if (!model.density.empty()) {
        model.density[i] = 0.0F;
      }
    }
  }
}

BoneModel labelled_bone(const Import& job, const VolumeHead& head, const UprightVolume& volume) {
  const Plan plan = plan_for(job, volume, job.options.spacing);
  check_room(job, plan.grid, 2.0);
  BoneModel model;
  model.grid = plan.grid;
  model.labels = labels_of(job, volume.components[0]);
  LabelVolumes before{};
  if (!plan.as_it_is) {
    VolumeHead lattice;
    lattice.size = volume.size;
    lattice.steps = volume.steps;
    lattice.origin = volume.origin;
    before = volumes_of(volume.components[0], lattice, job.options.crop, patient_frame(volume));
    model.labels = resample_labels(model.labels, volume, plan.grid, plan.own_axes, job.report);
  }
  model.source = fmt::format("{} ({}), labels {}", job.name, head.format, plan.sentence);
  name_labels(job, structures_in(head.keys), before, model);
  note_losses(job.name, before, model);
  return model;
}

void tell_findings(const Import& job, std::span<const float> values,
                   const std::optional<GreyLevels>& used) {
  if (job.options.findings) {
    const GreyHistogram histogram(values);
    job.options.findings({histogram, find_threshold(histogram), used});
  }
}

GreyLevels levels_of(const Import& job, const VolumeHead& head, std::span<const float> values) {
  const LoadOptions& options = job.options;
  const auto [low, high] = std::ranges::minmax(values);
  const bool hounsfield = head.hounsfield || low <= kAirBelow;
  if (!options.threshold && !options.find_threshold && !hounsfield) {
    tell_findings(job, values, std::nullopt);
    throw InputError(
        fmt::format("{}: its values run from {:.6g} to {:.6g}, which are not Hounsfield units; "
                    "give a threshold for bone, such as the {:.6g} that 'auto' finds",
                    job.name, low, high, find_threshold(values)));
  }
  GreyLevels levels{};
  levels.threshold =
      options.find_threshold ? find_threshold(values) : options.threshold.value_or(kThreshold);
  if (options.find_threshold && hounsfield && !(levels.threshold >= 0.0)) {
    tell_findings(job, values, std::nullopt);
    throw InputError(fmt::format(
        "{}: the threshold that 'auto' finds is {:.6g} HU, where there is no bone; give a number",
        job.name, levels.threshold));
  }
  constexpr double kMostBone = 0.99;
  const bool usual = hounsfield && levels.threshold < kDense;
  levels.dense =
      options.dense.value_or(usual ? kDense : quantile_from(values, levels.threshold, kMostBone));
  if (!options.dense && !(levels.dense > levels.threshold)) {
    levels.dense = levels.threshold + 1.0;
  }
  if (!(levels.dense > levels.threshold)) {
    throw InputError(fmt::format("dense bone is {:.6g}; allowed: above the threshold, {:.6g}",
                                 levels.dense, levels.threshold));
  }
  tell_findings(job, values, levels);
  if (!(high >= levels.threshold)) {
    throw InputError(
        fmt::format("{}: holds no bone: its values run from {:.6g} to {:.6g}, all below the "
                    "threshold of {:.6g}; choose a lower threshold",
                    job.name, low, high, levels.threshold));
  }
  return levels;
}

BoneModel grey_bone(const Import& job, const VolumeHead& head, const UprightVolume& volume) {
  const GreyLevels levels = levels_of(job, head, volume.components[0]);
  const Plan plan = plan_for(job, volume, job.options.spacing.value_or(kGreySpacing));
  check_room(job, plan.grid, 4.0 * sizeof(float) + 2.0);
  BoneModel model;
  model.grid = plan.grid;
  BigArray<float> resampled;
  if (!plan.as_it_is) {
    resampled = resample_grey(volume, plan.grid, plan.own_axes, job.report);
  }
  const BigArray<float>& values = plan.as_it_is ? volume.components[0] : resampled;
  model.labels.resize(values.size());
  model.density.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    model.density[i] = density_of(values[i], levels);
    model.labels[i] = model.density[i] > 0.0F ? 1 : 0;
  }
  model.source =
      fmt::format("{} ({}), bone from {:.6g}{} on and dense at {:.6g}, {}", job.name, head.format,
                  levels.threshold, head.hounsfield ? " HU" : "", levels.dense, plan.sentence);
  name_labels(job, {Structure{}, structure_named("bone", 1)}, {}, model);
  return model;
}

/// The grid to the last bit, where the key says the same as the head.
void take_exact_grid(const VolumeHead& head, geometry::VoxelGrid& grid) {
  const auto key = head.keys.find("haptrial_grid");
  if (key == head.keys.end()) {
    return;
  }
  std::istringstream in(key->second);
  geometry::VoxelGrid exact = grid;
  if (in >> exact.spacing >> exact.origin.x() >> exact.origin.y() >> exact.origin.z() &&
      std::abs(exact.spacing - grid.spacing) < 1e-9 && (exact.origin - grid.origin).norm() < 1e-9) {
    grid = exact;
  }
}

/// Loads a bone that save_bone() wrote.
BoneModel saved_bone(const Import& job, const VolumeHead& head, const UprightVolume& volume) {
  BoneModel model = labelled_bone(job, head, volume);
  const bool same = model.grid.size == volume.size;
  if (same) {
    take_exact_grid(head, model.grid);
  }
  const auto source = head.keys.find("haptrial_source");
  if (same && source != head.keys.end()) {
    model.source = source->second;
  }
  for (const auto& [key, note] : head.keys) {
    if (key.starts_with(kNoteKey)) {
      model.notes.push_back(note);
    }
  }
  if (volume.components.size() < 2) {
    return model;
  }
  model.density.assign(model.labels.size(), 0.0F);
  UprightVolume second = volume;
  second.components = {volume.components[1]};
  const Plan plan = plan_for(job, volume, job.options.spacing);
  const BigArray<float> values = plan.as_it_is
                                     ? second.components[0]
                                     : resample_grey(second, plan.grid, plan.own_axes, job.report);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (model.labels[i] == 0) {
      continue;
    }
    model.density[i] = static_cast<float>(std::clamp(std::round(values[i]), 1.0F, 255.0F) / 255.0F);
  }
  return model;
}

/// Adds the structures of the files beside the scan.
void add_structures(const Import& job, const Eigen::Affine3d& X_PB, BoneModel& model) {
  const LabelTable table =
      job.options.label_file.empty() ? LabelTable{} : read_label_table(job.options.label_file);
  if (!job.options.segments.empty()) {
    const std::string name = job.options.segments.string();
    SourceVolume segments = read_volume(job.options.segments, job.room, job.report);
    join_layers(name, segments);
    std::vector<Structure> structures = structures_in(segments.head.keys);
    if (structures.size() < 2) {
      throw InputError(fmt::format(
          "{}: names no segments; choose a segmentation of 3D Slicer (.seg.nrrd)", name));
    }
    for (std::size_t label = 1; label < structures.size(); ++label) {
      const auto other = table.names.find(structures[label].name);
      if (other != table.names.end()) {
        structures[label] = structure_named(other->second, static_cast<std::uint8_t>(label));
      }
    }
    labels_of(job, segments.values);
    add_segments(name, segments, structures, job.options.crop, X_PB, model);
    model.notes.insert(model.notes.end(), segments.head.notes.begin(), segments.head.notes.end());
    model.source += fmt::format("; segments of {}", job.options.segments.filename().string());
  }
  for (const MeshStructure& one : job.options.meshes) {
    add_mesh(one, job.options.crop, X_PB, model, job.report);
    model.source += fmt::format("; {} of {}", one.name, one.file.filename().string());
  }
}

}  // namespace

BoneModel load_bone(const fs::path& file, const LoadOptions& options,
                    const geometry::WorkReport& report) {
  check_options(options);
  const Room room = options.room ? Room(options.room) : Room(check_system_memory);
  const Import job{file.string(), options, room, report};
  SourceVolume source = read_volume(file, room, report);
  if (!source.head.keys.contains("haptrial_bone") && names_segments(source.head.keys)) {
    join_layers(job.name, source);
  }
  const VolumeHead head = source.head;
  const auto saved = head.keys.find("haptrial_bone");
  if (saved == head.keys.end() && head.components > 1) {
    throw InputError(
        fmt::format("{}: has {} values per voxel; allowed: 1", job.name, head.components));
  }
  const VolumeKind kind =
      saved != head.keys.end() ? VolumeKind::kLabels : kind_of(head, source.values, options);
  const UprightVolume volume = upright(std::move(source));
  BoneModel model = saved != head.keys.end()      ? saved_bone(job, head, volume)
                    : kind == VolumeKind::kLabels ? labelled_bone(job, head, volume)
                                                  : grey_bone(job, head, volume);
  model.name = saved != head.keys.end() ? saved->second : file.filename().string();
  model.notes.insert(model.notes.begin(), head.notes.begin(), head.notes.end());
  note_turn(volume, model);
  add_structures(job, patient_frame(volume), model);
  join_equal_names(model);
  leave_out(job, model);
  if (options.mirror) {
    model = mirrored(model);
  }
  if (std::ranges::all_of(model.labels, [](std::uint8_t label) { return label == 0; })) {
    throw InputError(fmt::format(
        "{}: holds no bone; choose a volume with at least one voxel of bone", job.name));
  }
  if (kind == VolumeKind::kGrey) {
    crop_to_bone(model);
  }
  try {
    check(model);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", job.name, error.what()));
  }
  return model;
}

}  // namespace haptrial::bone
