#pragma once

#include <fmt/format.h>

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "tests/support/mapped_block.h"
#include "tests/support/truth_cube.h"

namespace haptrial::test {

using CubeLattice = std::array<std::int32_t, 3>;

/// The terms of a polynomial of x and y, in units of the cube's half side.
inline Eigen::VectorXd layer_terms(double x, double y, int degree) {
  std::vector<double> found;
  x /= 0.5 * TruthCube::kSide;
  y /= 0.5 * TruthCube::kSide;
  for (int a = 0; a <= degree; ++a) {
    for (int b = 0; a + b <= degree; ++b) {
      found.push_back(std::pow(x, a) * std::pow(y, b));
    }
  }
  return Eigen::Map<Eigen::VectorXd>(found.data(), static_cast<Eigen::Index>(found.size()));
}

/// The x of least |a x - b|; Eigen's templates of it compile slowly, hence once.
inline Eigen::MatrixXd best_fit(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

/// A polynomial through what one layer of beads shows, by least squares.
class LayerFit {
 public:
  template <class Value>
  LayerFit(const TruthCube& cube, int layer, int degree, Value value) : degree_(degree) {
    std::vector<Eigen::VectorXd> rows;
    std::vector<Eigen::Vector3d> values;
    for (const TruthCube::Bead& bead : cube.beads) {
      if (bead.place[2] != layer) {
        continue;
      }
      rows.push_back(layer_terms(bead.rest.x(), bead.rest.y(), degree));
      values.push_back(value(bead));
    }
    Eigen::MatrixXd a(rows.size(), rows[0].size());
    Eigen::MatrixXd b(rows.size(), 3);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      a.row(static_cast<Eigen::Index>(i)) = rows[i];
      b.row(static_cast<Eigen::Index>(i)) = values[i];
    }
    factors_ = best_fit(a, b);
  }

  Eigen::Vector3d operator()(double x, double y) const {
    return factors_.transpose() * layer_terms(x, y, degree_);
  }

 private:
  int degree_;
  Eigen::MatrixXd factors_;
};

/// Body between the end layers of beads, as wide as the cube.
struct CubeBody {
  CubeLattice cubes;
  geometry::TetMesh mesh;
};

inline CubeBody between_end_layers(const TruthCube& cube, std::int32_t across, int degree) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const TruthCube::Bead& bead : cube.beads) {
    middle += bead.rest / 343;
  }
  const auto rest = [](const TruthCube::Bead& bead) { return bead.rest; };
  const LayerFit low(cube, 7, degree, rest);
  const LayerFit high(cube, 1, degree, rest);
  const CubeLattice cubes{across, across, across * 3 / 4};  // 60 mm of 80
  return {cubes, mapped_block(cubes, [&](const Eigen::Vector3d& s) {
            const double x = middle.x() + TruthCube::kSide * (s.x() - 0.5);
            const double y = middle.y() + TruthCube::kSide * (s.y() - 0.5);
            const double below = low(x, y).z();
            return Eigen::Vector3d(x, y, below + s.z() * (high(x, y).z() - below));
          })};
}

inline deformable::LoadCase measured_ends(const TruthCube& cube, const CubeBody& body,
                                          std::size_t state, int degree) {
  deformable::LoadCase load{fmt::format("state {}", state + 1), {}, {}};
  const auto moved = [&](const TruthCube::Bead& bead) -> Eigen::Vector3d {
    return bead.moved[state] - bead.rest;
  };
  const LayerFit low(cube, 7, degree, moved);
  const LayerFit high(cube, 1, degree, moved);
  for (const bool top : {false, true}) {
    for (const auto v : lattice_vertices(body.cubes, [&](const CubeLattice& at) {
           return at[2] == (top ? body.cubes[2] : 0);
         })) {
      const Eigen::Vector3d& x = body.mesh.vertices[static_cast<std::size_t>(v)];
      load.holds.push_back({v, (top ? high : low)(x.x(), x.y())});
    }
  }
  return load;
}

/// Root mean square distance of the beads from the affine map that fits them best, twelve numbers
/// for each state [mm].
inline double affine_error(const TruthCube& cube, std::size_t state) {
  const auto n = static_cast<Eigen::Index>(cube.beads.size());
  Eigen::MatrixXd a(n, 4);
  Eigen::MatrixXd b(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const TruthCube::Bead& bead = cube.beads[static_cast<std::size_t>(i)];
    a.row(i) << bead.rest.transpose(), 1;
    b.row(i) = bead.moved[state].transpose();
  }
  const Eigen::MatrixXd left = b - a * best_fit(a, b);
  return 1e3 * std::sqrt(left.squaredNorm() / static_cast<double>(n));
}

}  // namespace haptrial::test
