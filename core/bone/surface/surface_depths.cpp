#include "core/bone/surface/surface_depths.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/parallel.h"

namespace haptrial::bone {
namespace {

constexpr int kLargestReach = 250;  // voxels; its square fits 16 bits

/// Squared distance times 256 plus label: the least of two is the nearer one, of two as near the
/// one with the lower label.
using Key = std::uint32_t;
constexpr Key kNothing = 0xFFFFFFFF;
constexpr Key kLabels = 256;

Key moved(Key key, int by) {
  return key == kNothing ? kNothing : key + kLabels * static_cast<Key>(by * by);
}

/// The box around the voxels that show, and as far around it as the reach goes.
Eigen::AlignedBox3i box_of(const BoneModel& model, const std::vector<bool>& shows, int reach) {
  Eigen::AlignedBox3i box;
  geometry::visit_voxels(model.grid, [&](const Voxel& voxel, std::size_t at) {
    if (model.labels[at] < shows.size() && shows[model.labels[at]]) {
      box.extend(voxel);
    }
  });
  if (!box.isEmpty()) {
    const Voxel last = model.grid.last();
    box.min() = (box.min() - Voxel::Constant(reach)).cwiseMax(0);
    box.max() = (box.max() + Voxel::Constant(reach)).cwiseMin(last);
  }
  return box;
}

/// Nearest structures in a box, by one pass along each axis.
class NearestPasses {
 public:
  NearestPasses(const Eigen::AlignedBox3i& box, int reach)
      : size_(box.sizes() + Voxel::Ones()),
        reach_(reach),
        keys_(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                  static_cast<std::size_t>(size_.z()),
              kNothing) {}

  Key& at(const Voxel& voxel) { return keys_[index(voxel)]; }

  void run() {
    const auto in_planes = [](int planes, auto&& work) {
      in_groups(static_cast<std::size_t>(planes), 1, threads_or_all(0), [&] {
        return [&, line = std::vector<Key>()](std::size_t plane, std::size_t) mutable {
          work(static_cast<int>(plane), line);
        };
      });
    };
    const auto width = static_cast<std::size_t>(size_.x());
    in_planes(size_.z(), [&](int k, std::vector<Key>& line) {
      for (int j = 0; j < size_.y(); ++j) {
        along_row(&at({0, j, k}), line);
      }
      across_rows(&at({0, 0, k}), size_.y(), width, line);
    });
    in_planes(size_.y(), [&](int j, std::vector<Key>& line) {
      across_rows(&at({0, j, 0}), size_.z(), width * static_cast<std::size_t>(size_.y()), line);
    });
  }

 private:
  std::size_t index(const Voxel& v) const {
    return static_cast<std::size_t>(v.x()) +
           static_cast<std::size_t>(size_.x()) *
               (static_cast<std::size_t>(v.y()) +
                static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(v.z()));
  }

  /// The nearest on either side lies at the last one that was passed.
  void along_row(Key* row, std::vector<Key>& line) const {
    const auto width = static_cast<std::size_t>(size_.x());
    line.assign(row, row + width);
    for (const int way : {1, -1}) {
      Key last = kNothing;
      int ago = 0;
      for (int n = 0; n < size_.x(); ++n, ++ago) {
        const auto i = static_cast<std::size_t>(way > 0 ? n : size_.x() - 1 - n);
        if (line[i] != kNothing) {
          last = line[i];
          ago = 0;
        }
        if (ago <= reach_) {
          row[i] = std::min(row[i], moved(last, ago));
        }
      }
    }
  }

  /// Rows of a plane, `stride` apart, each with the nearest of those within reach.
  void across_rows(Key* plane, int rows, std::size_t stride, std::vector<Key>& line) const {
    const auto width = static_cast<std::size_t>(size_.x());
    line.resize(width * static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row) {
      std::copy_n(plane + stride * static_cast<std::size_t>(row), width,
                  line.data() + width * static_cast<std::size_t>(row));
    }
    for (int row = 0; row < rows; ++row) {
      Key* to = plane + stride * static_cast<std::size_t>(row);
      for (int other = std::max(row - reach_, 0); other <= std::min(row + reach_, rows - 1);
           ++other) {
        const Key* from = line.data() + width * static_cast<std::size_t>(other);
        for (std::size_t i = 0; i < width; ++i) {
          to[i] = std::min(to[i], moved(from[i], other - row));
        }
      }
    }
  }

