#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/bone/model/world.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::bone {

/// Place at which a plate feels for bone, in the plate's frame P.
struct PlateSample {
  Eigen::Vector3d point;   // on the surface, pushed out along the normal [m]
  Eigen::Vector3d normal;  // of the surface, outwards, unit length
};

struct PlateParameters {
  int samples{100};           // from 1 to kMaxAnchors
  double extrusion{0.25e-3};  // how far samples lie outside of the surface >= 0 [m]
  double reach{6e-3};         // how far a ray looks for a way out of the bone > 0 [m]
  double stiffness{40.0};     // of one sample >= 0 [N/m]
};

/// The keys of a plate's [contact].
const Schema<PlateParameters>& plate_schema();

/// A rigid thing that can be fixed to bone: a plate or a distractor. Its mesh is in the frame P,
/// which the tool that holds it carries; samples are vertices of the mesh, spread evenly, a vertex
/// on a sharp edge once for each side. Source: Morris 2006, §3.2.5, Figure 11.
class PlateModel {
 public:
  /// @throws std::invalid_argument for a mesh without an area, or parameters out of bounds.
  /// @param holes  for screws: their poses in P, on the side that lies on bone, z outwards
  PlateModel(std::string name, geometry::Mesh mesh, const PlateParameters& parameters = {},
             std::vector<Eigen::Isometry3d> holes = {});
  /// Reads OBJ, STL, PLY or OFF. @param unit  of the file [m]
  /// @throws InputError as geometry::read_mesh does, or where the mesh has no area.
  static PlateModel load(const std::filesystem::path& file, double unit = 1e-3,
                         const PlateParameters& parameters = {});

  const std::string& name() const noexcept { return name_; }
  const geometry::Mesh& mesh() const noexcept { return mesh_; }
  const std::vector<PlateSample>& samples() const noexcept { return samples_; }
  const PlateParameters& parameters() const noexcept { return parameters_; }
  const std::vector<Eigen::Isometry3d>& holes() const noexcept { return holes_; }

 private:
  std::string name_;
  geometry::Mesh mesh_;
  PlateParameters parameters_;
  std::vector<Eigen::Isometry3d> holes_;
  std::vector<PlateSample> samples_;
};

/// Contact of a plate with bone.
struct PlateContact {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};   // on the plate, in W [N]
  Eigen::Vector3d torque{Eigen::Vector3d::Zero()};  // about P's origin, in W [N m]
  int touching{0};                                  // samples in bone
  PieceSet pieces{0};                               // that they are in
};

/// The force on a plate that is held against the bone:
///
///     f = k Σ d_i (-n_i)
///
/// over the samples in bone, where d_i is how far the ray from sample i against its normal runs
/// before it leaves the bone. A ray that finds no way out within the reach says nothing.
/// Servo thread: no allocation, lock or throw.
PlateContact press(const PlateModel& plate, const Eigen::Isometry3d& pose_WP,
                   const BoneWorld& world) noexcept;

/// How far a ray that begins in the bone of a piece runs before it leaves it; nothing where it
/// begins beside it or does not leave it. Servo thread, as press().
/// @param piece         one that is born, felt with what is about to leave it
/// @param from_B, to_B  ends of the ray in the bone's frame [m]
std::optional<double> way_out(const BoneWorld& world, int piece, const Eigen::Vector3d& from_B,
                              const Eigen::Vector3d& to_B) noexcept;

/// Fixes a plate where it is to every piece that its samples are in.
/// @param model  the caller's number for the plate's model
/// @returns the number of the plate in the world; -1 where it touches nothing or there is no room.
/// Servo thread, as press().
int attach(const PlateModel& plate, int model, const Eigen::Isometry3d& pose_WP,
           BoneWorld& world) noexcept;

}  // namespace haptrial::bone
