#include "core/bone/data/resample.h"
#include "core/base/parallel.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::bone {
namespace {

constexpr double kLobes = 3.0;

/// Windowed sinc, 0 from three lobes on.
double lanczos(double x) {
  if (std::abs(x) < 1e-9) {
    return 1.0;
  }
  if (std::abs(x) >= kLobes) {
    return 0.0;
  }
  const double a = std::numbers::pi * x;
  return kLobes * std::sin(a) * std::sin(a / kLobes) / (a * a);
}

/// The values around a place along one axis, and what each counts; beyond the ends the last one.
struct Taps {
  std::int32_t first{0};
  std::vector<float> weights;
};

/// @param at      in voxels
/// @param width   how much wider than a voxel the filter is, 1 or more
Taps taps_at(double at, double width, std::int32_t size) {
  const double reach = kLobes * width;
  const auto low = static_cast<std::int32_t>(std::ceil(at - reach));
  const auto high = static_cast<std::int32_t>(std::floor(at + reach));
  Taps taps;
  taps.first = std::clamp(low, 0, size - 1);
  const std::int32_t last = std::clamp(high, 0, size - 1);
  std::vector<double> weights(static_cast<std::size_t>(last - taps.first + 1), 0.0);
  double sum = 0.0;
  for (std::int32_t i = low; i <= high; ++i) {
    const double weight = lanczos((i - at) / width);
    weights[static_cast<std::size_t>(std::clamp(i, taps.first, last) - taps.first)] += weight;
    sum += weight;
  }
  for (const double weight : weights) {
    taps.weights.push_back(static_cast<float>(weight / sum));
  }
  return taps;
}

/// Replaces one axis of an array by as many values as there are taps.
BigArray<float> filter_axis(const BigArray<float>& from, std::array<std::int32_t, 3> size, int axis,
                            const std::vector<Taps>& taps) {
  const auto a = static_cast<std::size_t>(axis);
  std::size_t stride = 1;
  for (std::size_t i = 0; i < a; ++i) {
    stride *= static_cast<std::size_t>(size[i]);
  }
  std::size_t outer = 1;
  for (std::size_t i = a + 1; i < 3; ++i) {
    outer *= static_cast<std::size_t>(size[i]);
  }
  const auto length = static_cast<std::size_t>(size[a]);
  BigArray<float> to(stride * taps.size() * outer);
  parallel_for(outer, threads_or_all(0), [&](std::size_t o) {
    for (std::size_t t = 0; t < taps.size(); ++t) {
      float* row = to.data() + (o * taps.size() + t) * stride;
      std::fill(row, row + stride, 0.0F);
      const Taps& tap = taps[t];
      for (std::size_t w = 0; w < tap.weights.size(); ++w) {
        const std::size_t index = static_cast<std::size_t>(tap.first) + w;
        const float* source = from.data() + (o * length + index) * stride;
        const float weight = tap.weights[w];
        for (std::size_t s = 0; s < stride; ++s) {
          row[s] += weight * source[s];
        }
      }
    }
  });
  return to;
}

bool within(double at, std::int32_t size) { return at >= -0.5 && at <= size - 0.5; }

/// Grid and volume have the same axes: one axis after the other.
BigArray<float> resample_straight(const UprightVolume& volume, const geometry::VoxelGrid& grid,
                                  const VoxelMap& map, const geometry::WorkReport& report) {
  std::array<std::int32_t, 3> size = volume.size;
  BigArray<float> values = volume.components[0];
  for (int axis = 2; axis >= 0; --axis) {  // the coarsest axis of a scan first
    const auto a = static_cast<std::size_t>(axis);
    const double scale = map.turn(axis, axis);
    std::vector<Taps> taps;
    for (std::int32_t i = 0; i < grid.size[a]; ++i) {
      const double at = scale * grid.coordinate(axis, i) + map.offset[axis];
      taps.push_back(taps_at(at, std::max(1.0, scale * grid.spacing), size[a]));
    }
    values = filter_axis(values, size, axis, taps);
    size[a] = grid.size[a];
    geometry::report_share(report, (3.0 - axis) / 3.0);
  }
  return values;
}

/// The volume without detail that is finer than the grid's voxels, at the volume's own places.
BigArray<float> smoothed(const UprightVolume& volume, double spacing) {
  BigArray<float> values = volume.components[0];
  for (int axis = 0; axis < 3; ++axis) {
    const double width = spacing / volume.steps.col(axis).norm();
    if (width <= 1.0) {
      continue;
    }
    std::vector<Taps> taps;
    const std::int32_t size = volume.size[static_cast<std::size_t>(axis)];
    for (std::int32_t i = 0; i < size; ++i) {
      taps.push_back(taps_at(i, width, size));
    }
    values = filter_axis(values, volume.size, axis, taps);
  }
  return values;
}

/// The weights of six values around a place between two voxels, from a table of its fraction.
class SixWeights {
 public:
  static constexpr std::int32_t kCount = 6;
  static constexpr std::int32_t kBefore = 2;  // values below the place's voxel
  using Weights = std::array<float, kCount>;

