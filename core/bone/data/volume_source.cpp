#include "core/bone/data/volume_source.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

namespace haptrial::bone {

LabelVolumes volumes_of(const BoneModel& model) {
  LabelVolumes volumes{};
  for (const std::uint8_t label : model.labels) {
    volumes[label] += std::pow(model.grid.spacing, 3);
  }
  return volumes;
}

LabelVolumes volumes_of(std::span<const float> labels, const VolumeHead& head,
                        const std::optional<Eigen::AlignedBox3d>& box,
                        const Eigen::Affine3d& X_PB) {
  const double voxel = std::abs(head.steps.determinant());
  const Eigen::Affine3d X_BP = X_PB.inverse();
  LabelVolumes volumes{};
  std::size_t at = 0;
  for (int k = 0; k < head.size[2]; ++k) {
    for (int j = 0; j < head.size[1]; ++j) {
      for (int i = 0; i < head.size[0]; ++i, ++at) {
        const auto label = static_cast<std::uint8_t>(labels[at]);
        const Eigen::Vector3d p_P = head.origin + head.steps * Eigen::Vector3d(i, j, k);
        if (label != 0 && (!box || box->contains(X_BP * p_P))) {
          volumes[label] += voxel;
        }
      }
    }
  }
  return volumes;
}

void note_loss(const std::string& file, const Structure& structure, double before, double after,
               BoneModel& model) {
  constexpr double kMostOf = 0.8;  // thin structures differ by less between two grids
  if (!(after < kMostOf * before)) {
    return;
  }
  constexpr double kCubicMillimetres = 1e9;
  model.notes.push_back(fmt::format(
      "{}{} is lost{}: {:.1f} mm3 in {}, {} here", structure.name,
      structure.vital ? ", a vital structure," : "", after > 0.0 ? " in part" : "",
      kCubicMillimetres * before, file,
      after > 0.0 ? fmt::format("{:.1f} mm3", kCubicMillimetres * after) : std::string("none")));
}

void note_losses(const std::string& file, const LabelVolumes& before, BoneModel& model) {
  const LabelVolumes after = volumes_of(model);
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    note_loss(file, model.structures[label], before[label], after[label], model);
  }
}

}  // namespace haptrial::bone
