#include "analysis/contact/exam/soft_score.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "analysis/contact/exam/soft_body.h"
#include "core/deformable/body/mesh_parts.h"

namespace haptrial::evaluation {
namespace {

using deformable::Vectors;
using Eigen::Vector3d;

/// A body that gives way is turned otherwise than a rigid one by less than this share.
constexpr double kSpinOfSoftness = 0.15;

/// A quarter of each tetrahedron's mass to its corners [kg].
std::vector<double> masses_of(const SoftBody& body) {
  std::vector<double> masses(body.mesh.vertices.size(), 0.0);
  const auto densities = deformable::densities(body.elasticity, body.mesh.tetrahedra.size());
  for (std::size_t t = 0; t < densities.size(); ++t) {
    for (const std::int32_t v : body.mesh.tetrahedra[t]) {
      masses[static_cast<std::size_t>(v)] +=
          densities[t] * deformable::six_volumes(body.mesh.vertices, body.mesh.tetrahedra[t]) /
          24.0;
    }
  }
  return masses;
}

void compare_shapes(const ExamCase& one, const std::vector<Answer>& answers, SoftScore& score) {
  double sum = 0.0, squares = 0.0, moved = 0.0;
  std::size_t count = 0;
  for (const std::size_t i : one.shape_samples) {
    const Vectors &truth = one.truth[i].shape, &shape = answers[i].shape;
    for (std::size_t v = 0; v < truth.size(); ++v, ++count) {
      const double away = (shape[v] - truth[v]).norm();
      sum += away;
      squares += away * away;
      moved += truth[v].squaredNorm();
      score.worst = std::max(score.worst, away);
    }
  }
  if (count > 0) {
    const auto n = static_cast<double>(count);
    score.mean = sum / n;
    score.root_mean_square = std::sqrt(squares / n);
    score.moved = std::sqrt(moved / n);
  }
}

bool is_inside_out(const SoftBody& body, const Vectors& shape) {
  auto places = body.mesh.vertices;
  for (std::size_t v = 0; v < places.size(); ++v) {
    places[v] += shape[v];
  }
  return std::ranges::any_of(body.mesh.tetrahedra, [&](const geometry::Tetrahedron& t) {
    return !(deformable::six_volumes(places, t) > 0.0);
  });
}

/// Energy that the body gives to its forces between the samples of its shape, by the mean of both
/// ends.
void add_load_energy(const ExamCase& one, const std::vector<Answer>& answers, const SoftBody& body,
                     SoftScore& score) {
  const auto& samples = one.shape_samples;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const std::size_t from = samples[k], to = samples[k + 1];
    double way = 0.0;
    for (const deformable::NodalForce& f : body.forces) {
      const auto v = static_cast<std::size_t>(f.vertex);
      way += f.force.dot(answers[to].shape[v] - answers[from].shape[v]);
    }
    const double given = -0.5 * (one.load[from] + one.load[to]) * way;
    score.load_energy += given;
    score.load_taken += std::max(0.0, -given);
  }
}

struct Momentum {
  Vector3d linear{Vector3d::Zero()};   // [kg·m/s]
  Vector3d angular{Vector3d::Zero()};  // about the centre of mass [kg·m²/s]
};

Momentum momentum_of(const SoftBody& body, const std::vector<double>& masses, const Vectors& from,
                     const Vectors& to, double period) {
  Momentum sum;
  Vector3d centre = Vector3d::Zero();
  double mass = 0.0;
  for (std::size_t v = 0; v < masses.size(); ++v) {
    mass += masses[v];
    centre += masses[v] * (body.mesh.vertices[v] + from[v]);
    const Vector3d p = masses[v] / period * (to[v] - from[v]);
    sum.linear += p;
    sum.angular += (body.mesh.vertices[v] + from[v]).cross(p);
  }
  sum.angular -= (centre / mass).cross(sum.linear);
  return sum;
}

/// The angular momentum about the centre of mass that the forces give to a rigid body of these
/// masses, by Euler's equations [kg·m²/s].
Vector3d rigid_spin(const ExamCase& one, const SoftBody& body, const std::vector<double>& masses) {
  double mass = 0.0;
  Vector3d centre = Vector3d::Zero();
  for (std::size_t v = 0; v < masses.size(); ++v) {
    mass += masses[v];
    centre += masses[v] * body.mesh.vertices[v];
  }
  centre /= mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t v = 0; v < masses.size(); ++v) {
    const Vector3d arm = body.mesh.vertices[v] - centre;
    inertia +=
        masses[v] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  const Eigen::Matrix3d inverse = inertia.inverse();
  constexpr int kSteps = 20;  // in a tick
  const double step = 1.0 / one.task.rate / kSteps;
  Vector3d spin = Vector3d::Zero();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < kSteps * one.load.size(); ++i) {
    for (const deformable::NodalForce& f : body.forces) {
      const Vector3d arm = body.mesh.vertices[static_cast<std::size_t>(f.vertex)] - centre;
      spin += step * one.load[i / kSteps] * (turn * arm).cross(f.force);
    }
    const Vector3d rate = turn * (inverse * (turn.transpose() * spin));
    turn = Eigen::AngleAxisd(rate.norm() * step, rate.normalized()) * turn;
  }
  return spin;
}

