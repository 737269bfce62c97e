#include "core/render/bone/surgical_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace haptrial::render {
namespace {

constexpr double kCell = 1.5e-3;  // of the map of heights [m]
constexpr int kHalfSide = 60;     // cells from its middle to each side
constexpr int kSide = 2 * kHalfSide + 1;
constexpr double kDeepest = 8e-3;     // of the tissue below the bone in the field [m]
constexpr double kField = 12e-3;      // about the target, where the bone's height is taken [m]
constexpr double kBedDepth = 1.0e-3;  // of the tissue beside the bone below the bone's edge [m]
const Colour kMuscle{0.54, 0.18, 0.15};
constexpr double kBelowBone = 9e-3;                          // of it where bone begins [m]
constexpr int kTurns = 144;                                  // steps around the opening
constexpr const char* kCovered = "temporomandibular joint";  // by soft tissue in any operation
constexpr double kNothing = -std::numeric_limits<double>::infinity();

/// Heights over the plane through the target that faces the eye, along right and up of the picture.
class Heights {
 public:
  Heights(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB, const Camera& view)
      : axes_(view.axes()),
        target_(view.target),
        heights_(kSide * kSide, kNothing),
        bony_(kSide * kSide) {
    const geometry::VoxelGrid& grid = model.grid;
    const int stride = std::max(1, static_cast<int>(0.6e-3 / grid.spacing));
    for (int k = 0; k < grid.size[2]; k += stride) {
      for (int j = 0; j < grid.size[1]; j += stride) {
        for (int i = 0; i < grid.size[0]; i += stride) {
          if (const std::uint8_t label = model.labels[grid.index(i, j, k)]; label != 0) {
            raise(X_WB * grid.centre(i, j, k), model.structures[label].name != kCovered);
          }
        }
      }
    }
    fill();
    smooth(
        2, [](double a, double b) { return std::max(a, b); }, 1.0);
    smooth(
        4, [](double a, double b) { return a + b; }, 3.0);
  }

  /// Cells in which no bone is seen, but for those that the joint of the jaw covers: what lies
  /// there is soft tissue.
  bool is_soft(int i, int j) const { return !bony_[static_cast<std::size_t>(i + kSide * j)]; }
  /// Share of bone in the cells around one.
  double bony_share(int i, int j) const {
    constexpr int kReach = 2;
    int bony = 0;
    for (int y = j - kReach; y <= j + kReach; ++y) {
      for (int x = i - kReach; x <= i + kReach; ++x) {
        bony += is_soft(std::clamp(x, 0, kSide - 1), std::clamp(y, 0, kSide - 1)) ? 0 : 1;
      }
    }
    return bony / std::pow(2.0 * kReach + 1.0, 2);
  }
  static Eigen::Vector2d place_of(int i, int j) {
    return {kCell * (i - kHalfSide), kCell * (j - kHalfSide)};
  }

  /// Height at a place in the plane, linear between cells.
  double at(const Eigen::Vector2d& place) const {
    const Eigen::Array2d cell =
        (place.array() / kCell + kHalfSide).max(0.0).min(static_cast<double>(kSide) - 1.001);
    const Eigen::Array2i low = cell.floor().cast<int>();
    const Eigen::Array2d part = cell - cell.floor();
    const auto mix = [&](int j) {
      return (1.0 - part.x()) * cell_at(low.x(), j) + part.x() * cell_at(low.x() + 1, j);
    };
    return (1.0 - part.y()) * mix(low.y()) + part.y() * mix(low.y() + 1);
  }

  Eigen::Vector3d world(const Eigen::Vector2d& place, double height) const {
    return target_ + axes_ * Eigen::Vector3d(place.x(), place.y(), height);
  }

 private:
  double& cell_at(int i, int j) { return heights_[static_cast<std::size_t>(i + kSide * j)]; }
  double cell_at(int i, int j) const { return heights_[static_cast<std::size_t>(i + kSide * j)]; }

