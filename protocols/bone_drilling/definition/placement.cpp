#include "protocols/bone_drilling/definition/placement.h"

#include <fmt/format.h>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/bone/data/ear_side.h"
#include "core/subject/drilling/cavity_chart.h"

namespace haptrial::protocols {
namespace {

constexpr const char* kRightEar = "surgeon's view of a right ear";
constexpr const char* kLeftEar = "surgeon's view of a left ear";

/// Outwards up, the back of the head towards the participant. @param left  x goes outwards there
Eigen::Matrix3d turn_of_ear(bool left) {
  Eigen::Matrix3d turn;
  turn.col(0) = left ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  turn.col(1) = Eigen::Vector3d::UnitZ();
  turn.col(2) = turn.col(0).cross(turn.col(1));
  return turn;
}

void read_axes(Table& table, BonePlacement& placement) {
  for (const char* key : {"x_to", "y_to"}) {
    table.describe(
        {key, fmt::format("Direction of the bone's {} axis in the world", key[0]), "place says"});
    if (table.has("place") && table.has(key)) {
      table.reject(key, "says how the bone lies, as place does; write one of the two");
      read_vector(table, key, {-1.0, 1.0}, "");
    }
  }
  if (table.has("place")) {
    return;
  }
  const Eigen::Vector3d x = read_vector(table, "x_to", {-1.0, 1.0}, "");
  const Eigen::Vector3d y = read_vector(table, "y_to", {-1.0, 1.0}, "");
  constexpr double kSquare = 1e-3;  // of the angle between them [rad]
  if (!(x.norm() > 0.0)) {
    table.reject("x_to", "is zero; write the direction in the world of the bone's x axis");
  } else if (!(y.norm() > 0.0) || std::abs(x.normalized().dot(y.normalized())) > kSquare) {
    table.reject("y_to",
                 "is not square to x_to; write the direction in the world of the bone's y axis");
  } else {
    placement.turn.col(0) = x.normalized();
    placement.turn.col(2) = x.cross(y).normalized();
    placement.turn.col(1) = placement.turn.col(2).cross(placement.turn.col(0));
  }
}

std::string named(const bone::BoneModel& bone) {
  return bone.name.empty() ? "the bone" : bone.name;
}

/// Advice on a better placement.
std::string advice(const bone::BoneModel& bone) {
  const auto side = bone::ear_side(bone);
  if (!side) {
    return "turn it with x_to and y_to in [bone]";
  }
  const bool left = *side == bone::EarSide::kLeft;
  return fmt::format("it is a {} ear: write place = \"{}\" in [bone], without x_to and y_to{}",
                     left ? "left" : "right", left ? kLeftEar : kRightEar,
                     left ? ", or mirror = true" : "");
}

}  // namespace

Eigen::Isometry3d pose_of(const BonePlacement& placement, const geometry::VoxelGrid& grid) {
  const Eigen::Vector3d middle = 0.5 * (grid.centre(0, 0, 0) + grid.centre(grid.last()));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = placement.turn;
  pose.translation() = placement.centre - placement.turn * middle;
  return pose;
}

const Schema<BonePlacement>& placement_schema() {
  using P = BonePlacement;
  static const auto schema =
      Schema<P>()
          .vector("centre", &P::centre, {-1.0, 1.0}, "m", "Place in the world of the bone's middle")
          .required()
          .custom("place",
                  "Pose of an ear, instead of x_to and y_to: the ear's side up, the back of the "
                  "head towards the participant",
                  [](Table& table, const std::string& key, P& p) {
                    p.left_ear = table.choice(key, {kRightEar, kLeftEar}) == kLeftEar;
                    p.turn = turn_of_ear(p.left_ear);
                  })
          .otherwise("x_to and y_to say")
          .check(read_axes);
  return schema;
}

void check_placement(const BonePlacement& placement, const bone::BoneModel& bone,
                     const Camera& camera, const subject::CavityParameters* cavity) {
  const auto directions = bone::ear_directions(bone);
  if (!directions) {
    return;
  }
  const Eigen::Vector3d outwards = placement.turn * directions->outwards;
  if (!(outwards.dot(camera.eye - camera.target) > 0.0)) {
    throw InputError(
        fmt::format("{} lies so that the camera would look at it from inside the "
                    "skull; {}",
                    named(bone), advice(bone)));
  }
  if (cavity != nullptr && !(outwards.dot(cavity->inward) < 0.0)) {
    throw InputError(fmt::format("{} lies so that the cavity would begin inside the skull; {}",
                                 named(bone), advice(bone)));
  }
  const bool wrong_side =
      cavity != nullptr &&
      placement.turn.col(0).dot(outwards) * (placement.left_ear ? -1.0 : 1.0) > 0.0;
  if (wrong_side) {
    throw InputError(fmt::format("{} is not the ear that the cavity is told for; {}", named(bone),
                                 advice(bone)));
  }
  const Eigen::Vector3d eye = pose_of(placement, bone.grid).inverse() * camera.eye;
  const bone::Voxel at = bone.grid.nearest(eye);
  if (bone.grid.contains(at) && bone.labels[bone.grid.index(at)] != 0) {
    throw InputError(
        fmt::format("{}: the camera's eye would begin in the bone; move camera.eye "
                    "outwards",
                    named(bone)));
  }
}

}  // namespace haptrial::protocols
