#include "core/subject/drilling/fragment_plan.h"

#include "core/base/definition/schema.h"
#include "core/base/definition/table_vector.h"

namespace haptrial::subject {

const Schema<FragmentPlan>& fragment_plan_schema() {
  using P = FragmentPlan;
  static const auto schema =
      Schema<P>()
          .vector("point", &P::point, {-1.0, 1.0}, "m",
                  "Middle of the planned cut, in the world, as the bone lies at the beginning")
          .required()
          .direction("normal", &P::normal,
                     "Direction across the planned cut, from the bone to the fragment")
          .required()
          .vector("move", &P::move, {-0.1, 0.1}, "m",
                  "Planned displacement of the fragment at the cut, in the world")
          .otherwise("none")
          .vector("turn", &P::turn, {-3.0, 3.0}, "rad",
                  "Planned rotation of the fragment about the middle of the cut, as a vector along "
                  "its axis, in the world")
          .otherwise("none");
  return schema;
}

Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                     : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

Eigen::Isometry3d FragmentPlan::motion() const {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotation_by(turn);
  motion.translation() = point + move - motion.linear() * point;
  return motion;
}

}  // namespace haptrial::subject
