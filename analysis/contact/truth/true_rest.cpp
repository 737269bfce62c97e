#include "analysis/contact/truth/true_rest.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace haptrial::evaluation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kExact = 1e-9;  // of a corner in a half-space [m]

/// The turn from one orientation to another as a vector, in W [rad].
Vector3d turn_between(const Isometry3d& from, const Isometry3d& to) {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  return turn.angle() * turn.axis();
}

/// A corner in a half-space.
struct Bound {
  double spare;    // that it is within; below 0: beyond [m]
  Vector3d lever;  // of the corner, in W [m]
  Vector3d normal;

  Vector6 by_step() const {
    Vector6 slope;
    slope << normal, lever.cross(normal);
    return slope;
  }
  /// How the slope follows from a turn.
  Eigen::Matrix3d by_turns() const {
    const Eigen::Matrix3d product = normal * lever.transpose();
    return 0.5 * (product + product.transpose()) - normal.dot(lever) * Eigen::Matrix3d::Identity();
  }
};

class Rest {
 public:
  Rest(const std::vector<Vector3d>& corners, std::span<const HalfSpace> free,
       const HandSprings& springs, const Isometry3d& first)
      : corners_(corners), free_(free), springs_(springs), tool_(first) {
    multipliers_.assign(corners.size() * free.size(), 0.0);
  }

  TrueRest at(const Isometry3d& hand) {
    constexpr int kMostRounds = 200;
    for (int round = 0; round < kMostRounds; ++round) {
      descend(hand);
      if (renew_multipliers() < kExact) {
        break;
      }
    }
    return {tool_, springs_.stiffness * (tool_.translation() - hand.translation()),
            springs_.turning_stiffness * turn_between(hand, tool_)};
  }

 private:
  /// To the least of the springs' energy and the penalties of the present multipliers: Newton's
  /// method, with shorter steps where the whole one does not go down.
  void descend(const Isometry3d& hand) {
    constexpr int kMostSteps = 100;
    constexpr double kSmall = 1e-13;  // [m], [rad]
    double before = energy(tool_, hand);
    for (int i = 0; i < kMostSteps; ++i) {
      Vector6 step = step_towards(hand);
      Isometry3d next = moved(tool_, step);
      double after = energy(next, hand);
      while (after > before && step.cwiseAbs().maxCoeff() > kSmall) {
        step *= 0.5;
        next = moved(tool_, step);
        after = energy(next, hand);
      }
      if (step.cwiseAbs().maxCoeff() <= kSmall) {
        return;
      }
      tool_ = next;
      before = after;
    }
  }

  double energy(const Isometry3d& tool, const Isometry3d& hand) const {
    double sum =
        0.5 * springs_.stiffness * (tool.translation() - hand.translation()).squaredNorm() +
        0.5 * springs_.turning_stiffness * turn_between(hand, tool).squaredNorm();
    for_each_bound(tool, [&](const Bound& bound, double multiplier) {
      const double force = std::max(0.0, multiplier - penalty() * bound.spare);
      sum += 0.5 / penalty() * force * force;
    });
    return sum;
  }

  Vector6 step_towards(const Isometry3d& hand) const {
    Matrix6 stiffness = Matrix6::Zero();
    stiffness.diagonal() << Vector3d::Constant(springs_.stiffness),
        Vector3d::Constant(springs_.turning_stiffness);
    Eigen::Matrix3d bent = Eigen::Matrix3d::Zero();
    Vector6 push;
    push << springs_.stiffness * (hand.translation() - tool_.translation()),
        springs_.turning_stiffness * turn_between(tool_, hand);
    for_each_bound(tool_, [&](const Bound& bound, double multiplier) {
      const double force = multiplier - penalty() * bound.spare;
      if (force > 0.0) {
        const Vector6 slope = bound.by_step();
        push += force * slope;
        stiffness += penalty() * slope * slope.transpose();
        bent -= force * bound.by_turns();
      }
    });
    Matrix6 whole = stiffness;
    whole.bottomRightCorner<3, 3>() += bent;
    const Eigen::LLT<Matrix6> curved(whole);
    return curved.info() == Eigen::Success ? Vector6(curved.solve(push))
                                           : Vector6(stiffness.llt().solve(push));
  }

  /// @returns how far a corner is beyond a half-space, or within one that still pushes it [m]
  double renew_multipliers() {
    double worst = 0.0;
    for_each_bound(tool_, [&](const Bound& bound, double& multiplier) {
      const double force = std::max(0.0, multiplier - penalty() * bound.spare);
      worst = std::max({worst, -bound.spare, std::abs(force - multiplier) / penalty()});
      multiplier = force;
    });
    return worst;
  }

  double penalty() const { return 40.0 * springs_.stiffness; }  // [N/m]

  template <class Use>
  void for_each_bound(const Isometry3d& tool, const Use& use) const {
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      const Vector3d lever = tool.linear() * corners_[c];
      const Vector3d at = tool.translation() + lever;
      for (std::size_t h = 0; h < free_.size(); ++h) {
        use(Bound{free_[h].normal.dot(at) - free_[h].offset, lever, free_[h].normal},
            multipliers_[c * free_.size() + h]);
      }
    }
  }

  static Isometry3d moved(const Isometry3d& tool, const Vector6& step) {
    Isometry3d next = tool;
    const Vector3d turn = step.tail<3>();
    if (const double angle = turn.norm(); angle > 0.0) {
      const Eigen::AngleAxisd about(angle, turn / angle);
      next.linear() = Eigen::Quaterniond(about * tool.linear()).normalized().toRotationMatrix();
    }
    next.translation() += step.head<3>();
    return next;
  }

  const std::vector<Vector3d>& corners_;
  std::span<const HalfSpace> free_;
  HandSprings springs_;
  Isometry3d tool_;
  mutable std::vector<double> multipliers_;  // by corner and half-space: forces [N]
};

}  // namespace

std::vector<TrueRest> true_rests(const std::vector<Vector3d>& corners,
                                 std::span<const HalfSpace> free, std::span<const Isometry3d> hand,
                                 const HandSprings& springs) {
  std::vector<TrueRest> rests;
  if (hand.empty()) {
    return rests;
  }
  Rest rest(corners, free, springs, hand.front());
  for (const Isometry3d& pose : hand) {
    rests.push_back(rest.at(pose));
  }
  return rests;
}

}  // namespace haptrial::evaluation
