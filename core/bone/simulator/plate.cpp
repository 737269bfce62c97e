#include "core/bone/simulator/plate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/bone/model/voxel_walk.h"
#include "core/geometry/files/mesh_io.h"

namespace haptrial::bone {
namespace {

using Eigen::Vector3d;

void check(const PlateParameters& parameters) {
  const bool good = parameters.samples >= 1 && parameters.samples <= kMaxAnchors &&
                    parameters.extrusion >= 0.0 && parameters.reach > 0.0 &&
                    parameters.stiffness >= 0.0 && std::isfinite(parameters.extrusion) &&
                    std::isfinite(parameters.reach) && std::isfinite(parameters.stiffness);
  if (!good) {
    throw std::invalid_argument(fmt::format(
        "plate: samples must be from 1 to {}, reach above 0, extrusion and stiffness not below",
        kMaxAnchors));
  }
}

/// The vector area of a triangle.
Vector3d area(const geometry::Mesh& mesh, const geometry::Triangle& t) {
  const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
  return 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
}

/// Places to feel at: each vertex with the normals of its sides. Triangles around a vertex that
/// turn by less than 45 degrees from the first of them make one side.
std::vector<PlateSample> candidates(const geometry::Mesh& mesh) {
  std::vector<std::vector<Vector3d>> sides(mesh.vertices.size());  // sums of vector areas
  for (const geometry::Triangle& t : mesh.triangles) {
    const Vector3d normal = area(mesh, t);
    for (const std::int32_t corner : t) {
      auto& all = sides[static_cast<std::size_t>(corner)];
      const auto same = [&](const Vector3d& side) {
        return side.dot(normal) >= std::sqrt(0.5) * side.norm() * normal.norm();
      };
      const auto side = std::find_if(all.begin(), all.end(), same);
      if (side != all.end()) {
        *side += normal;
      } else {
        all.push_back(normal);
      }
    }
  }
  std::vector<PlateSample> places;
  for (std::size_t v = 0; v < sides.size(); ++v) {
    for (const Vector3d& side : sides[v]) {
      if (side.norm() > 0.0) {
        places.push_back({mesh.vertices[v], side.normalized()});
      }
    }
  }
  return places;
}

/// Halves every edge: four triangles of one.
geometry::Mesh subdivided(const geometry::Mesh& mesh) {
  geometry::Mesh fine;
  for (const geometry::Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    const auto first = static_cast<std::int32_t>(fine.vertices.size());
    for (std::size_t i = 0; i < 3; ++i) {
      fine.vertices.push_back(at(i));
      fine.vertices.push_back(0.5 * (at(i) + at((i + 1) % 3)));
    }
    for (const geometry::Triangle& part :
         {geometry::Triangle{0, 1, 5}, {1, 2, 3}, {5, 3, 4}, {1, 3, 5}}) {
      fine.triangles.push_back({part[0] + first, part[1] + first, part[2] + first});
    }
  }
  return fine;
}

/// Each next sample is the one farthest from all before; two sides of an edge count as `apart` away
/// from each other.
std::vector<PlateSample> spread(const std::vector<PlateSample>& places, std::size_t count,
                                double apart) {
  std::vector<double> nearest(places.size(), std::numeric_limits<double>::infinity());
  std::vector<PlateSample> chosen;
  std::size_t next = 0;
  while (chosen.size() < std::min(count, places.size())) {
    chosen.push_back(places[next]);
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double distance =
          (places[i].point - chosen.back().point).squaredNorm() +
          0.25 * apart * apart * (places[i].normal - chosen.back().normal).squaredNorm();
      nearest[i] = std::min(nearest[i], distance);
      farthest = nearest[i] > nearest[farthest] ? i : farthest;
    }
    next = farthest;
  }
  return chosen;
}

/// A piece, and what is about to leave it.
struct Bone {
  const BoneVolume& volume;
  const BoneVolume* leaving;

  bool holds(const Voxel& voxel) const noexcept {
    return volume.density(voxel) > 0.0F || (leaving != nullptr && leaving->density(voxel) > 0.0F);
  }
};

/// How far a segment of `length` that begins in bone runs before it leaves the bone; nothing where
/// it does not.
std::optional<double> way_out(const Bone& bone, const Vector3d& from_B, const Vector3d& to_B,
                              double length) noexcept {
  double out = 0.0;
  bool left = false;
  walk_voxels(bone.volume.grid(), from_B, to_B, [&](const Voxel& voxel, double in, double end) {
    left = !bone.holds(voxel);
    out = left ? in : end;
    return !left;
  });
  // The grid ends before the segment where it leaves that too.
  left = left || out < 1.0;
  return left ? std::optional(out * length) : std::nullopt;
}

Voxel voxel_of(const geometry::VoxelGrid& grid, const Vector3d& p_B) {
  const Eigen::Array3d place = ((p_B - grid.origin) / grid.spacing).array() + 0.5;
  if (!(place.abs().maxCoeff() < 1e6)) {
    return Voxel(-1, -1, -1);
  }
  return place.floor().cast<int>();
}

}  // namespace

