#pragma once

#include <Eigen/Geometry>

#include "core/base/definition/schema_forward.h"

namespace haptrial::subject {

/// Plan of an osteotomy: the cut, and where the fragment beyond it is to lie. All in W, with the
/// bone as it lies at the beginning.
struct FragmentPlan {
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};  // of the cut's plane, the middle of the cut [m]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitX()};  // of it, from the bone to the fragment, unit
  Eigen::Vector3d move{Eigen::Vector3d::Zero()};     // of the fragment, at `point` [m]
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};     // rotation vector about `point` [rad]

  /// The planned motion of the fragment, from W to W.
  Eigen::Isometry3d motion() const;
};

/// The keys of [osteotomy].
const Schema<FragmentPlan>& fragment_plan_schema();

/// The rotation of a rotation vector [rad].
Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn);

}  // namespace haptrial::subject
