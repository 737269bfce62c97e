#include "analysis/contact/exam/exam_soft.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/deformable/elements/setup_body.h"
#include "core/deformable/elements/static_solver.h"

namespace haptrial::evaluation {
namespace {

using deformable::Material;
using deformable::Vectors;
using Eigen::Vector3d;
using Cells = std::array<int, 3>;

/// Cells of the exam's bodies, and their sizes [m].
struct Block {
  Cells cells;
  Vector3d size;
};

constexpr double kNear = 1e-9;  // [m]

const Block kBeam{{24, 4, 4}, {0.12, 0.02, 0.02}};
const Block kCube{{6, 6, 6}, {0.04, 0.04, 0.04}};
const Block kPlate{{15, 15, 2}, {0.06, 0.06, 0.006}};

/// A block of cells of five tetrahedra, its lowest corner at the origin.
SoftBody block_of(const Block& block, int fine, const Material& material) {
  SoftBody body;
  const Vector3d cells = fine * Vector3d(block.cells[0], block.cells[1], block.cells[2]);
  body.mesh = deformable::block_body(cells, static_cast<int>(cells.maxCoeff()));
  for (Vector3d& p : body.mesh.vertices) {
    p = p.array() * block.size.array() / cells.array();
  }
  body.elasticity.materials = {material};
  return body;
}

template <class At>
std::vector<std::int32_t> vertices_at(const SoftBody& body, At at) {
  std::vector<std::int32_t> found;
  for (std::size_t v = 0; v < body.mesh.vertices.size(); ++v) {
    if (at(body.mesh.vertices[v])) {
      found.push_back(static_cast<std::int32_t>(v));
    }
  }
  return found;
}

/// Forces on the vertices of a face that an even pull on it has: corners a quarter, edges a half.
template <class At>
void pull(SoftBody& body, const Block& block, int axis, const Vector3d& force, At at) {
  const std::vector<std::int32_t> face = vertices_at(body, at);
  std::vector<double> weight;
  double sum = 0.0;
  for (const std::int32_t v : face) {
    double w = 1.0;
    for (int a = 0; a < 3; ++a) {
      const double x = body.mesh.vertices[static_cast<std::size_t>(v)][a];
      w *= a != axis && (x < kNear || x > block.size[a] - kNear) ? 0.5 : 1.0;
    }
    weight.push_back(w);
    sum += w;
  }
  for (std::size_t i = 0; i < face.size(); ++i) {
    body.forces.push_back({face[i], weight[i] / sum * force});
  }
}

SoftBody clamped_beam(int fine) {
  SoftBody body = block_of(kBeam, fine, {1e6, 0.3, 1000.0});
  body.fixed = vertices_at(body, [](const Vector3d& p) { return p.x() < kNear; });
  return body;
}

bool at_tip(const Vector3d& p) { return p.x() > kBeam.size.x() - kNear; }

SoftBody gripped_beam(int fine) {
  SoftBody body = clamped_beam(fine);
  body.gripped = vertices_at(body, at_tip);
  return body;
}

SoftBody loaded_beam(int fine) {
  SoftBody body = clamped_beam(fine);
  pull(body, kBeam, 0, {0.0, 0.0, -0.5}, at_tip);
  return body;
}

SoftBody stood(SoftBody body, double height) {
  body.fixed = vertices_at(body, [](const Vector3d& p) { return p.z() < kNear; });
  body.gripped = vertices_at(body, [&](const Vector3d& p) { return p.z() > height - kNear; });
  return body;
}

SoftBody cube(int fine) {
  return stood(block_of(kCube, fine, {10e3, 0.45, 1000.0}), kCube.size.z());
}

/// Source: Morris 2006, Figure 41: soft above, twenty times as hard below.
SoftBody layers(int fine) {
  SoftBody body = block_of(kCube, fine, {10e3, 0.3, 1000.0});
  body.elasticity.materials.push_back({200e3, 0.3, 1000.0});
  for (const geometry::Tetrahedron& t : body.mesh.tetrahedra) {
    double z = 0.0;
    for (const std::int32_t v : t) {
      z += 0.25 * body.mesh.vertices[static_cast<std::size_t>(v)].z();
    }
    body.elasticity.material_of.push_back(z < 0.5 * kCube.size.z() ? 1 : 0);
  }
  return stood(std::move(body), kCube.size.z());
}

/// Held by two of its sides and pressed along a strip in the middle.
SoftBody plate(int fine) {
  SoftBody body = block_of(kPlate, fine, {300e3, 0.3, 1000.0});
  const double side = kPlate.size.x();
  body.fixed =
      vertices_at(body, [&](const Vector3d& p) { return p.x() < kNear || p.x() > side - kNear; });
  body.gripped = vertices_at(body, [&](const Vector3d& p) {
    return p.z() > kPlate.size.z() - kNear && std::abs(p.x() - 0.5 * side) < 0.11 * side &&
           std::abs(p.y() - 0.5 * side) < 0.11 * side;
  });
  return body;
}

Vector3d bent(double s) { return {-0.006 * s * s, 0.008 * s * s, -0.03 * s}; }
Vector3d still(double) { return Vector3d::Zero(); }
Vector3d pressed(double s) { return {0.006 * s * s, 0.0, -0.008 * s}; }
Vector3d dented(double s) { return {0.0, 0.0, -0.004 * s}; }
Vector3d pressed_less(double s) { return {0.004 * s * s, 0.0, -0.005 * s}; }
double all_of(double s) { return s; }
double none(double) { return 0.0; }

/// The number of a vertex in the exam's body, in one whose cells are 1 / fine as large.
std::vector<std::size_t> kept_vertices(const SoftBody& coarse, const SoftBody& fine) {
  const auto near = [](const Vector3d& p) {
    return std::array{std::lround(1e7 * p.z()), std::lround(1e7 * p.y()), std::lround(1e7 * p.x())};
  };
  std::vector<std::size_t> kept;
  std::size_t v = 0;  // both are numbered along x, then y, then z
  for (const Vector3d& p : coarse.mesh.vertices) {
    while (near(fine.mesh.vertices[v]) != near(p)) {
      ++v;
    }
    kept.push_back(v);
  }
  return kept;
}

/// Elements on the cells of a body, at the exam's vertices.
class RestedBody {
 public:
  RestedBody(const ExamSoft& one, int fine)
      : one_(one),
        body_(one.body(fine)),
        kept_(kept_vertices(one.body(1), body_)),
        elastic_(body_.mesh, body_.elasticity),
        solver_(elastic_) {}