const Schema<PlateParameters>& plate_schema() {
  using P = PlateParameters;
  static const auto schema =
      Schema<P>()
          .integer("samples", &P::samples, 1, kMaxAnchors,
                   "Number of points on the plate at which bone is felt")
          .required()
          .number("extrusion", &P::extrusion, {0.0, 0.01}, "m",
                  "Distance by which the points that feel bone stand out of the plate's surface")
          .required()
          .number("reach", &P::reach, {0.0, 0.1, true}, "m",
                  "Greatest depth in bone at which a point of the plate still pushes back")
          .required()
          .number("stiffness", &P::stiffness, {0.0, 1e5}, "N/m",
                  "Stiffness of the contact of one point of the plate with bone")
          .required();
  return schema;
}

PlateModel::PlateModel(std::string name, geometry::Mesh mesh, const PlateParameters& parameters,
                       std::vector<Eigen::Isometry3d> holes)
    : name_(std::move(name)),
      mesh_(std::move(mesh)),
      parameters_(parameters),
      holes_(std::move(holes)) {
  check(parameters);
  double total = 0.0;
  Eigen::AlignedBox3d box;
  for (const geometry::Triangle& t : mesh_.triangles) {
    total += area(mesh_, t).norm();
    for (const std::int32_t corner : t) {
      box.extend(mesh_.vertices[static_cast<std::size_t>(corner)]);
    }
  }
  if (!(total > 0.0 && std::isfinite(total))) {
    throw std::invalid_argument(fmt::format("plate {}: the mesh has no area", name_));
  }
  const auto wanted = static_cast<std::size_t>(parameters.samples);
  geometry::Mesh fine = mesh_;
  std::vector<PlateSample> places = candidates(fine);
  for (int round = 0; round < 8 && places.size() < 4 * wanted; ++round) {
    fine = subdivided(fine);
    places = candidates(fine);
  }
  samples_ = spread(places, wanted, std::sqrt(total / parameters.samples));
  for (PlateSample& sample : samples_) {
    sample.point += parameters.extrusion * sample.normal;
  }
}

PlateModel PlateModel::load(const std::filesystem::path& file, double unit,
                            const PlateParameters& parameters) {
  geometry::Mesh mesh = geometry::read_mesh(file);
  for (Vector3d& vertex : mesh.vertices) {
    vertex *= unit;
  }
  try {
    return PlateModel(file.stem().string(), std::move(mesh), parameters);
  } catch (const std::invalid_argument&) {
    check(parameters);  // rethrows what is not the file's
    throw InputError(fmt::format("{} has no triangle with an area; choose a mesh with a surface",
                                 file.string()));
  }
}

std::optional<double> way_out(const BoneWorld& world, int piece, const Vector3d& from_B,
                              const Vector3d& to_B) noexcept {
  const Bone bone{world.volume(piece), world.leaving(piece)};
  if (!bone.holds(voxel_of(bone.volume.grid(), from_B))) {
    return std::nullopt;
  }
  return way_out(bone, from_B, to_B, (to_B - from_B).norm());
}

PlateContact press(const PlateModel& plate, const Eigen::Isometry3d& pose_WP,
                   const BoneWorld& world) noexcept {
  PlateContact contact;
  if (!pose_WP.matrix().allFinite()) {
    return contact;
  }
  const double reach = plate.parameters().reach;
  for (int piece = 0; piece < world.pieces(); ++piece) {
    if (!world.is_born(piece)) {
      continue;  // felt with its parent
    }
    const Bone bone{world.volume(piece), world.leaving(piece)};
    const Eigen::Isometry3d pose_BP = world.pose(piece).inverse() * pose_WP;
    Vector3d force_P = Vector3d::Zero();
    Vector3d torque_P = Vector3d::Zero();
    for (const PlateSample& sample : plate.samples()) {
      const Vector3d p_B = pose_BP * sample.point;
      if (!bone.holds(voxel_of(bone.volume.grid(), p_B))) {
        continue;
      }
      ++contact.touching;
      contact.pieces |= PieceSet{1} << piece;
      const Vector3d to_B = pose_BP * (sample.point - reach * sample.normal);
      const double depth = way_out(bone, p_B, to_B, reach).value_or(0.0);
      const Vector3d push = -plate.parameters().stiffness * depth * sample.normal;
      force_P += push;
      torque_P += sample.point.cross(push);
    }
    contact.force += pose_WP.linear() * force_P;
    contact.torque += pose_WP.linear() * torque_P;
  }
  return contact;
}

int attach(const PlateModel& plate, int model, const Eigen::Isometry3d& pose_WP,
           BoneWorld& world) noexcept {
  if (!pose_WP.matrix().allFinite()) {
    return -1;
  }
  std::array<Voxel, kMaxAnchors> anchors;
  std::size_t count = 0;
  for (const PlateSample& sample : plate.samples()) {
    for (int piece = 0; piece < world.pieces() && count < anchors.size(); ++piece) {
      const BoneVolume& volume = world.volume(piece);
      const Voxel voxel =
          voxel_of(volume.grid(), world.pose(piece).inverse() * (pose_WP * sample.point));
      if (volume.density(voxel) > 0.0F) {
        anchors[count++] = voxel;
        break;
      }
    }
  }
  return world.attach_plate(model, std::span(anchors.data(), count), pose_WP);
}

}  // namespace haptrial::bone
