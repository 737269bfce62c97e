#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/bvh/bvh_kernel.h"

namespace haptrial::geometry {
namespace {

/// A point's place along a curve through the cells of a cube, and which point it is.
struct Place {
  std::uint32_t code;
  std::uint32_t index;
};

/// Ten bits with two zeros after each.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ff;
  bits = (bits | bits << 8) & 0x0300f00f;
  bits = (bits | bits << 4) & 0x030c30c3;
  return (bits | bits << 2) & 0x09249249;
}

/// The points along a Morton curve; where they are far apart or not finite any order will do.
std::vector<Place> places_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Array3d low = Eigen::Array3d::Constant(1e100), high = -low;
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite() || point.cwiseAbs().maxCoeff() > 1e100) {
      continue;
    }
    low = low.min(point.array());
    high = high.max(point.array());
  }
  const double side = (high - low).maxCoeff();
  const double scale = side > 0.0 ? 1023.0 / side : 0.0;
  std::vector<Place> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = (points[i][axis] - low[axis]) * scale;
      code |= spread(cell > 0.0 ? static_cast<std::uint32_t>(std::min(cell, 1023.0)) : 0) << axis;
    }
    places[i] = {code, static_cast<std::uint32_t>(i)};
  }
  return places;
}

/// Sorts by code, ten bits at a time from the lowest; equal ones keep their order.
void sort(std::vector<Place>& places) {
  constexpr int kBits = 10;
  std::vector<Place> sorted(places.size());
  for (int shift = 0; shift < 3 * kBits; shift += kBits) {
    std::array<std::uint32_t, (1 << kBits) + 1> start{};
    const auto digit = [&](const Place& p) { return (p.code >> shift) & ((1u << kBits) - 1); };
    for (const Place& place : places) {
      ++start[digit(place) + 1];
    }
    for (std::size_t i = 1; i < start.size(); ++i) {
      start[i] += start[i - 1];
    }
    for (const Place& place : places) {
      sorted[start[digit(place)]++] = place;
    }
    places.swap(sorted);
  }
}

}  // namespace

void Bvh::closest(std::span<const Eigen::Vector3d> points, std::span<ClosestPoint> answers) const {
  if (points.size() != answers.size()) {
    throw std::invalid_argument("Bvh::closest: as many answers as points are needed");
  }
  if (points.size() > 0xffffffff) {
    throw std::invalid_argument("Bvh::closest: over 2^32 points");
  }
  if (data_->nodes.empty()) {
    std::fill(answers.begin(), answers.end(), ClosestPoint());
    return;
  }
  std::vector<Place> places = places_of(points);
  sort(places);
  constexpr std::size_t kBlock = 512;
  std::array<Eigen::Vector3d, kBlock> block_points;
  std::array<ClosestPoint, kBlock> block_answers;
  for (std::size_t first = 0; first < places.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, places.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      block_points[i] = points[places[first + i].index];
    }
    data_->kernels->many(*data_, block_points.data(), count, block_answers.data());
    for (std::size_t i = 0; i < count; ++i) {
      answers[places[first + i].index] = block_answers[i];
    }
  }
}

}  // namespace haptrial::geometry