  void raise(const Eigen::Vector3d& p_W, bool bony) {
    const Eigen::Vector3d p = axes_.transpose() * (p_W - target_);
    const Eigen::Array2i cell = (p.head<2>().array() / kCell + kHalfSide).round().cast<int>();
    if ((cell >= 0).all() && (cell < kSide).all()) {
      double& height = cell_at(cell.x(), cell.y());
      height = std::max(height, p.z());
      auto&& here = bony_[static_cast<std::size_t>(cell.x() + kSide * cell.y())];
      here = here || bony;
    }
  }

  /// Beside the bone, and where it falls off, the tissue stays at a depth.
  void fill() {
    std::vector<double> field;
    constexpr int kFieldCells = static_cast<int>(kField / kCell);
    for (int j = kHalfSide - kFieldCells; j <= kHalfSide + kFieldCells; ++j) {
      for (int i = kHalfSide - kFieldCells; i <= kHalfSide + kFieldCells; ++i) {
        if (cell_at(i, j) > kNothing) {
          field.push_back(cell_at(i, j));
        }
      }
    }
    const auto middle = field.begin() + static_cast<std::ptrdiff_t>(field.size() / 2);
    std::nth_element(field.begin(), middle, field.end());
    const double least = (field.empty() ? 0.0 : *middle) - kDeepest;
    for (double& height : heights_) {
      height = std::max(height, least);
    }
  }

  /// Each cell with its neighbours, first along one axis and then along the other.
  template <class Join>
  void smooth(int rounds, const Join& join, double sum) {
    for (int round = 0; round < rounds; ++round) {
      for (const bool across : {true, false}) {
        const std::vector<double> before = heights_;
        for (int j = 0; j < kSide; ++j) {
          for (int i = 0; i < kSide; ++i) {
            const auto beside = [&](int step) {
              const int x = std::clamp(across ? i + step : i, 0, kSide - 1);
              const int y = std::clamp(across ? j : j + step, 0, kSide - 1);
              return before[static_cast<std::size_t>(x + kSide * y)];
            };
            cell_at(i, j) = join(join(beside(-1), beside(0)), beside(1)) / sum;
          }
        }
      }
    }
  }

