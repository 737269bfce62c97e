#include "core/bone/simulator/soft_tissue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::bone {

using Eigen::Vector3d;

namespace {

constexpr double kMostReach = 250.0;  // of a distance field [voxels]
constexpr double kDeepest = 0.008;    // how far inside distances are told apart [m]
constexpr double kWayOut = 0.5;       // a gradient below it, inside: the ball is through
constexpr int kBeside = 3;            // voxels beyond the reach

/// The voxels with a label.
Eigen::AlignedBox3i box_of(const BoneModel& model, std::uint8_t label) {
  Eigen::AlignedBox3i box;
  const auto& size = model.grid.size;
  std::size_t at = 0;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++at) {
        if (model.labels[at] == label) {
          box.extend(Voxel(i, j, k));
        }
      }
    }
  }
  return box;
}

/// The part of a bone around a label: 1 where it is, else 2. Beyond the bone's grid it is nowhere:
/// a tool may come from there, through air.
BoneModel marked_part(const BoneModel& model, std::uint8_t label, double reach) {
  const geometry::VoxelGrid& grid = model.grid;
  const int beside = static_cast<int>(std::ceil(reach / grid.spacing)) + kBeside;
  const Eigen::AlignedBox3i box = box_of(model, label);
  const Voxel low = box.min().array() - beside;
  const Voxel size = box.sizes().array() + 1 + 2 * beside;
  BoneModel part;
  part.name = model.name;
  part.grid = {{size.x(), size.y(), size.z()},
               grid.origin + grid.spacing * low.cast<double>(),
               grid.spacing};
  part.structures = {{"", {}}, {"soft", {}}, {"other", {}}};
  const Voxel last = grid.last();
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      for (int i = 0; i < size.x(); ++i) {
        const Voxel v = low + Voxel(i, j, k);
        const bool there = (v.array() >= 0).all() && (v.array() <= last.array()).all() &&
                           model.labels[grid.index(v)] == label;
        part.labels.push_back(there ? 1 : 2);
      }
    }
  }
  return part;
}

/// The mean of each voxel and its neighbours along an axis, itself twice.
void smooth(std::vector<float>& values, const std::array<std::int32_t, 3>& size, int axis) {
  const std::array<std::ptrdiff_t, 3> step{1, size[0], std::ptrdiff_t{size[0]} * size[1]};
  const std::ptrdiff_t beside = step[static_cast<std::size_t>(axis)];
  const std::vector<float> before = values;
  std::ptrdiff_t at = 0;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++at) {
        const std::array<int, 3> place{i, j, k};
        const int own = place[static_cast<std::size_t>(axis)];
        const auto of = [&](std::ptrdiff_t n) { return before[static_cast<std::size_t>(n)]; };
        const float low = own > 0 ? of(at - beside) : of(at);
        const float high =
            own + 1 < size[static_cast<std::size_t>(axis)] ? of(at + beside) : of(at);
        values[static_cast<std::size_t>(at)] = 0.25F * (low + 2.0F * of(at) + high);
      }
    }
  }
}

}  // namespace

const Schema<SoftTissueParameters>& soft_tissue_schema() {
  using P = SoftTissueParameters;
  static const auto schema =
      Schema<P>()
          .text("structure", &P::structure,
                "Structure of the bone, by any of its names, that is soft instead of bone")
          .required()
          .number("stiffness", &P::stiffness, {0.0, 3000.0, true}, "N/m",
                  "Stiffness of the soft structure's surface under a burr or a tube")
          .number("tears_at", &P::tears_at, {0.0, 50.0, true}, "N",
                  "Force at which the soft structure tears")
          .number("suction", &P::suction, {0.0, 50.0}, "N",
                  "Pull at which the soft structure comes off a tube that sucks");
  return schema;
}

std::vector<SoftTissueParameters> read_soft_tissue(Table& table) {
  std::vector<SoftTissueParameters> all;
  for (const std::string& name : table.keys()) {
    Table own = table.table(name);
    all.push_back(soft_tissue_schema().read(own));
  }
  return all;
}

void check_soft_tissue(const BoneModel& model, std::span<const SoftTissueParameters> parameters) {
  std::array<bool, 256> named{};
  for (const SoftTissueParameters& p : parameters) {
    const std::uint8_t label = label_named(model, p.structure, "soft_tissue");
    if (named[label]) {
      throw InputError(
          fmt::format("soft_tissue: '{}' is named twice", model.structures[label].name));
    }
    named[label] = true;
  }
}

