#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/bvh/bvh_data.h"

namespace haptrial::geometry {
namespace {

constexpr double kFourPi = 4.0 * std::numbers::pi;

/// The solid angle of a triangle seen from a point, positive from behind (van Oosterom and Strackee
/// 1983).
double solid_angle(const Corners& corners, const Eigen::Vector3d& point) {
  const Eigen::Vector3d a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double volume = a.dot(b.cross(c));
  const double level = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  if (volume == 0.0) {
    return 0.0;
  }  // in the triangle's plane, or without area
  return 2.0 * std::atan2(volume, level);
}

/// Contribution of a child to its parent.
struct Cluster {
  Eigen::Vector3d area_vector{Eigen::Vector3d::Zero()};
  Eigen::Vector3d moment{Eigen::Vector3d::Zero()};  // centroids times areas
  double area{0.0};

  void operator+=(const Cluster& other) {
    area_vector += other.area_vector;
    moment += other.moment;
    area += other.area;
  }
};

/// Fills the dipoles of one subtree, the deepest nodes first.
class DipoleMaker {
 public:
  DipoleMaker(const BvhData& data, std::vector<Dipoles>& dipoles)
      : data_(data), dipoles_(dipoles) {}

  /// @param at  a node, or ~leaf
  Cluster make(std::int32_t at) {
    Cluster whole;
    for (int i = 0; i < kWidth; ++i) {
      if (at < 0) {
        if (data_.ids[~at * kWidth + i] >= 0) {
          whole += of_triangle(~at * kWidth + i);
        }
      } else if (!std::isinf(data_.nodes[at].boxes.low[0][i])) {
        const Cluster part = make(data_.nodes[at].child[i]);
        write(data_.nodes[at].boxes, i, part, dipoles_[at]);
        whole += part;
      }
    }
    return whole;
  }

 private:
  Cluster of_triangle(std::int32_t slot) const {
    const Corners& corners = data_.corners[slot];
    const Frame& frame = data_.frame;
    const Eigen::Vector3d a = frame.to_frame(corners[0]), b = frame.to_frame(corners[1]),
                          c = frame.to_frame(corners[2]);
    Cluster cluster;
    cluster.area_vector = 0.5 * (b - a).cross(c - a);
    cluster.area = cluster.area_vector.norm();
    cluster.moment = cluster.area * (a + b + c) / 3.0;
    return cluster;
  }

  static void write(const Boxes& boxes, int child, const Cluster& part, Dipoles& dipoles) {
    const Eigen::Vector3d low(boxes.low[0][child], boxes.low[1][child], boxes.low[2][child]);
    const Eigen::Vector3d high(boxes.high[0][child], boxes.high[1][child], boxes.high[2][child]);
    const Eigen::Vector3d centre =
        part.area > 0.0 ? Eigen::Vector3d(part.moment / part.area) : 0.5 * (low + high);
    const Eigen::Vector3d farthest = (centre - low).cwiseMax(high - centre);
    for (int axis = 0; axis < 3; ++axis) {
      dipoles.centre[axis][child] = static_cast<float>(centre[axis]);
      dipoles.vector[axis][child] = static_cast<float>(part.area_vector[axis]);
    }
    dipoles.radius[child] = static_cast<float>(farthest.norm()) + 1e-6f;
    dipoles.area[child] = static_cast<float>(part.area);
  }

  const BvhData& data_;
  std::vector<Dipoles>& dipoles_;
};

struct Winding {
  double number;
  double error;  // at most
};

/// A triangle of area A within r of a dipole's centre, R away from the point, adds A K(x) for a
/// kernel whose slope is at most 2 / |x|³; moved to the centre it errs by less than 2 A r / (R -
/// r)³.
Winding winding(const BvhData& data, const Eigen::Vector3d& point, double accuracy) {
  const std::vector<Dipoles>& all_dipoles = data.dipoles();
  const Eigen::Vector3f p = data.frame.to_frame(point).cast<float>();
  double sum = 0.0, error = 0.0;
  std::array<std::int32_t, kMaxDepth * kWidth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::int32_t at = stack[--top];
    const Node& node = data.nodes[at];
    const Dipoles& dipoles = all_dipoles[at];
    for (int i = 0; i < kWidth && !std::isinf(node.boxes.low[0][i]); ++i) {
      const float x = dipoles.centre[0][i] - p.x(), y = dipoles.centre[1][i] - p.y(),
                  z = dipoles.centre[2][i] - p.z();
      const float away_squared = x * x + y * y + z * z;
      const double reach = accuracy * dipoles.radius[i];
      if (away_squared > reach * reach) {
        const float away = std::sqrt(away_squared), gap = away - dipoles.radius[i];
        const float facing =
            x * dipoles.vector[0][i] + y * dipoles.vector[1][i] + z * dipoles.vector[2][i];
        sum += facing / (away_squared * away);
        constexpr float kRounding = 1e-5f;  // of single precision
        error += dipoles.area[i] *
                 (2.0f * dipoles.radius[i] / (gap * gap * gap) + kRounding / away_squared);
      } else if (node.child[i] < 0) {
        for (int k = 0; k < kWidth && data.ids[~node.child[i] * kWidth + k] >= 0; ++k) {
          sum += solid_angle(data.corners[~node.child[i] * kWidth + k], point);
        }
      } else {
        stack[top++] = node.child[i];
      }
    }
  }
  return {sum / kFourPi, error / kFourPi};
}

}  // namespace

const std::vector<Dipoles>& BvhData::dipoles() const {
  std::call_once(dipoles_made_, [this] {
    dipoles_.resize(nodes.size());
    DipoleMaker(*this, dipoles_).make(0);
  });
  return dipoles_;
}

double Bvh::winding_number(const Eigen::Vector3d& point, double accuracy) const {
  if (data_->nodes.empty() || !point.allFinite()) {
    return 0.0;
  }
  if (std::isfinite(accuracy)) {
    return winding(*data_, point, std::max(accuracy, 1.1)).number;
  }
  double sum = 0.0;
  for (const std::int32_t slot : data_->slots) {
    sum += solid_angle(data_->corners[slot], point);
  }
  return sum / kFourPi;
}

bool Bvh::winds_around(const Eigen::Vector3d& point) const {
  if (data_->nodes.empty() || !point.allFinite()) {
    return false;
  }
  for (const double accuracy : {4.0, 16.0}) {
    const Winding w = winding(*data_, point, accuracy);
    if (std::abs(w.number - 0.5) > w.error) {
      return w.number > 0.5;
    }
  }
  return winding_number(point, std::numeric_limits<double>::infinity()) > 0.5;
}

}  // namespace haptrial::geometry
