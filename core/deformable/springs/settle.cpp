#include "core/deformable/springs/settle.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

constexpr int kLookEvery = 4;   // steps
constexpr double kFar = 100.0;  // of the body's extent: where no body that holds together gets to

void check(const RestCriterion& criterion) {
  for (const double limit :
       {criterion.below.max_speed, criterion.below.mean_speed, criterion.below.max_acceleration,
        criterion.below.mean_acceleration, criterion.lasting, criterion.within}) {
    if (!std::isfinite(limit) || limit <= 0) {
      throw InputError(fmt::format("rest: a limit is {}; above 0 is allowed", limit));
    }
  }
}

bool below(const Activity& activity, const Activity& limits) {
  return activity.max_speed < limits.max_speed && activity.mean_speed < limits.mean_speed &&
         activity.max_acceleration < limits.max_acceleration &&
         activity.mean_acceleration < limits.mean_acceleration;
}

struct Box {
  Vector3d low, high;
};

Box reach_of(const SpringMotion& motion) {
  Box box{motion.position(0), motion.position(0)};
  for (std::size_t v = 1; v < motion.vertices(); ++v) {
    box.low = box.low.cwiseMin(motion.position(v));
    box.high = box.high.cwiseMax(motion.position(v));
  }
  const Vector3d margin = Vector3d::Constant(kFar * (box.high - box.low).norm());
  return {box.low - margin, box.high + margin};
}

bool within(const SpringMotion& motion, const Box& box) {
  for (std::size_t v = 0; v < motion.vertices(); ++v) {
    const Vector3d p = motion.position(v);
    // False also for what is not a number.
    if (!((p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all())) {
      return false;
    }
  }
  return true;
}

}  // namespace

RestResult settle(SpringMotion& motion, const RestCriterion& criterion) {
  check(criterion);
  const Box reach = reach_of(motion);
  const double begin = motion.time();
  const std::uint64_t first = motion.steps();
  double quiet_since = begin;
  RestResult result;
  while (motion.time() - begin < criterion.within) {
    for (int i = 0; i < kLookEvery; ++i) {
      motion.step();
    }
    if (!within(motion, reach)) {
      result.outcome = Settling::kUnstable;
      break;
    }
    if (!below(motion.activity(), criterion.below)) {
      quiet_since = motion.time();
    }
    if (motion.time() - quiet_since >= criterion.lasting) {
      result.outcome = Settling::kSettled;
      break;
    }
  }
  result.time = motion.time() - begin;
  result.steps = motion.steps() - first;
  result.inverted = motion.inverted();
  return result;
}

std::vector<std::int32_t> held_vertices(const LoadCase& load) {
  std::vector<std::int32_t> held;
  for (const Hold& hold : load.holds) {
    held.push_back(hold.vertex);
  }
  return held;
}

void apply(const LoadCase& load, const SpringBody& body, SpringMotion& motion) {
  std::map<std::size_t, Vector3d> forces;
  for (const Hold& hold : load.holds) {
    const auto vertex = static_cast<std::size_t>(hold.vertex);
    motion.place(vertex, body.rest[vertex] + hold.displacement);
  }
  for (const NodalForce& nodal : load.forces) {
    auto [at, fresh] = forces.try_emplace(static_cast<std::size_t>(nodal.vertex), Vector3d::Zero());
    at->second += nodal.force;
  }
  for (const auto& [vertex, force] : forces) {
    motion.set_force(vertex, force);
  }
}

}  // namespace haptrial::deformable