  Voxel size_;
  int reach_;
  std::vector<Key> keys_;
};

}  // namespace

StructureDepths::StructureDepths(const BoneModel& model, const std::vector<bool>& shows,
                                 double reach)
    : grid_(model.grid), shows_(shows), reach_(reach / model.grid.spacing) {
  check(model);
  const double voxels = reach_;
  if (!(voxels >= 0.0) || voxels > kLargestReach) {
    throw std::invalid_argument("StructureDepths: the reach is from 0 to 250 voxels");
  }
  const int whole = static_cast<int>(std::ceil(voxels));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    table_size_[axis] = (grid_.size[axis] + BoneVolume::kEdge - 1) / BoneVolume::kEdge;
  }
  table_.assign(static_cast<std::size_t>(table_size_[0]) *
                    static_cast<std::size_t>(table_size_[1]) *
                    static_cast<std::size_t>(table_size_[2]),
                0);
  labels_.resize(BoneVolume::kBrickVoxels);
  squares_.resize(BoneVolume::kBrickVoxels);
  const Eigen::AlignedBox3i box = box_of(model, shows, whole);
  if (box.isEmpty()) {
    return;
  }
  NearestPasses passes(box, whole);
  const auto for_each = [&](auto&& visit) {
    for (int k = box.min().z(); k <= box.max().z(); ++k) {
      for (int j = box.min().y(); j <= box.max().y(); ++j) {
        for (int i = box.min().x(); i <= box.max().x(); ++i) {
          const Voxel voxel(i, j, k);
          visit(voxel, passes.at(voxel - box.min()));
        }
      }
    }
  };
  std::vector<bool> holds(table_.size(), false);  // by brick: anything
  for_each([&](const Voxel& voxel, Key& key) {
    const std::uint8_t label = model.labels[grid_.index(voxel)];
    if (label != 0) {
      holds[table_index(voxel)] = true;
    }
    if (label < shows.size() && shows[label]) {
      key = label;
      ++voxels_;
    }
  });
  passes.run();
  const double farthest = voxels * voxels;
  const auto is_near = [&](Key key) { return key != kNothing && key / kLabels <= farthest; };
  std::int32_t bricks = 1;
  for_each([&](const Voxel& voxel, Key key) {
    std::int32_t& brick = table_[table_index(voxel)];
    if (brick == 0 && is_near(key) && holds[table_index(voxel)]) {
      brick = bricks++;
    }
  });
  labels_.resize(static_cast<std::size_t>(bricks) * BoneVolume::kBrickVoxels);
  squares_.resize(labels_.size());
  for_each([&](const Voxel& voxel, Key key) {
    const std::int32_t brick = table_[table_index(voxel)];
    if (is_near(key) && brick != 0) {  // brick 0 stands for all places with nothing near
      const std::size_t at = entry_index(brick, voxel);
      labels_[at] = static_cast<std::uint8_t>(key % kLabels);
      squares_[at] = static_cast<std::uint16_t>(key / kLabels);
    }
  });
}

std::size_t StructureDepths::entry_index(std::int32_t brick, const Voxel& voxel) noexcept {
  const int place = voxel.x() % BoneVolume::kEdge +
                    BoneVolume::kEdge * (voxel.y() % BoneVolume::kEdge +
                                         BoneVolume::kEdge * (voxel.z() % BoneVolume::kEdge));
  return static_cast<std::size_t>(brick) * BoneVolume::kBrickVoxels +
         static_cast<std::size_t>(place);
}

std::size_t StructureDepths::table_index(const Voxel& voxel) const noexcept {
  const auto at = [](int i) { return static_cast<std::size_t>(i / BoneVolume::kEdge); };
  return at(voxel.x()) +
         static_cast<std::size_t>(table_size_[0]) *
             (at(voxel.y()) + static_cast<std::size_t>(table_size_[1]) * at(voxel.z()));
}

NearStructure StructureDepths::at(const Voxel& voxel) const noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    if (voxel[axis] < 0 || voxel[axis] >= grid_.size[static_cast<std::size_t>(axis)]) {
      return {};
    }
  }
  const std::size_t at = entry_index(table_[table_index(voxel)], voxel);
  return {labels_[at], grid_.spacing * std::sqrt(static_cast<double>(squares_[at]))};
}

std::vector<bool> all_but_bone(std::span<const Structure> structures) {
  std::vector<bool> shows(structures.size(), false);
  for (std::size_t label = 1; label < structures.size(); ++label) {
    const std::string& name = structures[label].name;
    shows[label] = name != "bone" && !name.ends_with(" bone");
  }
  return shows;
}

}  // namespace haptrial::bone