  SixWeights() {
    for (std::size_t step = 0; step < table_.size(); ++step) {
      const Taps taps = taps_at(kBefore + static_cast<double>(step) / kSteps, 1.0, kCount);
      std::ranges::copy(taps.weights, table_[step].begin());
    }
  }

  Weights at(double fraction) const {
    const double place = fraction * kSteps;
    const auto step = static_cast<std::size_t>(place);
    const auto share = static_cast<float>(place - static_cast<double>(step));
    Weights weights;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      weights[i] = table_[step][i] + share * (table_[step + 1][i] - table_[step][i]);
    }
    return weights;
  }

 private:
  static constexpr double kSteps = 1024.0;  // linear between them: right to 1e-6
  std::array<Weights, 1026> table_{};       // for a fraction that is rounded to 1 as well
};

/// Values with more voxels on every side, which repeat the outermost.
struct Padded {
  static constexpr std::int32_t kMargin = 3;
  std::array<std::size_t, 3> size;
  BigArray<float> values;

  Padded(const BigArray<float>& inner, const std::array<std::int32_t, 3>& inner_size) {
    std::ranges::transform(inner_size, size.begin(), [](std::int32_t n) {
      return static_cast<std::size_t>(n + 2 * kMargin);
    });
    values.resize(size[0] * size[1] * size[2]);
    const auto within = [&](std::size_t at, std::size_t axis) {
      const auto last = inner_size[axis] - 1;
      return static_cast<std::size_t>(std::clamp(static_cast<std::int32_t>(at) - kMargin, 0, last));
    };
    const std::array<std::size_t, 2> stride{static_cast<std::size_t>(inner_size[0]),
                                            static_cast<std::size_t>(inner_size[1])};
    std::size_t to = 0;
    for (std::size_t k = 0; k < size[2]; ++k) {
      for (std::size_t j = 0; j < size[1]; ++j) {
        const std::size_t row = stride[0] * (within(j, 1) + stride[1] * within(k, 2));
        for (std::size_t i = 0; i < size[0]; ++i) {
          values[to++] = inner[row + within(i, 0)];
        }
      }
    }
  }
};

/// The value at a place in voxels: 6 x 6 x 6 values around it.
float value_at(const Eigen::Vector3d& at, const Padded& source, const SixWeights& table) {
  std::array<std::size_t, 3> first{};
  std::array<SixWeights::Weights, 3> weights;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double low = std::floor(at[axis]);
    first[a] = static_cast<std::size_t>(low + Padded::kMargin - SixWeights::kBefore);
    weights[a] = table.at(at[axis] - low);
  }
  SixWeights::Weights columns{};
  for (std::size_t k = 0; k < weights[2].size(); ++k) {
    for (std::size_t j = 0; j < weights[1].size(); ++j) {
      const float weight = weights[2][k] * weights[1][j];
      const float* row = source.values.data() + first[0] +
                         source.size[0] * (first[1] + j + source.size[1] * (first[2] + k));
      for (std::size_t i = 0; i < columns.size(); ++i) {
        columns[i] += weight * row[i];
      }
    }
  }
  float sum = 0.0F;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    sum += weights[0][i] * columns[i];
  }
  return sum;
}

/// Any axes.
BigArray<float> resample_turned(const UprightVolume& volume, const geometry::VoxelGrid& grid,
                                const VoxelMap& map, float beyond,
                                const geometry::WorkReport& report) {
  const Padded source(smoothed(volume, grid.spacing), volume.size);
  const SixWeights table;
  BigArray<float> values(grid.count());
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    parallel_for(static_cast<std::size_t>(grid.size[1]), threads_or_all(0), [&](std::size_t row) {
      const auto j = static_cast<std::int32_t>(row);
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        const Eigen::Vector3d at = map.turn * grid.centre(i, j, k) + map.offset;
        const bool inside = within(at.x(), volume.size[0]) && within(at.y(), volume.size[1]) &&
                            within(at.z(), volume.size[2]);
        values[grid.index(i, j, k)] = inside ? value_at(at, source, table) : beyond;
      }
    });
    geometry::report_share(report, (k + 1.0) / grid.size[2]);
  }
  return values;
}

