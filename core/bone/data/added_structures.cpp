#include "core/bone/data/added_structures.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/parallel.h"
#include "core/bone/data/anatomy.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/volume/voxelize.h"

namespace haptrial::bone {
namespace {

constexpr float kLeastDensity = 51.0F / 255.0F;  // of bone at its threshold: grey_bone.h

std::string in_words(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d low = 1e3 * box.min();
  const Eigen::Vector3d high = 1e3 * box.max();
  return fmt::format("{:.1f} {:.1f} {:.1f} to {:.1f} {:.1f} {:.1f} mm", low.x(), low.y(), low.z(),
                     high.x(), high.y(), high.z());
}

Eigen::AlignedBox3d box_of(const geometry::VoxelGrid& grid) {
  return {grid.origin, grid.centre(grid.last())};
}

/// Label of the bone for each label of the segments.
std::array<std::uint8_t, 256> labels_for(const std::vector<Structure>& structures,
                                         BoneModel& model) {
  std::array<std::uint8_t, 256> labels{};
  for (std::size_t label = 1; label < structures.size(); ++label) {
    if (!structures[label].name.empty()) {
      labels[label] = label_for(structures[label], model);
    }
  }
  return labels;
}

/// Whether a mesh file's head says that it is in RAS, as 3D Slicer writes there.
bool says_ras(const std::filesystem::path& file) {
  return file_head(file, 1024).find("SPACE=RAS") != std::string::npos;
}

geometry::Mesh mesh_in_bone(const MeshStructure& structure, const Eigen::Affine3d& X_PB) {
  geometry::Mesh mesh = geometry::read_mesh(structure.file);
  const double sign = structure.ras.value_or(says_ras(structure.file)) ? -1.0 : 1.0;
  const Eigen::Vector3d to_lps = 1e-3 * Eigen::Vector3d(sign, sign, 1.0);
  const Eigen::Affine3d X_BP = X_PB.inverse();
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = X_BP * to_lps.cwiseProduct(vertex);
  }
  return mesh;
}

}  // namespace

std::uint8_t label_for(const Structure& structure, BoneModel& model) {
  std::vector<Structure>& all = model.structures;
  all.resize(std::max<std::size_t>(all.size(), 1));
  for (std::size_t label = 1; label < all.size(); ++label) {
    if (all[label].name == structure.name) {
      return static_cast<std::uint8_t>(label);
    }
  }
  constexpr std::size_t kLabels = 256;
  if (all.size() >= kLabels) {
    throw InputError(fmt::format("the bone has no label left for '{}'; allowed: 255 structures",
                                 structure.name));
  }
  all.push_back(structure);
  return static_cast<std::uint8_t>(all.size() - 1);
}

void add_mesh(const MeshStructure& added, const std::optional<Eigen::AlignedBox3d>& asked,
              const Eigen::Affine3d& X_PB, BoneModel& model, const geometry::WorkReport& report) {
  const geometry::Mesh mesh = mesh_in_bone(added, X_PB);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  const geometry::VoxelGrid part = grid_within(model.grid, box);
  std::size_t found = 0;
  const Structure structure = structure_named(
      added.name, static_cast<std::uint8_t>(model.structures.size() % 256));  // of its colour
  if (part.count() > 0) {
    const geometry::VoxelSolid solid = voxelize(mesh, part, geometry::fitting_rule(mesh), report);
    const std::uint8_t label = label_for(structure, model);
    const Eigen::Vector3i first =
        ((part.origin - model.grid.origin) / model.grid.spacing).array().round().cast<int>();
    std::size_t at = 0;
    for (int k = 0; k < part.size[2]; ++k) {
      for (int j = 0; j < part.size[1]; ++j) {
        for (int i = 0; i < part.size[0]; ++i, ++at) {
          if (solid.labels[at] != geometry::VoxelLabel::kInside) {
            continue;
          }
          const std::size_t voxel = model.grid.index(first.x() + i, first.y() + j, first.z() + k);
          model.labels[voxel] = label;
          if (!model.density.empty()) {
            model.density[voxel] = 1.0F;
          }
          ++found;
        }
      }
    }
  }
  if (found == 0) {
    throw InputError(
        fmt::format("{}: holds no voxel's centre; it spans {}, the bone {}; check unit (mm) and "
                    "axes (LPS or RAS), or choose smaller voxels",
                    added.file.string(), in_words(box), in_words(box_of(model.grid))));
  }
  if (!asked || asked->contains(box)) {
    note_loss(added.file.string(), structure, std::abs(geometry::signed_volume(mesh)),
              static_cast<double>(found) * std::pow(model.grid.spacing, 3), model);
  }
}