/// How far the vertices are from the shape at rest, moved and turned so that it fits best, as a
/// share of their distance from the middle; both in the root mean square.
double deformation(const SoftBody& body, const Vectors& shape) {
  const auto count = static_cast<Eigen::Index>(shape.size());
  Eigen::Matrix3Xd rest(3, count), now(3, count);
  for (Eigen::Index v = 0; v < count; ++v) {
    rest.col(v) = body.mesh.vertices[static_cast<std::size_t>(v)];
    now.col(v) = rest.col(v) + shape[static_cast<std::size_t>(v)];
  }
  const Eigen::Isometry3d fit(Eigen::umeyama(rest, now, false));
  const Eigen::Matrix3Xd away = now - fit * rest;
  return away.norm() / (rest.colwise() - rest.rowwise().mean()).norm();
}

double momentum_off(const ExamCase& one, const std::vector<Answer>& answers, const SoftBody& body) {
  const double period = 1.0 / one.task.rate;
  Vector3d given = Vector3d::Zero();
  for (const deformable::NodalForce& f : body.forces) {
    given += f.force;
  }
  double time = 0.0;
  for (const double load : one.load) {
    time += load * period;
  }
  given *= time;
  const std::vector<double> masses = masses_of(body);
  const Vector3d spin = rigid_spin(one, body, masses);
  double off = 0.0;
  Vector3d first = Vector3d::Zero();
  for (std::size_t k = 0; k + 1 < one.shape_samples.size(); ++k) {
    const Vectors& from = answers[one.shape_samples[k]].shape;
    const Momentum now =
        momentum_of(body, masses, from, answers[one.shape_samples[k + 1]].shape, period);
    first = k == 0 ? now.angular : first;
    off = std::max(off, (now.linear - given).norm() / given.norm());
    if (first.norm() > 0.0) {
      off = std::max(off, (now.angular - first).norm() / first.norm());
    }
    if (spin.norm() > 0.0) {
      off = std::max(off, (now.angular - spin).norm() / spin.norm() - kSpinOfSoftness);
    }
  }
  return off;
}

}  // namespace

SoftScore soft_score(const ExamCase& one, const std::vector<Answer>& answers) {
  const SoftBody body = read_soft_body(one.task.body);
  SoftScore score;
  score.tetrahedra = body.mesh.tetrahedra.size();
  compare_shapes(one, answers, score);
  for (const std::size_t i : one.shape_samples) {
    score.inside_out += is_inside_out(body, answers[i].shape) ? 1 : 0;
  }
  if (body.is_free()) {
    score.momentum_off = momentum_off(one, answers, body);
    for (const std::size_t i : one.shape_samples) {
      score.deformed = std::max(score.deformed, deformation(body, answers[i].shape));
    }
  } else {
    add_load_energy(one, answers, body, score);
  }
  return score;
}

}  // namespace haptrial::evaluation
