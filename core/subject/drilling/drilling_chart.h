#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace haptrial::subject {

/// Knowledge of a bone and of the cavity that is asked for, before anything is drilled: a chart of
/// columns that run into the bone, in the scene's frame W. A place is (u, v, w): along the chart's
/// axes, w the depth along `inward` [m].
struct DrillingChart {
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  Eigen::Vector3d corner{Eigen::Vector3d::Zero()};    // place (0, 0, 0), the middle of its column
  Eigen::Matrix3d axes{Eigen::Matrix3d::Identity()};  // columns: u, v, inward; orthonormal
  double cell{0.5e-3};                                // side of a column, height of a layer > 0 [m]
  std::array<int, 3> size{0, 0, 0};                   // columns along u and v, layers
  std::vector<float> surface;    // (u x v), u fastest: where bone is met first; kNone: nowhere [m]
  std::vector<float> clearance;  // (u x v x w): least distance to a structure, less the margin that
                                 // is to be kept from it; known up to a centimetre [m]
  Eigen::Vector3d end{Eigen::Vector3d::Zero()};  // (u, v, w) of the cavity's deepest place [m]
  double floor_radius{4e-3};                     // of the cavity there > 0 [m]
  double slope{0.6};                             // the cavity's radius grows so much with height

  std::size_t columns() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
  }
  std::size_t column(int i, int j) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(j);
  }
  Eigen::Vector3d place(const Eigen::Vector3d& p_W) const {
    return axes.transpose() * (p_W - corner);
  }
  Eigen::Vector3d world(const Eigen::Vector3d& place) const { return corner + axes * place; }
  /// Clearance at a place, linear between entries; far inside a structure outside of the chart. [m]
  float clearance_at(const Eigen::Vector3d& place) const noexcept;
};

/// How somebody sees the chart: all zero and one is as it is.
struct CavityView {
  Eigen::Vector3d offset{Eigen::Vector3d::Zero()};  // structures are believed so far off [m]
  Eigen::Vector2d shift{Eigen::Vector2d::Zero()};   // and the cavity's middle [m]
  double slope{1.0};                                // share of the chart's
  double extra{0.0};                                // margin beyond that asked for [m]
};

/// Down to where each column is to be drilled (u x v); its surface where it is to be left alone.
/// A column ends where a margin begins, where the cavity's side is met or at its end: nothing that
/// is to go lies under something that is to stay.
std::vector<float> cavity_floor(const DrillingChart& chart, const CavityView& view = {});

/// The same, as far as a burr that comes along `inward` gets.
struct BurrReach {
  std::vector<float> centre;  // (u x v): deepest place of its centre over a column [m]
  std::vector<float> floor;   // (u x v): how deep the bone can go
};
BurrReach burr_reach(const DrillingChart& chart, const std::vector<float>& floor, double radius);

}  // namespace haptrial::subject