  SoftRest at(double s) {
    const deformable::StaticResult rest =
        solver_.solve(load_case_of(body_, one_.tool(s), one_.load(s)));
    SoftRest seen;
    for (const std::int32_t v : body_.gripped) {
      seen.force += rest.elastic_force[static_cast<std::size_t>(v)];
    }
    for (const std::size_t v : kept_) {
      seen.shape.push_back(rest.displacement[v]);
    }
    return seen;
  }

 private:
  const ExamSoft& one_;
  SoftBody body_;
  std::vector<std::size_t> kept_;
  deformable::ElasticBody elastic_;
  deformable::StaticSolver solver_;
};

/// this = a this + b other
void combine(SoftRest& state, double a, double b, const SoftRest& other) {
  state.force = a * state.force + b * other.force;
  state.shape.resize(other.shape.size(), Vector3d::Zero());
  for (std::size_t v = 0; v < state.shape.size(); ++v) {
    state.shape[v] = a * state.shape[v] + b * other.shape[v];
  }
}

constexpr int kDegree = 6;

double node_of(int i) { return 0.5 * (1.0 - std::cos(std::numbers::pi * i / kDegree)); }

/// Weights of the values at the nodes in the polynomial at s (Berrut and Trefethen 2004, eq. 5.4).
std::array<double, kDegree + 1> weights_at(double s) {
  std::array<double, kDegree + 1> weight{};
  double sum = 0.0;
  for (int i = 0; i <= kDegree; ++i) {
    const double away = s - node_of(i);
    if (std::abs(away) < 1e-12) {
      weight = {};
      weight[static_cast<std::size_t>(i)] = 1.0;
      return weight;
    }
    const double share = (i % 2 == 0 ? 1.0 : -1.0) * (i == 0 || i == kDegree ? 0.5 : 1.0) / away;
    weight[static_cast<std::size_t>(i)] = share;
    sum += share;
  }
  for (double& w : weight) {
    w /= sum;
  }
  return weight;
}

}  // namespace

const std::vector<ExamSoft>& exam_softs() {
  static const std::vector<ExamSoft> softs{{"beam bent", gripped_beam, bent, none},
                                           {"beam loaded", loaded_beam, still, all_of},
                                           {"block pressed", cube, pressed, none},
                                           {"layers pressed", layers, pressed_less, none},
                                           {"plate dented", plate, dented, none}};
  return softs;
}

SoftBody free_block() {
  SoftBody body = block_of(kCube, 1, {10e3, 0.45, 1000.0});
  pull(body, kCube, 2, {0.8, 0.0, 0.0},
       [](const Vector3d& p) { return p.z() > kCube.size.z() - kNear; });
  return body;
}

double free_load(double time) {
  constexpr double kPushed = 0.1;  // [s]
  return time < kPushed ? std::pow(std::sin(std::numbers::pi * time / kPushed), 2) : 0.0;
}

SoftRest soft_rest(const ExamSoft& one, double s, int fine) { return RestedBody(one, fine).at(s); }

std::vector<SoftRest> true_softs(const ExamSoft& one, const std::vector<double>& s, int fine) {
  RestedBody coarse(one, fine), halved(one, 2 * fine);
  std::vector<SoftRest> nodes(kDegree + 1);
  for (int i = 1; i <= kDegree; ++i) {
    SoftRest& node = nodes[static_cast<std::size_t>(i)];
    node = halved.at(node_of(i));
    combine(node, 4.0 / 3.0, -1.0 / 3.0, coarse.at(node_of(i)));
  }
  nodes[0].shape.assign(nodes[1].shape.size(), Vector3d::Zero());
  std::vector<SoftRest> states;
  for (const double at : s) {
    const auto weight = weights_at(at);
    SoftRest state;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      combine(state, 1.0, weight[i], nodes[i]);
    }
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace haptrial::evaluation
