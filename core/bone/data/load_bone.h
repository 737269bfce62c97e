#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/bone/data/added_structures.h"
#include "core/bone/data/grey_bone.h"
#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// Meaning of the numbers of a volume.
enum class VolumeKind {
  kAuto,    // labels where the file says so, or holds few different small whole numbers
  kLabels,  // each number names a structure
  kGrey,    // CT: bone is what lies above a threshold
};

struct LoadOptions {
  VolumeKind kind{VolumeKind::kAuto};
  /// Edge of the voxels > 0 [m]. Default: 0.5 mm for grey volumes; labels keep their own where it
  /// is the same along every axis, else the smallest.
  std::optional<double> spacing;
  /// The least number of a grey volume that is bone: 300 in Hounsfield units; for other units it
  /// must be given, or asked for by `find_threshold`.
  std::optional<double> threshold;
  bool find_threshold{false};        // by the histogram (Otsu 1979, three classes)
  std::optional<double> dense;       // the number of bone with density 1 > threshold; 1500 HU
  std::string label_file;            // names of labels (.toml); empty: as the file names them
  bool mirror{false};                // left and right are exchanged
  std::vector<std::string> without;  // names of structures that are left out
  std::optional<Eigen::AlignedBox3d> crop;  // only voxels whose centres lie in it, in B [m]
  std::filesystem::path segments;           // a segmentation of the scan; empty: none
  std::vector<MeshStructure> meshes;        // structures that are added, in this order
  std::function<void(const GreyFindings&)> findings;  // of grey volumes; also before a refusal
  /// Called before memory is taken: what for, and how many bytes; throws InputError to refuse.
  /// Default: refuses what the system does not have.
  std::function<void(const std::string& what, double bytes)> room;
};

/// Reads a bone: one that save_bone() wrote, or anything import can read: NRRD (.nrrd, .nhdr;
/// .seg.nrrd with any number of layers), NIfTI (.nii, .nii.gz), or a folder with one DICOM series.
///
/// The frame B is that of the patient, in metres: x to the left, y to the back, z up (LPS). A
/// volume that is turned by less than 1 degree against these axes, with voxels that are cubes to
/// a quarter of a voxel at its corners, is taken as it is and its own axes are B's; others are
/// resampled. Source: Morris 2006, §3.2.1; docs/algorithms/bone-data.md.
///
/// Files are read by a process of their own: a library that crashes on a damaged one ends that.
/// @throws InputError in one sentence for a file that cannot be a bone; RunError where the system
/// gives no process or memory; geometry::Cancelled.
/// Any thread but the servo thread.
BoneModel load_bone(const std::filesystem::path& file, const LoadOptions& options = {},
                    const geometry::WorkReport& report = {});

}  // namespace haptrial::bone
