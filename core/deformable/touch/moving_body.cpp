#include "core/deformable/touch/moving_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/deformable/springs/spring_tangent.h"
#include "core/deformable/touch/prepared.h"

namespace haptrial::deformable {
namespace {

/// A body of nothing yet.
std::shared_ptr<MovingBody> body_on(const SharedHapticMesh& mesh) {
  auto body = std::make_shared<MovingBody>();
  body->mesh = mesh;
  for (std::size_t v = 0; v < mesh->held.size(); ++v) {
    if (mesh->held[v] != 0) {
      body->held.push_back(static_cast<std::int32_t>(v));
    }
  }
  body->held.insert(body->held.end(), mesh->grasped.begin(), mesh->grasped.end());
  return body;
}

struct SteppedTissue {
  ImplicitTissue tissue;
  double step;  // [s]
  bool operator==(const SteppedTissue&) const = default;
};

std::shared_ptr<const MovingBody> made(const SharedHapticMesh& mesh, const SteppedTissue& stepped) {
  auto body = body_on(mesh);
  Elasticity elasticity = elasticity_of(*mesh, stepped.tissue.tissue);
  elasticity.law = Law::kNeoHookean;
  body->elements = std::make_shared<const ElasticBody>(mesh->tets, std::move(elasticity));
  ImplicitOptions options{stepped.step, stepped.tissue.decay, body->held, {}};
  std::set<std::int32_t> touched;
  for (const Face& face : mesh->felt) {
    touched.insert(face.begin(), face.end());
  }
  options.pressed.assign(touched.begin(), touched.end());
  body->implicit = std::make_shared<const ImplicitBody>(*body->elements, options);
  return body;
}

std::shared_ptr<const MovingBody> made(const SharedHapticMesh& mesh, const SpringTissue& tissue) {
  auto body = body_on(mesh);
  body->springs = spring_body(mesh->tets, tissue.density, tissue.constants, mesh->name);
  if (tissue.calibrated) {
    check_constants(body->springs, *tissue.calibrated);
    body->springs.constants = *tissue.calibrated;
  }
  const std::vector<double>& masses = body->springs.masses;
  const double mass = std::accumulate(masses.begin(), masses.end(), 0.0);
  body->drag = 2.0 * tissue.decay * mass / static_cast<double>(masses.size());
  body->stable_step = stable_step(body->springs, body->held);
  return body;
}

}  // namespace

SharedMovingBody prepared(const SharedHapticMesh& mesh, const SpringTissue& tissue) {
  static PreparedBodies<SpringTissue, MovingBody> bodies;
  return bodies.get({mesh, tissue}, [&] { return made(mesh, tissue); });
}

SharedMovingBody prepared(const SharedHapticMesh& mesh, const ImplicitTissue& tissue, double step) {
  static PreparedBodies<SteppedTissue, MovingBody> bodies;
  const SteppedTissue stepped{tissue, step};
  return bodies.get({mesh, stepped}, [&] {
    check_tissue(*mesh, tissue.tissue);
    check_memory(*mesh);
    return made(mesh, stepped);
  });
}

int steps_on_a_tick(const MovingBody& body, double period) {
  if (body.implicit) {
    return 1;
  }
  const double steps = std::ceil(period / (kStableShare * body.stable_step));
  if (!(steps <= kMostSteps)) {
    throw InputError(fmt::format(
        "{}: the longest stable step of its springs is {:.3g} s, so that a tick of {:g} s needs {} "
        "steps; at most {} are allowed: smaller constants, more density or fewer cells",
        body.mesh->name, body.stable_step, period, steps, kMostSteps));
  }
  return std::max(1, static_cast<int>(steps));
}

std::unique_ptr<BodyMotion> motion_of(const MovingBody& body, double period) {
  if (body.implicit) {
    return std::make_unique<ImplicitMotion>(body.implicit);
  }
  MotionSettings settings;
  settings.step = period / steps_on_a_tick(body, period);
  settings.damping = body.drag;
  settings.beyond_stability = true;  // within it, as steps_on_a_tick() sees to
  return std::make_unique<SpringMotion>(body.springs, settings, body.held);
}

}  // namespace haptrial::deformable
