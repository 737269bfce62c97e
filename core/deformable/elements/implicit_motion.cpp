#include "core/deformable/elements/implicit_motion.h"

#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace haptrial::deformable {

using Eigen::Vector3d;

namespace {

using Row = MeshFactor::Row;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Stiffness of the elements at rest as H sees it; above 2 descent diverges.
constexpr double kMostStiffness = 1.2;
constexpr int kMostStiffenings = 8;
constexpr int kPowers = 40;  // of the power iteration that finds it
constexpr int kRoundsOfStep = 2;

std::size_t slot(std::int32_t i) { return static_cast<std::size_t>(i); }

Row row_of(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0.0F};
}

Vector3d vector_of(const Row& row) { return row.head<3>().matrix().cast<double>(); }

void check_implicit(const ImplicitOptions& options, std::size_t vertices) {
  if (!std::isfinite(options.step) || options.step <= 0.0) {
    throw InputError(
        fmt::format("an implicit body: the step is {} s; allowed: above 0", options.step));
  }
  if (!std::isfinite(options.decay) || options.decay < 0.0) {
    throw InputError(
        fmt::format("an implicit body: the decay is {} 1/s; allowed: at least 0", options.decay));
  }
  for (const auto* list : {&options.held, &options.pressed}) {
    for (const std::int32_t vertex : *list) {
      if (vertex < 0 || slot(vertex) >= vertices) {
        throw InputError(fmt::format("an implicit body: the vertex {} is not one of 0 to {}",
                                     vertex, vertices - 1));
      }
    }
  }
}

/// L between vertices that are free. @param free  place of each vertex; -1: held
Triplets laplacian(const ElasticBody& elastic, std::span<const std::int32_t> free) {
  const geometry::TetMesh& mesh = elastic.mesh();
  const Elasticity& elasticity = elastic.elasticity();
  Triplets entries;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const geometry::Tetrahedron& c = mesh.tetrahedra[t];
    const Moduli m = moduli(
        elasticity.materials[elasticity.material_of.empty() ? 0 : elasticity.material_of[t]]);
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) {
      edges.col(i) =
          mesh.vertices[slot(c[static_cast<std::size_t>(i) + 1])] - mesh.vertices[slot(c[0])];
    }
    Eigen::Matrix<double, 3, 4> b;
    b.rightCols<3>() = edges.inverse().transpose();
    b.col(0) = -b.rightCols<3>().rowwise().sum();
    const double stiff = (m.bulk + 4.0 / 3.0 * m.shear) * std::abs(edges.determinant()) / 6.0;
    const Eigen::Matrix4d block = stiff * b.transpose() * b;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        if (free[slot(c[i])] >= 0 && free[slot(c[j])] >= 0) {
          entries.emplace_back(free[slot(c[i])], free[slot(c[j])],
                               block(static_cast<int>(i), static_cast<int>(j)));
        }
      }
    }
  }
  return entries;
}

/// The largest stiffness of A as H sees it: of H⁻¹ A, by powers.
double largest_share(const BlockMatrix& a, const MeshFactor& h,
                     std::span<const std::int32_t> free) {
  Vectors x(free.size(), Vector3d::Zero()), y(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (free[v] >= 0) {  // any vector that no symmetry of a body has
      const auto angle = static_cast<double>(v);
      x[v] = {std::sin(angle), std::cos(2.3 * angle), std::sin(0.7 * angle + 1.0)};
    }
  }
  std::vector<Row> z(h.size());
  double share = 0.0;
  for (int i = 0; i < kPowers; ++i) {
    a.multiply(x, y);
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (free[v] >= 0) {
        z[h.place(slot(free[v]))] = row_of(y[v]);
      }
    }
    h.solve(z.data());
    double seen = 0.0, had = 0.0, size = 0.0;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (free[v] >= 0) {
        const Vector3d next = vector_of(z[h.place(slot(free[v]))]);
        seen += y[v].dot(next);
        had += y[v].dot(x[v]);
        size += next.squaredNorm();
        x[v] = next;
      }
    }
    share = seen / had;
    for (Vector3d& each : x) {
      each /= std::sqrt(size);
    }
  }
  return share;
}

}  // namespace

ImplicitBody::ImplicitBody(const ElasticBody& elastic, const ImplicitOptions& options)
    : options_((check_implicit(options, elastic.mesh().vertices.size()), options)),
      rest_(elastic.mesh().vertices.begin(), elastic.mesh().vertices.end()),
      masses_(elastic.masses().begin(), elastic.masses().end()),
      free_(rest_.size(), 0),
      column_(rest_.size(), -1),
      forces_(elastic) {
  for (const std::int32_t vertex : options_.held) {
    free_[slot(vertex)] = -1;
  }
  std::int32_t free = 0;
  for (std::int32_t& each : free_) {
    each = each < 0 ? -1 : free++;
  }
  std::erase_if(options_.pressed, [this](std::int32_t v) { return free_[slot(v)] < 0; });
  factorize(elastic);
  respond();
}

