#include "analysis/contact/exam/soft_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "analysis/contact/exam/soft_body.h"
#include "core/deformable/calibration/calibrate.h"
#include "core/deformable/elements/implicit_motion.h"
#include "core/deformable/elements/static_solver.h"
#include "core/deformable/springs/spring_motion.h"
#include "core/deformable/springs/spring_tangent.h"

namespace haptrial::evaluation {
namespace {

using deformable::CalibrationLoad;
using deformable::LoadCase;
using deformable::SpringBody;
using deformable::Vectors;
using Eigen::Vector3d;

constexpr const char* kSprings = "springs";
constexpr const char* kImplicit = "implicit";
constexpr const char* kLinearElements = "linear-elements";

/// The force that a body's vertices exert on the tool.
template <class ForceOf>
Vector3d force_at_tool(const SoftBody& body, ForceOf force_of) {
  Vector3d sum = Vector3d::Zero();
  for (const std::int32_t v : body.gripped) {
    sum += force_of(static_cast<std::size_t>(v));
  }
  return sum;
}

/// Answers that are linear in the tool's place and in the load, each computed once. A body that
/// nothing holds has no rest, and stays where it is.
class LinearElements final : public Candidate {
 public:
  void begin(const ContactTask& task) override {
    body_ = read_soft_body(task.body);
    body_.elasticity.law = deformable::Law::kLinear;
    const deformable::ElasticBody elastic(body_.mesh, body_.elasticity);
    deformable::StaticSolver solver(elastic);
    for (int axis = 0; axis < 4; ++axis) {
      const bool acts = axis < 3 ? !body_.gripped.empty() : !body_.forces.empty();
      const LoadCase one = axis < 3 ? load_case_of(body_, kSmall * Vector3d::Unit(axis), 0.0)
                                    : load_case_of(body_, Vector3d::Zero(), 1.0);
      responses_[static_cast<std::size_t>(axis)] =
          acts && !body_.is_free() ? response(solver, one, axis < 3 ? kSmall : 1.0) : Response{};
    }
    shape_.assign(body_.mesh.vertices.size(), Vector3d::Zero());
  }
  void start(const Eigen::Isometry3d& tool) override { first_ = tool.translation(); }
  void set_load(double share) override { load_ = share; }
  Answer tick(double, const Eigen::Isometry3d& tool) override {
    const Vector3d moved = tool.translation() - first_;
    const std::array<double, 4> shares{moved.x(), moved.y(), moved.z(), load_};
    Answer answer;
    std::ranges::fill(shape_, Vector3d::Zero());
    for (std::size_t i = 0; i < shares.size(); ++i) {
      answer.force += shares[i] * responses_[i].force;
      for (std::size_t v = 0; v < responses_[i].shape.size(); ++v) {
        shape_[v] += shares[i] * responses_[i].shape[v];
      }
    }
    return answer;
  }
  Vectors shape() override { return shape_; }

 private:
  struct Response {
    Vector3d force{Vector3d::Zero()};
    Vectors shape;
  };
  static constexpr double kSmall = 1e-3;  // so that no tetrahedron turns inside out [m]

  Response response(deformable::StaticSolver& solver, const LoadCase& load, double size) const {
    deformable::StaticResult rest = solver.solve(load);
    Response found;
    found.force = force_at_tool(body_, [&](std::size_t v) { return rest.elastic_force[v]; }) / size;
    found.shape = std::move(rest.displacement);
    for (Vector3d& u : found.shape) {
      u /= size;
    }
    return found;
  }

