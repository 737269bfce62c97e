#include "analysis/bone_drilling/report/visibility_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/bone/model/bone_volume.h"

namespace haptrial::analysis::drilling {
namespace {

/// Drawn content of a voxel: a removed one by whether it was seen, else a structure's label.
struct Drawn {
  std::vector<std::uint16_t> kinds;  // (voxels) 0: nothing
  static constexpr std::uint16_t kSeenKind = 256;
  static constexpr std::uint16_t kHiddenKind = 257;

  std::uint16_t at(const geometry::VoxelGrid& grid, const bone::Voxel& v) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (v[axis] < 0 || v[axis] >= grid.size[static_cast<std::size_t>(axis)]) {
        return 0;
      }
    }
    return kinds[grid.index(v)];
  }
};

/// Pale, so that what was removed stands out.
render::Colour toned(const bone::Structure& structure) {
  constexpr double kOwn = 0.5;
  constexpr double kPale = 0.92;
  const auto mix = [](double own) { return kOwn * own + (1.0 - kOwn) * kPale; };
  return {mix(structure.colour[0]), mix(structure.colour[1]), mix(structure.colour[2])};
}

render::Colour colour_of(const bone::BoneModel& bone, std::uint16_t kind) {
  if (kind >= Drawn::kSeenKind) {
    return kind == Drawn::kSeenKind ? kSeenColour : kHiddenColour;
  }
  return toned(bone.structures[kind]);
}

/// @param labels  that are drawn where nothing was removed
Drawn drawn_of(const SeenRemovals& r, const std::vector<bool>& labels) {
  if (r.removed.size() != r.seen.size()) {
    throw std::invalid_argument("visibility pictures: as many voxels as marks are needed");
  }
  Drawn drawn{std::vector<std::uint16_t>(r.bone->grid.count(), 0)};
  for (std::size_t i = 0; i < r.bone->labels.size(); ++i) {
    const std::uint8_t label = r.bone->labels[i];
    drawn.kinds[i] = label != 0 && label < labels.size() && labels[label] ? label : 0;
  }
  for (std::size_t n = 0; n < r.removed.size(); ++n) {
    if (r.removed[n] >= drawn.kinds.size()) {
      throw std::invalid_argument("visibility pictures: a voxel is outside of the grid");
    }
    drawn.kinds[r.removed[n]] = r.seen[n] != 0 ? Drawn::kSeenKind : Drawn::kHiddenKind;
  }
  return drawn;
}

/// Two triangles of the side of a voxel that looks along an axis.
void add_side(const geometry::VoxelGrid& grid, const bone::Voxel& voxel, int axis, int way,
              const render::Colour& colour, std::vector<render::SceneTriangle>& triangles) {
  const double half = 0.5 * grid.spacing;
  const Eigen::Vector3d centre = grid.centre(voxel);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  std::array<Eigen::Vector3d, 4> corners;
  for (std::size_t n = 0; n < 4; ++n) {
    corners[n] = centre;
    corners[n][axis] += way * half;
    corners[n][u] += n == 1 || n == 2 ? half : -half;
    corners[n][v] += n >= 2 ? half : -half;
  }
  triangles.push_back({{corners[0], corners[1], corners[2]}, colour, 1});
  triangles.push_back({{corners[2], corners[3], corners[0]}, colour, 1});
}

/// Place of a section.
struct Layer {
  int up{2};           // axis of the grid
  bool upwards{true};  // the axis itself points up, not its opposite
  int through{1};      // the axis across the picture's plane
  int at{0};           // the layer along it
};

