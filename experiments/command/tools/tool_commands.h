#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/command/mesh_command.h"

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

/// The subcommands of haptrial mesh.
struct MeshOptions {
  MeshInput input;
  std::string out;      // new file; its ending says the format
  std::string shape;    // make: sphere, torus, gear, rough
  std::string picture;  // new .png; empty: none
  std::string up{"y"};  // of pictures: x, y, z
  double weld{0.0};     // repair [m]
  VoxelizeOptions voxels;
  bool everywhere{false};  // distance: outside voxels too
  std::string points;      // distance: new volume of nearest points; empty: none
  bool overwrite{false};
};
int mesh_make(const MeshOptions& options);
int mesh_info(const MeshOptions& options);
int mesh_repair(const MeshOptions& options);
int mesh_voxelize(const MeshOptions& options);
int mesh_distance(const MeshOptions& options);
int mesh_tetrahedralize(const MeshOptions& options);

/// The subcommands of haptrial bone.
struct BoneOptions {
  std::string in;                    // bone, volume, or folder with a DICOM series
  std::string out;                   // new file (.nrrd)
  std::string shape;                 // make: temporal, mandible
  std::string seed{"1"};             // make
  std::optional<double> spacing;     // [mm]
  std::string as{"auto"};            // auto, labels, grey
  std::string threshold;             // of grey volumes: a number, or auto
  std::optional<double> dense;       // of grey volumes: the number of bone with density 1
  std::string labels;                // names of labels (.toml)
  std::vector<std::string> without;  // names of structures that are left out
  bool mirror{false};                // left and right are exchanged
  std::optional<double> max_memory;  // [GB]
  bool overwrite{false};
};
int bone_info(const BoneOptions& options);
int bone_make(const BoneOptions& options);

/// A picture of a bone off screen.
struct BonePictureOptions {
  std::string in;
  std::string out;                   // new .png
  std::vector<std::string> without;  // names of structures that are left out
  std::vector<std::string> drill;    // strokes: see experiments/command/tools/bone_carving.h
  std::vector<std::string> cut;      // planes
  bool spare{false};                 // nothing but bone is drilled or cut
  std::vector<double> from{};        // towards the eye; default: outside_view()
  std::vector<double> at;            // what is in the middle [mm]; default: the bone's
  double zoom{1.0};
  std::string burr;              // from its centre to a place on its handle
  std::optional<double> stereo;  // between the eyes [mm]
  int width{1280};               // [px]
  int height{720};
  std::optional<double> max_memory;  // [GB]
  bool overwrite{false};
};
int bone_picture(const BonePictureOptions& options);

/// From a scan to a bone, and from a bone back to other programs.
struct BoneImportOptions : BoneOptions {
  std::vector<double> crop;             // x0, x1, y0, y1, z0, z1 [mm]
  std::vector<double> around;           // x, y, z, edge of a cube about them [mm]
  std::string segmentation;             // of the scan (.seg.nrrd, .nii.gz)
  std::vector<std::string> structures;  // NAME=FILE of a mesh
  std::string mesh_axes{"auto"};        // auto, lps, ras
  bool largest{false};                  // of the parts of plain bone
  std::optional<double> fill;           // holes up to this volume [mm3]
  std::string histogram;                // .png or .svg
};
int bone_import(const BoneImportOptions& options);

struct BoneStructuresOptions : BoneOptions {  // with `out`: a copy under the names of `labels`
  std::string table;                          // new .toml to name structures by; empty: none
};
int bone_structures(const BoneStructuresOptions& options);

struct SpectrumOptions {
  std::string file;              // a recording
  std::string out;               // table of spectra (.toml); empty: only print
  std::string burr{"cutting"};   // diamond, cutting
  std::string level{"typical"};  // of the table; "free": in the air
  double force{0.0};             // of a level in contact [N]
  int peaks{24};
  int segment{0};       // samples; 0: 40 ms or more
  bool add{false};      // to the table that is there
  std::string wav;      // new sound from the peaks; empty: none
  std::string picture;  // new .png or .svg; empty: none
  bool overwrite{false};
};
int spectrum(const SpectrumOptions& options);

}  // namespace haptrial::experiments
