#include "core/deformable/body/skin.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/base/error.h"

namespace haptrial::deformable {

NearestPoints::NearestPoints(std::vector<Eigen::Vector3d> points)
    : points_(std::move(points)), order_(points_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  split(0, order_.size(), 0);
}

void NearestPoints::split(std::size_t first, std::size_t last, int axis) {
  if (last - first < 2) {
    return;
  }
  const std::size_t middle = (first + last) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::int32_t a, std::int32_t b) {
    return points_[static_cast<std::size_t>(a)][axis] < points_[static_cast<std::size_t>(b)][axis];
  });
  split(first, middle, (axis + 1) % 3);
  split(middle + 1, last, (axis + 1) % 3);
}

void NearestPoints::find(const Eigen::Vector3d& place, std::size_t count,
                         std::vector<NearPoint>& nearest) const {
  nearest.clear();
  search(place, std::min(count, points_.size()), 0, order_.size(), 0, nearest);
}

void NearestPoints::search(const Eigen::Vector3d& place, std::size_t count, std::size_t first,
                           std::size_t last, int axis, std::vector<NearPoint>& nearest) const {
  if (first == last) {
    return;
  }
  const std::size_t middle = (first + last) / 2;
  const std::int32_t number = order_[middle];
  const Eigen::Vector3d& point = points_[static_cast<std::size_t>(number)];
  const NearPoint here{(place - point).squaredNorm(), number};
  if (nearest.size() < count || here < nearest.back()) {
    if (nearest.size() == count) {
      nearest.pop_back();
    }
    nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), here), here);
  }
  const double beyond = place[axis] - point[axis];
  const int next = (axis + 1) % 3;
  const auto low = [&] { search(place, count, first, middle, next, nearest); };
  const auto high = [&] { search(place, count, middle + 1, last, next, nearest); };
  beyond < 0 ? low() : high();
  if (nearest.size() < count || beyond * beyond <= nearest.back().square) {
    beyond < 0 ? high() : low();
  }
}

namespace {

using Eigen::Vector3d;

/// 1 / d², so that they sum to 1. Distances of 0 share everything.
std::vector<double> weights_of(const std::vector<NearPoint>& nearest) {
  std::vector<double> weights;
  double sum = 0;
  for (const NearPoint& point : nearest) {
    weights.push_back(point.square > 0 ? nearest.front().square / point.square : 1.0);
    sum += weights.back();
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

Vector3d along(const std::array<double, 4>& axis) { return {axis[0], axis[1], axis[2]}; }

void check(std::span<const Vector3d> skin, int neighbours, std::size_t frames) {
  if (neighbours < 1) {
    throw InputError(fmt::format("skin: {} neighbours; at least 1 is allowed", neighbours));
  }
  if (frames == 0) {
    throw InputError("skin: the body's surface has no vertex with a normal");
  }
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (!skin[v].allFinite()) {
      throw InputError(fmt::format("skin: vertex {} is not finite", v));
    }
  }
}

}  // namespace

Skin::Skin(std::span<const Vector3d> rest, std::span<const Face> surface,
           std::span<const Vector3d> skin, int neighbours)
    : frames_(rest, surface),
      vertices_((check(skin, neighbours, frames_.vertices().size()), skin.size())),
      neighbours_(std::min(static_cast<std::size_t>(neighbours), frames_.vertices().size())) {
  bind(skin);
  std::vector<std::int32_t> used(frame_.begin(), frame_.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  frames_.keep(used);
  for (std::int32_t& frame : frame_) {
    frame =
        static_cast<std::int32_t>(std::lower_bound(used.begin(), used.end(), frame) - used.begin());
  }
}

void Skin::bind(std::span<const Vector3d> skin) {
  std::vector<Vector3d> origins;
  for (const VertexFrames::Frame& frame : frames_.frames()) {
    origins.push_back(along(frame.origin));
  }
  const NearestPoints tree(std::move(origins));
  std::vector<NearPoint> near;
  for (const Vector3d& r : skin) {
    tree.find(r, neighbours_, near);
    const std::vector<double> weights = weights_of(near);
    for (std::size_t i = 0; i < neighbours_; ++i) {
      const VertexFrames::Frame& frame = frames_.frames()[static_cast<std::size_t>(near[i].number)];
      const Vector3d offset = weights[i] * (r - along(frame.origin));
      frame_.push_back(near[i].number);
      votes_.push_back(
          {weights[i],
           {along(frame.x).dot(offset), along(frame.y).dot(offset), along(frame.z).dot(offset)}});
    }
  }
}

void Skin::update(std::span<const Vector3d> positions, std::span<Vector3d> skin) noexcept {
  lost_frames_ = frames_.update(positions);
  const VertexFrames::Frame* frames = frames_.frames().data();
  const std::int32_t* number = frame_.data();
  const Vote* vote = votes_.data();
  for (std::size_t v = 0; v < vertices_; ++v) {
    double sum[4] = {};
    for (std::size_t i = 0; i < neighbours_; ++i, ++number, ++vote) {
      const VertexFrames::Frame& f = frames[*number];
      for (std::size_t axis = 0; axis < 4; ++axis) {
        sum[axis] += vote->weight * f.origin[axis] + vote->offset[0] * f.x[axis] +
                     vote->offset[1] * f.y[axis] + vote->offset[2] * f.z[axis];
      }
    }
    skin[v] = Vector3d(sum[0], sum[1], sum[2]);
  }
}

}  // namespace haptrial::deformable