/// The layer with the most voxels that `counts`, along either axis that is not `up`.
template <class Counts>
std::pair<Layer, std::size_t> fullest(const SeenRemovals& r, const Layer& start, Counts counts) {
  Layer best = start;
  std::size_t most = 0;
  for (const int axis : {(start.up + 1) % 3, (start.up + 2) % 3}) {
    std::vector<std::size_t> layers(
        static_cast<std::size_t>(r.bone->grid.size[static_cast<std::size_t>(axis)]), 0);
    for (std::size_t n = 0; n < r.removed.size(); ++n) {
      const int at = r.bone->grid.voxel(r.removed[n])[axis];
      layers[static_cast<std::size_t>(at)] += counts(r.seen[n]) ? 1 : 0;
    }
    const auto top = std::max_element(layers.begin(), layers.end());
    if (*top > most) {
      most = *top;
      best.through = axis;
      best.at = static_cast<int>(top - layers.begin());
    }
  }
  return {best, most};
}

Layer layer_of(const SeenRemovals& r, const Eigen::Vector3d& towards_eye) {
  Layer start;
  towards_eye.cwiseAbs().maxCoeff(&start.up);
  start.upwards = towards_eye[start.up] > 0.0;
  const auto [hidden, any] = fullest(r, start, [](std::uint8_t seen) { return seen == 0; });
  return any > 0 ? hidden : fullest(r, start, [](std::uint8_t) { return true; }).first;
}

/// The removed voxels of all layers and some bone around them.
Eigen::AlignedBox3i surroundings(const SeenRemovals& r) {
  constexpr double kAround = 6e-3;  // [m]
  Eigen::AlignedBox3i box;
  for (const std::uint32_t index : r.removed) {
    box.extend(r.bone->grid.voxel(index));
  }
  const int more = static_cast<int>(std::ceil(kAround / r.bone->grid.spacing));
  const Eigen::Vector3i low = (box.min().array() - more).max(0);
  const Eigen::Vector3i high = (box.max().array() + more).min(r.bone->grid.last().array());
  return {low, high};
}

/// Drops the triangles aside of the removed voxels: the dura would fill the picture.
/// @param along  the axis of the grid along which everything stays
void keep_near(std::vector<render::SceneTriangle>& triangles, const SeenRemovals& r, int along) {
  const Eigen::AlignedBox3i voxels = surroundings(r);
  const auto centre = [&](const Eigen::Vector3i& v) { return r.bone->grid.centre(v); };
  Eigen::AlignedBox3d box(centre(voxels.min()), centre(voxels.max()));
  constexpr double kFar = 1e3;  // [m]
  box.min()[along] = -kFar;
  box.max()[along] = kFar;
  const double most = std::pow(r.bone->grid.spacing, 2);  // the sides of its outermost voxels too
  std::erase_if(triangles, [&](const render::SceneTriangle& t) {
    const Eigen::Vector3d middle = 0.5 * (t.corners[0] + t.corners[2]);  // of the voxel's side
    return box.squaredExteriorDistance(middle) > most;
  });
}

void put(render::Image& image, int x, int y, const render::Colour& colour) {
  const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(x));
  const auto byte = [](double value) { return static_cast<std::uint8_t>(255.0 * value + 0.5); };
  image.rgb[at] = byte(colour.red);
  image.rgb[at + 1] = byte(colour.green);
  image.rgb[at + 2] = byte(colour.blue);
}

render::Image white(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(
              3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255)};
}

void paste(render::Image& onto, const render::Image& picture, int left) {
  for (int y = 0; y < picture.height; ++y) {
    const auto from = picture.rgb.begin() + static_cast<std::ptrdiff_t>(3) * y * picture.width;
    std::copy(from, from + static_cast<std::ptrdiff_t>(3) * picture.width,
              onto.rgb.begin() + static_cast<std::ptrdiff_t>(3) * (y * onto.width + left));
  }
}

/// View from the eye, upright.
render::SceneView scene_view(const SurgeonsView& view) {
  render::SceneView scene;
  const Eigen::Vector3d out = view.towards_eye.normalized();
  scene.up = (view.up - view.up.dot(out) * out).normalized();
  scene.elevation = 0.0;
  scene.azimuth = 0.0;
  const Eigen::Vector3d level = scene.towards_eye();
  scene.azimuth = std::atan2(scene.up.dot(level.cross(out)), level.dot(out));
  return scene;
}

}  // namespace