  SoftBody body_;
  std::array<Response, 4> responses_;
  Vector3d first_{Vector3d::Zero()};  // of the tool [m]
  double load_{0.0};
  Vectors shape_;
};

/// The body with its grip let go, so that forces can be where the tool is; one that nothing holds
/// is held by a quarter of its vertices.
SoftBody held_for_calibration(SoftBody body) {
  body.forces.clear();
  if (body.fixed.empty()) {
    body.fixed.resize(body.mesh.vertices.size() / 4);
    std::iota(body.fixed.begin(), body.fixed.end(), 0);
  }
  return body;
}

/// Forces along the axes on the vertices that the tool or the exam's forces move, each so large
/// that linear elements move none by more than a twentieth of the body's extent; with the rests of
/// neo-Hookean elements.
std::vector<CalibrationLoad> calibration_loads(const SoftBody& body) {
  constexpr double kShare = 0.05;
  std::vector<std::int32_t> moved = body.gripped;
  if (moved.empty()) {
    std::ranges::transform(body.forces, std::back_inserter(moved), &deformable::NodalForce::vertex);
  }
  SoftBody held = held_for_calibration(body);
  held.gripped.clear();
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : body.mesh.vertices) {
    box.extend(p);
  }
  SoftBody linear = held;
  linear.elasticity.law = deformable::Law::kLinear;
  const deformable::ElasticBody weak(linear.mesh, linear.elasticity);
  const deformable::ElasticBody elements(held.mesh, held.elasticity);
  std::vector<CalibrationLoad> loads;
  for (int axis = 0; axis < 3; ++axis) {
    LoadCase load = load_case_of(held, Vector3d::Zero(), 0.0);
    load.name = "made";
    for (const std::int32_t v : moved) {
      load.forces.push_back({v, 1e-6 * Vector3d::Unit(axis)});
    }
    double most = 0.0;
    for (const Vector3d& u : deformable::solve_static(weak, load).displacement) {
      most = std::max(most, u.norm());
    }
    for (deformable::NodalForce& f : load.forces) {
      f.force *= kShare * box.sizes().maxCoeff() / most;
    }
    Vectors places = deformable::solve_static(elements, load).displacement;
    for (std::size_t v = 0; v < places.size(); ++v) {
      places[v] += body.mesh.vertices[v];
    }
    loads.push_back({load, std::move(places)});
  }
  return loads;
}

/// Three numbers for the body, shared out by the material around each spring.
deformable::SpringConstants calibrated(const SoftBody& body, const SpringBody& springs) {
  constexpr long kEvaluations = 12;
  std::vector<double> stiffness = springs.volumes;
  for (std::size_t t = 0; t < stiffness.size(); ++t) {
    stiffness[t] *= body.elasticity.materials[body.elasticity.material_of[t]].young;
  }
  const auto parameters =
      deformable::SpringParameters::uniform(springs).weighted(springs, stiffness);
  const double length = std::accumulate(springs.lengths.begin(), springs.lengths.end(), 0.0) /
                        static_cast<double>(springs.lengths.size());
  const double middle = std::log10(body.elasticity.materials[0].young * std::pow(length, 3));
  deformable::CalibrationSettings settings;
  settings.ranges.assign(parameters.size(), {middle - 5.0, middle + 3.0});
  settings.evaluations = kEvaluations;
  const deformable::CalibrationProblem problem(springs, calibration_loads(body));
  return parameters.constants(deformable::calibrate(problem, parameters, settings).logarithms);
}

/// A body that moves, its grip led along the tool's way in steps.
class MovingCandidate : public Candidate {
 public:
  void begin(const ContactTask& task) override {
    body_ = read_soft_body(task.body);
    held_ = body_.fixed;
    held_.insert(held_.end(), body_.gripped.begin(), body_.gripped.end());
    steps_ = prepare(task.rate);
  }
  void start(const Eigen::Isometry3d& tool) override {
    motion_ = motion();
    first_ = last_ = tool.translation();
  }
  void set_load(double share) override {
    Vectors sums(body_.mesh.vertices.size(), Vector3d::Zero());
    for (const deformable::NodalForce& f : body_.forces) {
      sums[static_cast<std::size_t>(f.vertex)] += share * f.force;
    }
    for (const deformable::NodalForce& f : body_.forces) {
      motion_->set_force(static_cast<std::size_t>(f.vertex),
                         sums[static_cast<std::size_t>(f.vertex)]);
    }
  }
  Answer tick(double, const Eigen::Isometry3d& tool) override {
    const Vector3d to = tool.translation();
    for (int i = 1; i <= steps_; ++i) {
      const Vector3d moved = last_ + (to - last_) * i / steps_ - first_;
      for (const std::int32_t v : body_.gripped) {
        const auto vertex = static_cast<std::size_t>(v);
        motion_->place(vertex, body_.mesh.vertices[vertex] + moved);
      }
      motion_->step();
      while (motion_->refine()) {
      }
    }
    last_ = to;
    Answer answer;
    answer.force = force_at_tool(body_, [&](std::size_t v) { return motion_->force(v); });
    return answer;
  }
  Vectors shape() override {
    Vectors shape = motion_->positions();
    for (std::size_t v = 0; v < shape.size(); ++v) {
      shape[v] -= body_.mesh.vertices[v];
    }
    return shape;
  }