  Eigen::Matrix3d axes_;
  Eigen::Vector3d target_;
  std::vector<double> heights_;
  std::vector<bool> bony_;
};

/// A place of a layer's section: how far out, 1 at the wound's edge, and how high over the bone.
struct Step {
  double out;
  double height;  // [m]
};

struct Layer {
  Colour colour;
  double uneven;  // of its height [m]
  std::vector<Step> steps;
};

/// From the wound outwards.
std::vector<Layer> layers() {
  return {
      {kMuscle,  // and periosteum
       0.5e-3,
       {{0.96, -3e-3},
        {0.985, -0.5e-3},
        {1.0, 1.2e-3},
        {1.03, 2.5e-3},
        {1.08, 3.4e-3},
        {1.13, 3.6e-3}}},
      {{0.80, 0.64, 0.42},  // fat
       0.4e-3,
       {{1.12, 3.2e-3}, {1.14, 4.2e-3}, {1.17, 4.8e-3}, {1.20, 4.8e-3}}},
      {{0.80, 0.56, 0.46},  // skin
       0.2e-3,
       {{1.19, 4.4e-3}, {1.21, 5.6e-3}, {1.25, 5.9e-3}, {1.33, 5.4e-3}, {1.45, 4.6e-3}}},
      {{0.10, 0.30, 0.33},  // drape
       0.9e-3,
       {{1.36, 4.6e-3},
        {1.38, 6.4e-3},
        {1.46, 6.6e-3},
        {1.6, 5.4e-3},
        {1.8, 6.2e-3},
        {2.0, 4.6e-3},
        {2.3, 5.8e-3},
        {2.7, 3.0e-3},
        {3.4, 0.0},
        {5.0, -8e-3}}},
  };
}

/// Folds and strands around the wound, from -1 to 1.
double waves(double angle, double out) {
  return 0.5 * std::sin(5.0 * angle + 7.0 * out) + 0.3 * std::sin(13.0 * angle - 11.0 * out) +
         0.2 * std::sin(29.0 * angle + 17.0 * out);
}

geometry::Mesh ring_of(const Layer& layer, const Heights& heights, const Eigen::Vector2d& opening) {
  geometry::Mesh mesh;
  const auto steps = static_cast<std::int32_t>(layer.steps.size());
  for (int turn = 0; turn < kTurns; ++turn) {
    const double angle = 2.0 * std::numbers::pi * turn / kTurns;
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    for (const Step& step : layer.steps) {
      const double ragged = 1.0 + 0.05 * waves(angle, 1.0) + 0.02 * waves(3.0 * angle, step.out);
      const Eigen::Vector2d place = step.out * ragged * opening.cwiseProduct(way);
      const double height = heights.at(place) + step.height + layer.uneven * waves(angle, step.out);
      mesh.vertices.push_back(heights.world(place, height));
    }
  }
  for (std::int32_t turn = 0; turn < kTurns; ++turn) {
    const std::int32_t here = turn * steps;
    const std::int32_t next = (turn + 1) % kTurns * steps;
    for (std::int32_t s = 0; s + 1 < steps; ++s) {
      mesh.triangles.push_back({here + s, here + s + 1, next + s + 1});
      mesh.triangles.push_back({here + s, next + s + 1, next + s});
    }
  }
  return mesh;
}

/// Soft tissue beside the bone, on which the wound's edges lie; it reaches a cell below the bone.
geometry::Mesh bed_of(const Heights& heights) {
  geometry::Mesh mesh;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const Eigen::Vector2d place = Heights::place_of(i, j);
      const double uneven = 0.4e-3 * std::sin(900.0 * place.x() + 500.0 * place.y()) *
                            std::sin(700.0 * place.y() - 300.0 * place.x());
      const double bony = heights.bony_share(i, j);
      const double depth = kBedDepth + (kBelowBone - kBedDepth) * bony * bony;
      mesh.vertices.push_back(heights.world(place, heights.at(place) - depth + uneven));
    }
  }
  const auto soft_near = [&](int i, int j) {
    bool any = false;
    for (int n = 0; n < 16 && !any; ++n) {
      any = heights.is_soft(std::clamp(i - 1 + n % 4, 0, kSide - 1),
                            std::clamp(j - 1 + n / 4, 0, kSide - 1));
    }
    return any;
  };
  for (std::int32_t j = 0; j + 1 < kSide; ++j) {
    for (std::int32_t i = 0; i + 1 < kSide; ++i) {
      if (soft_near(i, j)) {
        const std::int32_t here = i + kSide * j;
        mesh.triangles.push_back({here, here + 1, here + kSide + 1});
        mesh.triangles.push_back({here, here + kSide + 1, here + kSide});
      }
    }
  }
  return mesh;
}

SceneMesh scenery(geometry::Mesh mesh, const Colour& colour) {
  SceneMesh scenery;
  scenery.mesh = std::make_shared<const geometry::Mesh>(std::move(mesh));
  scenery.colour = colour;
  return scenery;
}

}  // namespace

std::vector<SceneMesh> surgical_field(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                                      const Camera& view) {
  const Heights heights(model, X_WB, view);
  const double half = view.distance() * std::tan(0.5 * view.field_of_view);
  const Eigen::Vector2d opening(1.12 * half, 0.88 * half);
  std::vector<SceneMesh> all{scenery(bed_of(heights), kMuscle)};
  for (const Layer& layer : layers()) {
    all.push_back(scenery(ring_of(layer, heights, opening), layer.colour));
  }
  return all;
}

}  // namespace haptrial::render