SurfaceDepth::SurfaceDepth(const BoneModel& model, std::uint8_t label, double reach)
    : spacing_(model.grid.spacing) {
  const double known = std::min(reach + 3.0 * spacing_, kMostReach * spacing_);
  const double deep = std::min(kDeepest, kMostReach * spacing_);
  const BoneModel marked = marked_part(model, label, known);
  const DistanceField outside(marked, {false, true, false}, known);
  const DistanceField inside(marked, {false, false, true}, deep);
  size_ = marked.grid.size;
  low_ = marked.grid.origin;
  distance_.reserve(marked.labels.size());
  for (int k = 0; k < size_[2]; ++k) {
    for (int j = 0; j < size_[1]; ++j) {
      for (int i = 0; i < size_[0]; ++i) {
        const bool soft = marked.labels[distance_.size()] == 1;
        // The surface lies half a voxel from the centres on either side of it.
        const double d = soft ? 0.5 * spacing_ - inside.at({i, j, k}).value_or(deep)
                              : outside.at({i, j, k}).value_or(known) - 0.5 * spacing_;
        distance_.push_back(static_cast<float>(d));
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    smooth(distance_, size_, axis);
  }
}

bool SurfaceDepth::at(const Vector3d& p_B, LocalTissue& here) const noexcept {
  const Eigen::Array3d place = (p_B - low_).array() / spacing_;
  const Eigen::Array3d middle = place.round();  // the nearest voxel
  for (int axis = 0; axis < 3; ++axis) {
    if (!(middle[axis] >= 1.0 && middle[axis] + 1.0 < size_[static_cast<std::size_t>(axis)])) {
      return false;
    }
  }
  // Weights and their slopes have a row for each axis and a column for each of its three voxels.
  const Eigen::Array3d t = place - middle;
  Eigen::Array33d weight, slope;
  weight.col(0) = 0.5 * (0.5 - t).square();
  weight.col(1) = 0.75 - t.square();
  weight.col(2) = 0.5 * (0.5 + t).square();
  slope.col(0) = t - 0.5;
  slope.col(1) = -2.0 * t;
  slope.col(2) = t + 0.5;
  const auto dy = static_cast<std::size_t>(size_[0]);
  const std::size_t dz = dy * static_cast<std::size_t>(size_[1]);
  const Eigen::Array3d low = middle - 1.0;
  const std::size_t first = static_cast<std::size_t>(low[0]) +
                            dy * static_cast<std::size_t>(low[1]) +
                            dz * static_cast<std::size_t>(low[2]);
  here.distance = 0.0;
  here.gradient.setZero();
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const float* row =
          &distance_[first + static_cast<std::size_t>(j) * dy + static_cast<std::size_t>(k) * dz];
      for (int i = 0; i < 3; ++i) {
        const double value = static_cast<double>(row[i]);
        here.distance += value * weight(0, i) * weight(1, j) * weight(2, k);
        here.gradient += value / spacing_ *
                         Vector3d(slope(0, i) * weight(1, j) * weight(2, k),
                                  weight(0, i) * slope(1, j) * weight(2, k),
                                  weight(0, i) * weight(1, j) * slope(2, k));
      }
    }
  }
  return true;
}

SoftTissue::SoftTissue(const BoneModel& model, std::span<const SoftTissueParameters> parameters,
                       double largest_radius) {
  check_soft_tissue(model, parameters);
  for (const SoftTissueParameters& p : parameters) {
    const std::uint8_t label = label_named(model, p.structure, "soft_tissue");
    soft_[label] = true;
    const double held = p.suction / p.stiffness;  // how far a tube lifts it
    parts_.push_back({p, label, SurfaceDepth(model, label, largest_radius + held)});
  }
  own_ = touch();
  second_ = touch();
  holes_.reserve(kMostHoles);
  tears_.resize(2 * parts_.size());
}

SoftTissue::Touch SoftTissue::touch() const {
  Touch touch;
  touch.parts_.resize(parts_.size());
  return touch;
}

void SoftTissue::forget(Touch& touch) noexcept {
  for (TouchedPart& part : touch.parts_) {
    part.state = State::kUnfelt;
    part.dent = {};
  }
}