/// The rotation (mirrored if they are) nearest to the directions of a volume's axes: the orthogonal
/// factor of their polar decomposition by Newton's iteration (Higham 1986), whose error is squared
/// in each step.
Eigen::Matrix3d square_axes(const UprightVolume& volume) {
  constexpr int kSteps = 32;
  Eigen::Matrix3d axes = volume.steps.colwise().normalized();
  double change = 1.0;
  for (int step = 0; step < kSteps && change > 1e-15; ++step) {
    const Eigen::Matrix3d next = 0.5 * (axes + axes.inverse().transpose());
    change = (next - axes).cwiseAbs().maxCoeff();
    axes = next;
  }
  return axes;
}

}  // namespace

UprightVolume upright(SourceVolume&& source) {
  const VolumeHead& head = source.head;
  const Eigen::Matrix3d directions = head.steps.colwise().normalized();
  std::array<int, 3> from{};  // the axis of the file for each of x, y, z
  std::array<bool, 3> down{};
  double best = -1.0;
  std::array<int, 3> order{0, 1, 2};
  do {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      sum += std::abs(directions(axis, order[static_cast<std::size_t>(axis)]));
    }
    if (sum > best) {
      best = sum;
      from = order;
    }
  } while (std::ranges::next_permutation(order).found);
  UprightVolume result;
  result.origin = head.origin;
  std::array<std::int64_t, 3> stride{};  // in the file, by our axes
  std::int64_t start = 0;
  const std::array<std::int64_t, 3> strides{1, head.size[0],
                                            static_cast<std::int64_t>(head.size[0]) * head.size[1]};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto f = static_cast<std::size_t>(from[a]);
    const Eigen::Vector3d step = head.steps.col(from[a]);
    down[a] = step[axis] < 0.0;
    result.size[a] = head.size[f];
    result.steps.col(axis) = down[a] ? Eigen::Vector3d(-step) : step;
    stride[a] = down[a] ? -strides[f] : strides[f];
    if (down[a]) {
      start += strides[f] * (head.size[f] - 1);
      result.origin += (head.size[f] - 1) * step;
    }
  }
  const auto parts = static_cast<std::size_t>(head.components);
  if (parts == 1 && stride == strides) {
    result.components.push_back(std::move(source.values));
    return result;
  }
  for (std::size_t part = 0; part < parts; ++part) {
    BigArray<float>& values = result.components.emplace_back(head.count());
    std::size_t at = 0;
    for (std::int64_t k = 0; k < result.size[2]; ++k) {
      for (std::int64_t j = 0; j < result.size[1]; ++j) {
        for (std::int64_t i = 0; i < result.size[0]; ++i) {
          const std::int64_t voxel = start + stride[0] * i + stride[1] * j + stride[2] * k;
          values[at++] = source.values[static_cast<std::size_t>(voxel) * parts + part];
        }
      }
    }
  }
  source.values = {};
  return result;
}

namespace {

/// How far a corner lies from where other steps would put it [m].
double corner_shift(const UprightVolume& volume, const Eigen::Matrix3d& steps) {
  double farthest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d half;  // from the middle
    for (int axis = 0; axis < 3; ++axis) {
      half[axis] = (volume.size[static_cast<std::size_t>(axis)] - 1) *
                   ((corner >> axis) % 2 == 0 ? 0.5 : -0.5);
    }
    farthest = std::max(farthest, ((volume.steps - steps) * half).norm());
  }
  return farthest;
}

}  // namespace

Pose pose_of(const UprightVolume& volume) {
  const Eigen::Matrix3d axes = square_axes(volume);
  const Eigen::Vector3d edges = volume.steps.colwise().norm();
  const double spacing = std::cbrt(std::abs(volume.steps.determinant()));
  const Eigen::Matrix3d directions = volume.steps.colwise().normalized();
  const Eigen::Matrix3d cosines = directions.transpose() * directions;
  Pose pose;
  pose.turn = axes.determinant() > 0.0 ? Eigen::AngleAxisd(axes).angle() : std::numbers::pi;
  pose.slant = std::asin(std::min(
      1.0, std::max({std::abs(cosines(0, 1)), std::abs(cosines(0, 2)), std::abs(cosines(1, 2))})));
  pose.shape = corner_shift(volume, spacing * axes) / spacing;
  pose.skew = corner_shift(volume, axes * edges.asDiagonal()) / edges.minCoeff();
  constexpr double kFromTheFirstVoxel = 2.0;  // which keeps its place; else it is from the middle
  pose.off = kFromTheFirstVoxel * corner_shift(volume, edges.asDiagonal());
  return pose;
}