 protected:
  SoftBody body_;
  std::vector<std::int32_t> held_;

 private:
  /// @returns steps on a tick
  virtual int prepare(double rate) = 0;
  /// The body at rest.
  virtual std::unique_ptr<deformable::BodyMotion> motion() const = 0;

  std::unique_ptr<deformable::BodyMotion> motion_;
  int steps_{1};                                               // on a tick
  Vector3d first_{Vector3d::Zero()}, last_{Vector3d::Zero()};  // of the tool [m]
};

class MovingSprings final : public MovingCandidate {
  static constexpr double kShareOfStable = 0.5;  // a body that is pressed is stiffer than at rest
  static constexpr double kDecay = 10.0;         // of a free motion [1/s]

  int prepare(double rate) override {
    springs_ = deformable::spring_body(
        body_.mesh, deformable::densities(body_.elasticity, body_.mesh.tetrahedra.size()),
        {1.0, 1.0, 1.0});
    springs_.constants = calibrated(body_, springs_);
    const double longest = kShareOfStable * deformable::stable_step(springs_, held_);
    const int steps = static_cast<int>(std::ceil(1.0 / (rate * longest)));
    const double mass = std::accumulate(springs_.masses.begin(), springs_.masses.end(), 0.0);
    settings_.step = 1.0 / (rate * steps);
    settings_.damping = 2.0 * kDecay * mass / static_cast<double>(springs_.masses.size());
    return steps;
  }
  std::unique_ptr<deformable::BodyMotion> motion() const override {
    return std::make_unique<deformable::SpringMotion>(springs_, settings_, held_);
  }

  SpringBody springs_;
  deformable::MotionSettings settings_;
};

class ImplicitElements final : public MovingCandidate {
  int prepare(double rate) override {
    const deformable::ElasticBody elastic(body_.mesh, body_.elasticity);
    implicit_ = std::make_shared<const deformable::ImplicitBody>(
        elastic, deformable::ImplicitOptions{1.0 / rate, 0.0, held_, {}});
    return 1;
  }
  std::unique_ptr<deformable::BodyMotion> motion() const override {
    return std::make_unique<deformable::ImplicitMotion>(implicit_);
  }

  std::shared_ptr<const deformable::ImplicitBody> implicit_;
};

}  // namespace

std::unique_ptr<Candidate> soft_candidate(const std::string& word) {
  if (word == kSprings) {
    return std::make_unique<MovingSprings>();
  }
  if (word == kImplicit) {
    return std::make_unique<ImplicitElements>();
  }
  return word == kLinearElements ? std::make_unique<LinearElements>() : nullptr;
}

std::vector<std::string> soft_candidate_words() { return {kSprings, kImplicit, kLinearElements}; }

}  // namespace haptrial::evaluation
