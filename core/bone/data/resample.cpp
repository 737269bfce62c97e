#include "core/bone/data/resample.h"
#include "core/base/parallel.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
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

/// What voxels as coarse as the grid's can hold, at the volume's own places.
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

/// Any axes: 6 x 6 x 6 values for each voxel.
BigArray<float> resample_turned(const UprightVolume& volume, const geometry::VoxelGrid& grid,
                                const VoxelMap& map, float beyond,
                                const geometry::WorkReport& report) {
  const BigArray<float> source = smoothed(volume, grid.spacing);
  const auto nx = static_cast<std::size_t>(volume.size[0]);
  const auto ny = static_cast<std::size_t>(volume.size[1]);
  const auto value_at = [&](const Eigen::Vector3d& at) {
    std::array<Taps, 3> taps;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (!within(at[axis], volume.size[a])) {
        return beyond;
      }
      taps[a] = taps_at(at[axis], 1.0, volume.size[a]);
    }
    float sum = 0.0F;
    for (std::size_t k = 0; k < taps[2].weights.size(); ++k) {
      for (std::size_t j = 0; j < taps[1].weights.size(); ++j) {
        const std::size_t row = nx * (static_cast<std::size_t>(taps[1].first) + j +
                                      ny * (static_cast<std::size_t>(taps[2].first) + k));
        float along = 0.0F;
        for (std::size_t i = 0; i < taps[0].weights.size(); ++i) {
          along += taps[0].weights[i] * source[row + static_cast<std::size_t>(taps[0].first) + i];
        }
        sum += taps[2].weights[k] * taps[1].weights[j] * along;
      }
    }
    return sum;
  };
  BigArray<float> values(grid.count());
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    parallel_for(static_cast<std::size_t>(grid.size[1]), threads_or_all(0), [&](std::size_t row) {
      const auto j = static_cast<std::int32_t>(row);
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        values[grid.index(i, j, k)] = value_at(map.turn * grid.centre(i, j, k) + map.offset);
      }
    });
    geometry::report_share(report, (k + 1.0) / grid.size[2]);
  }
  return values;
}

/// Twice the angle's sine: from the identity to a rotation.
double angle_of(const Eigen::Matrix3d& rotation) { return Eigen::AngleAxisd(rotation).angle(); }

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

Pose pose_of(const UprightVolume& volume) {
  const Eigen::Matrix3d axes = square_axes(volume);
  const double spacing = std::cbrt(std::abs(volume.steps.determinant()));
  Pose pose;
  pose.turn = axes.determinant() > 0.0 ? angle_of(axes) : std::numbers::pi;
  const Eigen::Matrix3d off = volume.steps - spacing * axes;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d half;  // from the middle
    for (int axis = 0; axis < 3; ++axis) {
      half[axis] = (volume.size[static_cast<std::size_t>(axis)] - 1) *
                   ((corner >> axis) % 2 == 0 ? 0.5 : -0.5);
    }
    pose.shape = std::max(pose.shape, (off * half).norm() / spacing);
  }
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