Vector3d SoftTissue::tick(const Vector3d& c_B, double radius, bool sucks) noexcept {
  begin_tick();
  return press_all(own_, c_B, radius, sucks, false);
}

Vector3d SoftTissue::tick_second(const Vector3d& c_B, double radius, bool sucks) noexcept {
  return press_all(second_, c_B, radius, sucks, true);
}

Vector3d SoftTissue::press_all(Touch& touch, const Vector3d& c_B, double radius, bool sucks,
                               bool second) noexcept {
  Vector3d force = Vector3d::Zero();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    PressResult pressed = press(parts_[i], touch.parts_[i], c_B, radius, sucks);
    if (pressed.tears) {
      pressed.tear.by_second = second;
      tear(pressed.tear, radius);
    }
    force += pressed.force;
  }
  return force;
}

Vector3d SoftTissue::feel(Touch& touch, const Vector3d& c_B, double radius,
                          bool sucks) const noexcept {
  Vector3d force = Vector3d::Zero();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    force += press(parts_[i], touch.parts_[i], c_B, radius, sucks).force;
  }
  return force;
}

SoftTissue::PressResult SoftTissue::press(const Part& part, TouchedPart& touched,
                                          const Vector3d& c_B, double radius,
                                          bool sucks) const noexcept {
  SurfaceDepth::LocalTissue here{};
  touched.dent = {};
  const bool near = part.depth.at(c_B, here);
  const double depth = near ? radius - here.distance : 0.0;
  const bool holds = touched.state == State::kHeld && sucks;
  if (!near || (depth <= 0.0 && !holds)) {
    touched.state = State::kFree;
    return {};
  }
  if (touched.state == State::kInHole || touched.state == State::kUnfelt) {
    return {};
  }
  const double slope = here.gradient.norm();
  const Vector3d place = c_B - here.distance / std::max(slope, kWayOut) * here.gradient;
  if (holed(part.label, place)) {
    touched.state = State::kInHole;
    return {};
  }
  const Vector3d force = part.parameters.stiffness * depth * here.gradient;
  const double size = force.norm();
  const bool was_touched = touched.state == State::kPressed || touched.state == State::kHeld;
  const bool turned = was_touched && here.gradient.dot(touched.way_out) < 0.0;
  const bool through = here.distance < 0.5 * part.depth.spacing() && (slope < kWayOut || turned);
  touched.way_out = here.gradient;
  if (size >= part.parameters.tears_at || through) {
    touched.state = State::kInHole;
    return {force, true, {part.label, depth <= 0.0, false, size, std::abs(depth), place}};
  }
  if (depth <= 0.0 && size > part.parameters.suction) {
    touched.state = State::kFree;  // it comes off the tube
    return {};
  }
  touched.state = sucks ? State::kHeld : State::kPressed;
  touched.dent = {part.label, place, here.gradient.stableNormalized(), depth, radius};
  return {force};
}

Dent SoftTissue::deepest(const Touch& touch) noexcept {
  Dent deepest;
  for (const TouchedPart& part : touch.parts_) {
    if (std::abs(part.dent.depth) > std::abs(deepest.depth)) {
      deepest = part.dent;
    }
  }
  return deepest;
}

bool SoftTissue::holed(std::uint8_t label, const Vector3d& place) const noexcept {
  return std::any_of(holes_.begin(), holes_.end(), [&](const Hole& hole) {
    return hole.label == label && (place - hole.place).squaredNorm() < hole.radius * hole.radius;
  });
}

void SoftTissue::tear(const Tear& tear, double radius) noexcept {
  tears_[tear_count_++] = tear;
  if (holes_.size() < kMostHoles) {
    holes_.push_back({tear.place_B, radius, tear.label});
  }
}

double SoftTissue::distance(const Vector3d& p_B) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const Part& part : parts_) {
    SurfaceDepth::LocalTissue here{};
    if (part.depth.at(p_B, here)) {
      least = std::min(least, here.distance);
    }
  }
  return least;
}

bool SoftTissue::in_hole() const noexcept {
  return std::any_of(own_.parts_.begin(), own_.parts_.end(),
                     [](const TouchedPart& part) { return part.state == State::kInHole; });
}

}  // namespace haptrial::bone