std::vector<render::SceneTriangle> visibility_scene(const SeenRemovals& removals,
                                                    const std::vector<bool>& labels) {
  const bone::BoneModel& bone = *removals.bone;
  const Drawn drawn = drawn_of(removals, labels);
  std::vector<render::SceneTriangle> triangles;
  for (std::size_t i = 0; i < drawn.kinds.size(); ++i) {
    if (drawn.kinds[i] == 0) {
      continue;
    }
    const bone::Voxel voxel = bone.grid.voxel(i);
    const render::Colour colour = colour_of(bone, drawn.kinds[i]);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int way : {-1, 1}) {
        bone::Voxel beside = voxel;
        beside[axis] += way;
        if (drawn.at(bone.grid, beside) == 0) {
          add_side(bone.grid, voxel, axis, way, colour, triangles);
        }
      }
    }
  }
  return triangles;
}

render::Image visibility_section(const SeenRemovals& removals, const Eigen::Vector3d& towards_eye,
                                 int width, int height) {
  constexpr render::Colour kBone{0.87, 0.84, 0.77};
  const bone::BoneModel& bone = *removals.bone;
  // Everything that is not bone itself has its own colour.
  std::vector<bool> labels(bone.structures.size(), true);
  const Drawn drawn = drawn_of(removals, labels);
  if (removals.removed.empty()) {
    throw std::invalid_argument("visibility_section: nothing was removed");
  }
  const Layer layer = layer_of(removals, towards_eye);
  const int across = 3 - layer.up - layer.through;
  const Eigen::AlignedBox3i box = surroundings(removals);
  const Eigen::Vector3i extent = box.sizes().array() + 1;
  const int pixels = std::max(1, std::min(width / extent[across], height / extent[layer.up]));
  const int left = (width - pixels * extent[across]) / 2;
  const int top = (height - pixels * extent[layer.up]) / 2;
  render::Image image = white(width, height);
  for (int y = std::max(top, 0); y < std::min(height, top + pixels * extent[layer.up]); ++y) {
    for (int x = std::max(left, 0); x < std::min(width, left + pixels * extent[across]); ++x) {
      bone::Voxel voxel;
      const int down = (y - top) / pixels;
      voxel[layer.through] = layer.at;
      voxel[across] = box.min()[across] + (x - left) / pixels;
      voxel[layer.up] = layer.upwards ? box.max()[layer.up] - down : box.min()[layer.up] + down;
      const std::uint16_t kind = drawn.at(bone.grid, voxel);
      if (kind != 0) {
        const bool plain = kind < Drawn::kSeenKind && !bone.structures[kind].vital;
        put(image, x, y, plain ? kBone : colour_of(bone, kind));
      }
    }
  }
  return image;
}

render::Image visibility_figure(const SeenRemovals& removals, const SurgeonsView& view) {
  constexpr int kWidth = 560;
  constexpr int kHeight = 520;
  render::SceneView scene = scene_view(view);
  scene.width = kWidth;
  scene.height = kHeight;
  render::Image figure = white(2 * kWidth, kHeight);
  std::vector<render::SceneTriangle> triangles =
      visibility_scene(removals, vital_labels(*removals.bone));
  keep_near(triangles, removals, layer_of(removals, view.towards_eye).up);
  paste(figure, render::draw_scene(triangles, scene), 0);
  paste(figure, visibility_section(removals, view.towards_eye, kWidth, kHeight), kWidth);
  return figure;
}

std::vector<bool> vital_labels(const bone::BoneModel& bone) {
  std::vector<bool> labels(bone.structures.size(), false);
  for (std::size_t label = 1; label < labels.size(); ++label) {
    labels[label] = bone.structures[label].vital;
  }
  return labels;
}

}  // namespace haptrial::analysis::drilling