void add_segments(const std::string& file, const SourceVolume& segments,
                  const std::vector<Structure>& structures,
                  const std::optional<Eigen::AlignedBox3d>& asked, const Eigen::Affine3d& X_PB,
                  BoneModel& model) {
  const std::array<std::uint8_t, 256> labels = labels_for(structures, model);
  std::array<bool, 256> plain{};
  bool says_bone = false;
  for (std::size_t label = 1; label < structures.size(); ++label) {
    plain[label] = structures[label].name == kPlainBone;
    says_bone = says_bone || plain[label];
  }
  const VolumeHead& head = segments.head;
  const Eigen::Matrix3d to_voxels = head.steps.inverse();
  const Eigen::Matrix3d turn = to_voxels * X_PB.linear();
  const Eigen::Vector3d offset = to_voxels * (X_PB.translation() - head.origin);
  const geometry::VoxelGrid& grid = model.grid;
  std::atomic<std::size_t> found{0};
  const auto label_at = [&](const Eigen::Vector3d& p_B) -> std::size_t {
    const Eigen::Array3d at = (turn * p_B + offset).array().round();
    const Eigen::Array3d last(head.size[0] - 1, head.size[1] - 1, head.size[2] - 1);
    if ((at < 0.0).any() || (at > last).any()) {
      return 0;
    }
    const double voxel = at.x() + head.size[0] * (at.y() + head.size[1] * at.z());
    return static_cast<std::uint8_t>(segments.values[static_cast<std::size_t>(voxel)]);
  };
  parallel_for(static_cast<std::size_t>(grid.size[2]), threads_or_all(0), [&](std::size_t layer) {
    const auto k = static_cast<std::int32_t>(layer);
    std::size_t here = 0;
    std::size_t at = grid.index(0, 0, k);
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      for (std::int32_t i = 0; i < grid.size[0]; ++i, ++at) {
        const std::size_t segment = label_at(grid.centre(i, j, k));
        if (labels[segment] != 0) {
          ++here;
          model.labels[at] = labels[segment];
        } else if (says_bone) {
          model.labels[at] = 0;
        } else {
          continue;
        }
        if (!model.density.empty()) {
          float& density = model.density[at];
          density = model.labels[at] == 0 ? 0.0F
                    : plain[segment]      ? std::max(density, kLeastDensity)
                                          : 1.0F;
        }
      }
    }
    found += here;
  });
  if (found == 0) {
    Eigen::AlignedBox3d box;
    for (const double end : {0.0, 1.0}) {
      box.extend(head.origin +
                 end * head.steps *
                     Eigen::Vector3d(head.size[0] - 1.0, head.size[1] - 1.0, head.size[2] - 1.0));
    }
    throw InputError(
        fmt::format("{}: has no segment in the bone; it spans {}, the bone {}; choose the "
                    "segmentation of this scan",
                    file, in_words(box), in_words(box_of(grid))));
  }
  const LabelVolumes in_file = volumes_of(segments.values, head, asked, X_PB);
  LabelVolumes before{};
  for (std::size_t segment = 1; segment < labels.size(); ++segment) {
    before[labels[segment]] += in_file[segment];
  }
  note_losses(file, before, model);
}

}  // namespace haptrial::bone
