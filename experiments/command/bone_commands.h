#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/command/commands.h"

namespace haptrial::experiments {

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

struct BoneExportOptions {
  std::string in;            // bone or session (.h5)
  std::string out;           // new .nrrd, .stl, .obj, .ply or .off
  std::optional<int> trial;  // of a session; default: the first
  std::string structure;     // of a mesh; empty: the whole surface
  bool ras{false};           // axes of a mesh: else LPS
  bool overwrite{false};
};
int bone_export(const BoneExportOptions& options);

struct BonePlaceOptions {
  std::string definition;
  std::string out;  // new .png
  int bone{1};      // of the definition's, from 1
  bool overwrite{false};
};
int bone_place(const BonePlaceOptions& options);

struct BonePageOptions {
  std::vector<std::string> sessions;  // of bone drilling (.h5), of one participant
  std::vector<std::string> experts;   // sessions to compare with
  std::string study;                  // folder of sessions; empty: none
  std::string out;                    // new .html
  std::optional<int> trial;           // default: all
  bool overwrite{false};
};
int bone_page(const BonePageOptions& options);

struct BoneSafeOptions {
  std::vector<std::string> experts;  // sessions to learn from (.h5)
  std::string study;                 // folder of sessions; empty: none
  std::string out;                   // new .toml
  bool overwrite{false};
};
int bone_safe(const BoneSafeOptions& options);

}  // namespace haptrial::experiments
