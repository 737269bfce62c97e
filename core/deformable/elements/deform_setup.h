#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/elements/elastic_body.h"
#include "core/deformable/elements/region.h"

namespace haptrial::deformable {

/// Source of a body: exactly one of mesh, tetrahedra and block.
struct BodySource {
  std::filesystem::path mesh;                      // surface, to be filled with voxels; empty: none
  std::filesystem::path tetrahedra;                // TetGen's .node with .ele; empty: none
  std::optional<Eigen::Vector3d> block;            // sides [m]
  double scale{1.0};                               // metres to the file's unit
  Eigen::Vector3d shift{Eigen::Vector3d::Zero()};  // added to every vertex [m]
  int resolution{20};                              // cubes along the longest axis
};

struct NamedMaterial {
  std::string name;
  Material material;
  std::string region;  // of the tetrahedra whose middles it has; empty: of all others
};

/// Force on a region.
struct RegionForce {
  std::string region;
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // in sum, equal on its vertices [N]
};
struct RegionPressure {
  std::string region;
  double pressure{};  // against its outer faces, at rest [Pa]
};
struct RegionMove {
  std::string region;
  Eigen::Vector3d by{Eigen::Vector3d::Zero()};  // [m]
};

struct SetupLoad {
  std::string name;
  std::vector<std::string> held;  // regions
  std::vector<RegionForce> forces;
  std::vector<RegionPressure> pressures;
  std::vector<RegionMove> moved;
  std::string reference;  // displacements by another program (.csv); empty: by our elements
  std::string session;    // recorded contacts that act beside the rest; empty: none
  std::string object;     // of the session; empty: the one that was touched
  int trial{0};           // of the session; 0: the first in which it was touched
  int touches{5};         // moments of the session, each a load of its own
  bool unseen{false};     // calibration never sees it and is judged by it
};

/// A body, its materials and its loads, as a file states them
/// (docs/guide-deformable.md).
struct DeformSetup {
  std::filesystem::path file;
  BodySource source;
  std::vector<NamedMaterial> materials;
  Law law{Law::kNeoHookean};
  VolumeForm volume{VolumeForm::kPatches};
  double tolerance{1e-8};  // of the statics
  std::map<std::string, Region> regions;
  std::vector<SetupLoad> loads;  // in the order of their names
  std::string text;              // of the file

  /// A path of the file, which may be relative to it.
  std::filesystem::path path_of(const std::filesystem::path& name) const;
};

/// @throws InputError with a sentence for every problem.
DeformSetup read_setup(const std::filesystem::path& file);

/// The material of each tetrahedron, and the materials.
/// A tetrahedron in the regions of several materials has the last of these.
/// @throws InputError as check_material(), for a region that has no tetrahedron and for more than
/// 256 materials.
Elasticity elasticity_of(const DeformSetup& setup, const geometry::TetMesh& body);

/// @throws InputError naming the load and the region for what is on no vertex or no outer face, for
/// a vertex in two regions that are moved differently, and as check_load().
LoadCase load_case_of(const DeformSetup& setup, const SetupLoad& load,
                      const geometry::TetMesh& body);

}  // namespace haptrial::deformable