geometry::VoxelGrid grid_over(const UprightVolume& volume, double spacing, bool own_axes) {
  geometry::VoxelGrid grid;
  grid.spacing = spacing;
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const double last = volume.size[static_cast<std::size_t>(axis)] - 1;
    const Eigen::Vector3d along = last * volume.steps.col(axis);
    if (own_axes) {
      high[axis] += along.norm();
    } else {
      low += along.cwiseMin(0.0);
      high += along.cwiseMax(0.0);
    }
  }
  grid.origin = volume.origin + low;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kLargest = 1e6;  // refused later, as memory
    const double voxels = std::floor((high - low)[axis] / spacing + 1e-6) + 1.0;
    grid.size[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(std::min(voxels, kLargest));
  }
  return grid;
}

VoxelMap map_to(const UprightVolume& volume, bool own_axes) {
  if (own_axes) {
    const Eigen::Vector3d edges = volume.steps.colwise().norm();
    const Eigen::Matrix3d turn = edges.cwiseInverse().asDiagonal();
    return {turn, -(turn * volume.origin)};
  }
  const Eigen::Matrix3d turn = volume.steps.inverse();
  return {turn, -(turn * volume.origin)};
}

BigArray<float> resample_grey(const UprightVolume& volume, const geometry::VoxelGrid& grid,
                              bool own_axes, const geometry::WorkReport& report) {
  const auto [low, high] = std::ranges::minmax(volume.components[0]);
  const VoxelMap map = map_to(volume, own_axes);
  BigArray<float> values = own_axes ? resample_straight(volume, grid, map, report)
                                    : resample_turned(volume, grid, map, low, report);
  for (float& value : values) {
    value = std::clamp(value, low, high);
  }
  return values;
}

std::vector<std::uint8_t> resample_labels(std::span<const std::uint8_t> labels,
                                          const UprightVolume& volume,
                                          const geometry::VoxelGrid& grid, bool own_axes,
                                          const geometry::WorkReport& report) {
  const VoxelMap map = map_to(volume, own_axes);
  const auto nx = static_cast<std::size_t>(volume.size[0]);
  const auto ny = static_cast<std::size_t>(volume.size[1]);
  const auto nearest = [&](const Eigen::Vector3d& at) -> std::uint8_t {
    for (int axis = 0; axis < 3; ++axis) {
      if (!within(at[axis], volume.size[static_cast<std::size_t>(axis)])) {
        return 0;
      }
    }
    std::array<std::size_t, 3> voxel{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      voxel[a] = static_cast<std::size_t>(
          std::clamp(static_cast<std::int32_t>(std::lround(at[axis])), 0, volume.size[a] - 1));
    }
    return labels[voxel[0] + nx * (voxel[1] + ny * voxel[2])];
  };
  std::array<int, 3> samples{};  // of a voxel along each axis
  int all = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double ratio = grid.spacing * map.turn.col(axis).norm();
    samples[static_cast<std::size_t>(axis)] =
        std::clamp(static_cast<int>(std::ceil(ratio - 1e-3)), 1, 16);
    all *= samples[static_cast<std::size_t>(axis)];
  }
  const auto label_at = [&](const Eigen::Vector3d& centre) -> std::uint8_t {
    if (all == 1) {
      return nearest(map.turn * centre + map.offset);
    }
    std::array<int, 256> votes{};
    int held = 0;
    for (int sample = 0; sample < all; ++sample) {
      const std::array<int, 3> at{sample % samples[0], sample / samples[0] % samples[1],
                                  sample / samples[0] / samples[1]};
      Eigen::Vector3d place = centre;
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        place[axis] += grid.spacing * ((at[a] + 0.5) / samples[a] - 0.5);
      }
      const std::uint8_t label = nearest(map.turn * place + map.offset);
      held += label != 0 ? 1 : 0;
      ++votes[label];
    }
    if (2 * held < all) {
      return 0;
    }
    int best = 1;
    for (int label = 2; label < 256; ++label) {
      best = votes[static_cast<std::size_t>(label)] >= votes[static_cast<std::size_t>(best)] ? label
                                                                                             : best;
    }
    return votes[static_cast<std::size_t>(best)] > 0 ? static_cast<std::uint8_t>(best) : 0;
  };
  std::vector<std::uint8_t> result(grid.count());
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    parallel_for(static_cast<std::size_t>(grid.size[1]), threads_or_all(0), [&](std::size_t row) {
      const auto j = static_cast<std::int32_t>(row);
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        result[grid.index(i, j, k)] = label_at(grid.centre(i, j, k));
      }
    });
    geometry::report_share(report, (k + 1.0) / grid.size[2]);
  }
  return result;
}

}  // namespace haptrial::bone
