#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/bone/data/volume_source.h"
#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// A structure as a mesh beside the scan, in millimetres.
struct MeshStructure {
  std::string name;            // as structure_named() takes it
  std::filesystem::path file;  // .stl, .obj or .ply
  /// The file's axes are RAS and not LPS; by default as the file says ("SPACE=RAS", as 3D Slicer
  /// writes), else LPS.
  std::optional<bool> ras;
};

/// The label of a structure's name in a bone; a new one where there is none.
/// @throws InputError where all 255 are taken.
std::uint8_t label_for(const Structure& structure, BoneModel& model);

/// Voxels whose centres lie in a mesh become a structure, of density 1, whatever they held: by the
/// generalized winding number where the mesh is open (voxelize.h). A note says what of it is lost.
/// @param box   what was asked for of the scan, in B [m]; nothing is noted of a mesh across it
/// @param X_PB  from B to LPS
/// @throws InputError where the file is no mesh; where no voxel's centre lies in it, with both
/// boxes
void add_mesh(const MeshStructure& added, const std::optional<Eigen::AlignedBox3d>& box,
              const Eigen::Affine3d& X_PB, BoneModel& model,
              const geometry::WorkReport& report = {});

/// Voxels take the segment at their centre: its structure with density 1; in a segment of plain
/// bone the density that they have, at least the lowest of bone. Where a segment is plain bone,
/// what lies in no segment becomes empty: the segmentation says what is bone. Notes say what of a
/// segment is lost.
/// @param segments    one value per voxel, a number of `structures`, places in LPS
/// @param box         what was asked for of the scan, in B [m]; outside of it nothing is lost
/// @param X_PB        from B to LPS
/// @throws InputError where no voxel lies in a segment, named by `file`.
void add_segments(const std::string& file, const SourceVolume& segments,
                  const std::vector<Structure>& structures,
                  const std::optional<Eigen::AlignedBox3d>& box, const Eigen::Affine3d& X_PB,
                  BoneModel& model);

}  // namespace haptrial::bone
