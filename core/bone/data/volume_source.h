#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/big_array.h"
#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// A file's description of the volume in it, in metres and in the frame of the patient (LPS: x to
/// the left, y to the back, z up).
struct VolumeHead {
  std::array<std::int32_t, 3> size{0, 0, 0};  // voxels along i, j, k, i fastest
  int components{1};  // values of a voxel, side by side: 1, 2, or the layers of a segmentation
  Eigen::Matrix3d steps{Eigen::Matrix3d::Identity()};  // columns: one voxel along i, j, k [m]
  Eigen::Vector3d origin{Eigen::Vector3d::Zero()};     // centre of voxel (0, 0, 0) [m]
  bool labels{false};                                  // the file says that they are
  bool hounsfield{false};                              // likewise
  std::map<std::string, std::string> keys;             // key/values of the file
  std::string format;                                  // "NRRD", "NIfTI", "DICOM, 240 slices"
  std::vector<std::string> notes;                      // as of BoneModel

  std::size_t count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
};

struct SourceVolume {
  VolumeHead head;
  BigArray<float> values;  // count() x components
};

/// Called before memory is taken: what for, and how many bytes; throws InputError to refuse.
using Room = std::function<void(const std::string& what, double bytes)>;
/// Refuses what the system does not have.
void check_system_memory(const std::string& what, double bytes);

/// Reads a volume in a process of its own, so that a library which crashes, hangs or takes all
/// memory over a damaged file costs a sentence. Values that are not finite become the smallest
/// finite one; a note says how many, but for the padding of DICOM.
/// @throws InputError, RunError, geometry::Cancelled
SourceVolume read_volume(const std::filesystem::path& file, const Room& room,
                         const geometry::WorkReport& report);

using LabelVolumes = std::array<double, 256>;  // of each label [m3]

/// Volumes of the labels of a bone.
LabelVolumes volumes_of(const BoneModel& model);
/// Volumes of the labels of a file, of which only voxels count whose centres lie in a box.
/// @param labels  whole numbers from 0 to 255, one for each voxel of the head
/// @param X_PB    from B, in which the box lies, to LPS
LabelVolumes volumes_of(std::span<const float> labels, const VolumeHead& head,
                        const std::optional<Eigen::AlignedBox3d>& box, const Eigen::Affine3d& X_PB);

/// Adds a note to a bone if it holds less than 80 % of what a file has of a structure: with coarser
/// voxels or at the border of the scan. The sentence has both volumes.
/// @param before, after  in the file and in the bone [m3]
void note_loss(const std::string& file, const Structure& structure, double before, double after,
               BoneModel& model);
/// Adds such a note for each label of a bone that lost as much.
void note_losses(const std::string& file, const LabelVolumes& before, BoneModel& model);

}  // namespace haptrial::bone