void ImplicitBody::factorize(const ElasticBody& elastic) {
  BlockMatrix stiffness(elastic.patches().groups(), rest_.size());
  Vectors none(rest_.size(), Vector3d::Zero()), forces;
  elastic.stiffness(none, forces, stiffness);
  std::vector<double> inertias = masses_;
  Triplets diagonal;
  for (std::size_t v = 0; v < rest_.size(); ++v) {
    inertias[v] *= inertia();
    if (free_[v] >= 0) {
      diagonal.emplace_back(free_[v], free_[v], inertias[v]);
    }
  }
  stiffness.scale_and_add(1.0, inertias);
  const auto n = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SparseMatrix<double> inertia(n, n), springs(n, n);
  inertia.setFromTriplets(diagonal.begin(), diagonal.end());
  const Triplets entries = laplacian(elastic, free_);
  springs.setFromTriplets(entries.begin(), entries.end());
  for (int i = 0; i < kMostStiffenings; ++i) {
    factor_ =
        std::make_unique<MeshFactor>(Eigen::SparseMatrix<double>(stiffening_ * springs + inertia));
    const double share = largest_share(stiffness, *factor_, free_);
    if (share <= kMostStiffness) {
      break;
    }
    stiffening_ *= share / kMostStiffness + 0.05;
  }
}

void ImplicitBody::respond() {
  std::vector<Row> room(factor_->size());
  responses_.reserve(options_.pressed.size() * rest_.size());
  for (const std::int32_t pressed : options_.pressed) {
    column_[slot(pressed)] = static_cast<std::int32_t>(responses_.size() / rest_.size());
    std::ranges::fill(room, Row::Zero());
    room[factor_->place(slot(free_[slot(pressed)]))] = row_of(Vector3d::UnitX());
    factor_->solve(room.data());
    for (const std::int32_t free : free_) {
      responses_.push_back(free < 0 ? 0.0F : room[factor_->place(slot(free))][0]);
    }
  }
}

ImplicitMotion::ImplicitMotion(std::shared_ptr<const ImplicitBody> body)
    : BodyMotion({body->masses().begin(), body->masses().end()},
                 PaddedPoints(body->masses().size()), body->options().held),
      body_(std::move(body)),
      elements_(body_->forces()),
      inertia_(body_->inertia()),
      before_(vertices()),
      predicted_(vertices()),
      pushes_(vertices()),
      room_(body_->factor().size()) {
  for (std::size_t v = 0; v < vertices(); ++v) {
    positions_[v] = before_[v] = body_->rest()[v];
  }
}

void ImplicitMotion::step() noexcept {
  const double h = body_->options().step;
  const double keep = 1.0 / (h * h * inertia_);
  for (std::size_t v = 0; v < vertices(); ++v) {
    before_[v] = positions_[v];
    if (!held(v)) {
      positions_[v] += keep * h * velocities_[v];
    }
    predicted_[v] = positions_[v];
  }
  round_ = 0;
  refine();
}

bool ImplicitMotion::refine() noexcept {
  if (round_ == kRoundsOfStep) {
    return false;
  }
  ++round_;
  descend();
  set_velocities();
  return true;
}

/// A round: all vertices go to the least of what H makes of the energy.
void ImplicitMotion::descend() noexcept {
  for (std::size_t v = 0; v < vertices(); ++v) {
    forces_[v] = external_[v];
  }
  count_inverted(elements_.add(positions_, forces_));
  const MeshFactor& factor = body_->factor();
  for (std::size_t v = 0; v < vertices(); ++v) {
    if (!held(v)) {
      room_[factor.place(slot(body_->free(v)))] =
          row_of(inertia_ * masses_[v] * (predicted_[v] - positions_[v]) + forces_[v]);
    }
  }
  factor.solve(room_.data());
  for (std::size_t v = 0; v < vertices(); ++v) {
    if (!held(v)) {
      positions_[v] += vector_of(room_[factor.place(slot(body_->free(v)))]);
    }
  }
}

void ImplicitMotion::set_velocities() noexcept {
  for (std::size_t v = 0; v < vertices(); ++v) {
    if (!held(v)) {
      velocities_[v] = (positions_[v] - before_[v]) / body_->options().step;
    }
  }
}

void ImplicitMotion::push(std::size_t vertex, const Vector3d& force) noexcept {
  const std::span<const float> response = body_->response(vertex);
  if (response.empty()) {
    return;
  }
  pushes_[vertex] += force;
  for (const std::int32_t each : body_->options().pressed) {
    positions_[slot(each)] += static_cast<double>(response[slot(each)]) * force;
  }
}

void ImplicitMotion::finish_pushes() noexcept {
  for (const std::int32_t pushed : body_->options().pressed) {
    const Vector3d force = pushes_[slot(pushed)];
    if (force.isZero(0.0)) {
      continue;
    }
    const std::span<const float> response = body_->response(slot(pushed));
    for (std::size_t v = 0; v < vertices(); ++v) {
      if (body_->response(v).empty()) {
        positions_[v] += static_cast<double>(response[v]) * force;
      }
    }
  }
  for (const std::int32_t pushed : body_->options().pressed) {
    pushes_[slot(pushed)].setZero();
  }
  set_velocities();
}

}  // namespace haptrial::deformable
