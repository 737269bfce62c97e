// A real cube of silicone: the inner beads between the end layers, which are moved as measured.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include "core/deformable/elements/static_solver.h"
#include "tests/support/mapped_block.h"
#include "tests/support/shared_data.h"
#include "tests/support/truth_cube.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using geometry::TetMesh;
using test::TruthCube;
using Lattice = std::array<std::int32_t, 3>;

/// The terms of a polynomial of x and y, in units of the cube's half side.
Eigen::VectorXd terms(double x, double y, int degree) {
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
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

/// A polynomial through what one layer of beads shows, by least squares.
class LayerFit {
 public:
  template <class Value>
  LayerFit(const TruthCube& cube, int layer, int degree, Value value) : degree_(degree) {
    std::vector<Eigen::VectorXd> rows;
    std::vector<Vector3d> values;
    for (const TruthCube::Bead& bead : cube.beads) {
      if (bead.place[2] != layer) {
        continue;
      }
      rows.push_back(terms(bead.rest.x(), bead.rest.y(), degree));
      values.push_back(value(bead));
    }
    Eigen::MatrixXd a(rows.size(), rows[0].size());
    Eigen::MatrixXd b(rows.size(), 3);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      a.row(static_cast<Eigen::Index>(i)) = rows[i];
      b.row(static_cast<Eigen::Index>(i)) = values[i];
    }
    factors_ = least_squares(a, b);
  }

  Vector3d operator()(double x, double y) const {
    return factors_.transpose() * terms(x, y, degree_);
  }

 private:
  int degree_;
  Eigen::MatrixXd factors_;
};

/// What lies between the end layers of beads, as wide as the cube.
struct CubeBody {
  Lattice cubes;
  TetMesh mesh;
};

CubeBody between_end_layers(const TruthCube& cube, std::int32_t across, int degree) {
  Vector3d middle = Vector3d::Zero();
  for (const TruthCube::Bead& bead : cube.beads) {
    middle += bead.rest / 343;
  }
  const auto rest = [](const TruthCube::Bead& bead) { return bead.rest; };
  const LayerFit low(cube, 7, degree, rest);
  const LayerFit high(cube, 1, degree, rest);
  const Lattice cubes{across, across, across * 3 / 4};  // 60 mm of 80
  return {cubes, test::mapped_block(cubes, [&](const Vector3d& s) {
            const double x = middle.x() + TruthCube::kSide * (s.x() - 0.5);
            const double y = middle.y() + TruthCube::kSide * (s.y() - 0.5);
            const double below = low(x, y).z();
            return Vector3d(x, y, below + s.z() * (high(x, y).z() - below));
          })};
}

LoadCase measured_ends(const TruthCube& cube, const CubeBody& body, std::size_t state, int degree) {
  LoadCase load{fmt::format("state {}", state + 1), {}, {}};
  const auto moved = [&](const TruthCube::Bead& bead) -> Vector3d {
    return bead.moved[state] - bead.rest;
  };
  const LayerFit low(cube, 7, degree, moved);
  const LayerFit high(cube, 1, degree, moved);
  for (const bool top : {false, true}) {
    for (const auto v : test::lattice_vertices(
             body.cubes, [&](const Lattice& at) { return at[2] == (top ? body.cubes[2] : 0); })) {
      const Vector3d& x = body.mesh.vertices[static_cast<std::size_t>(v)];
      load.holds.push_back({v, (top ? high : low)(x.x(), x.y())});
    }
  }
  return load;
}

/// The displacement at a point, linear in the tetrahedron that has it or comes nearest to it.
Vector3d displacement_at(const TetMesh& mesh, const Vectors& u, const Vector3d& point) {
  double best = -1e300;
  Vector3d found = Vector3d::Zero();
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    const auto at = [&](std::size_t i) { return static_cast<std::size_t>(t[i]); };
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) {
      edges.col(i) = mesh.vertices[at(static_cast<std::size_t>(i) + 1)] - mesh.vertices[at(0)];
    }
    const Vector3d w = edges.inverse() * (point - mesh.vertices[at(0)]);
    const double inside = std::min({w.minCoeff(), 1 - w.sum()});
    if (inside <= best) {
      continue;
    }
    best = inside;
    found = (1 - w.sum()) * u[at(0)] + w.x() * u[at(1)] + w.y() * u[at(2)] + w.z() * u[at(3)];
    if (best >= 0) {
      break;
    }
  }
  return found;
}

/// Root mean square distance of the inner beads from where elements put them [mm].
double bead_error(const TruthCube& cube, const CubeBody& body, const Vectors& u,
                  std::size_t state) {
  double squares = 0;
  int count = 0;
  for (const TruthCube::Bead& bead : cube.beads) {
    if (bead.at_an_end()) {
      continue;
    }
    const Vector3d expected = bead.rest + displacement_at(body.mesh, u, bead.rest);
    squares += (expected - bead.moved[state]).squaredNorm();
    ++count;
  }
  EXPECT_EQ(count, 245);
  return 1e3 * std::sqrt(squares / count);
}

/// The same for the affine map that fits all beads best: twelve numbers for each state.
double affine_error(const TruthCube& cube, std::size_t state) {
  const auto n = static_cast<Eigen::Index>(cube.beads.size());
  Eigen::MatrixXd a(n, 4);
  Eigen::MatrixXd b(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const TruthCube::Bead& bead = cube.beads[static_cast<std::size_t>(i)];
    a.row(i) << bead.rest.transpose(), 1;
    b.row(i) = bead.moved[state].transpose();
  }
  const Eigen::MatrixXd left = b - a * least_squares(a, b);
  return 1e3 * std::sqrt(left.squaredNorm() / static_cast<double>(n));
}

class TruthCubeTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto file = test::shared_data("deformable/truth_cube_uniaxial_mm.csv");
    if (!file) {
      GTEST_SKIP() << "the data of the Truth Cube are not there";
    }
    cube_ = test::read_truth_cube(*file);
    ASSERT_EQ(cube_.beads.size(), 343u);
  }

  /// Errors of the three states [mm].
  std::array<double, TruthCube::kStates> errors(Law law, std::int32_t across) const {
    constexpr int kDegree = 3;  // of the polynomials through the end layers, 49 beads each
    const CubeBody body = between_end_layers(cube_, across, kDegree);
    const ElasticBody elastic(body.mesh, Elasticity{{{15.3e3, 0.499, 980}}, {}, law});
    StaticSolver solver(elastic, {.tolerance = 1e-6});
    std::array<double, TruthCube::kStates> found{};
    for (std::size_t state = 0; state < TruthCube::kStates; ++state) {
      const StaticResult result = solver.solve(measured_ends(cube_, body, state, kDegree));
      found[state] = bead_error(cube_, body, result.displacement, state);
    }
    return found;
  }

  TruthCube cube_;
};

TEST_F(TruthCubeTest, TheFileRunsAlongTheAxesThatWeTake) {
  // Neighbours along i, j and k are about a centimetre apart along x, y and -z.
  for (const TruthCube::Bead& bead : cube_.beads) {
    const Vector3d expected(0.01 * (bead.place[0] - 4), 0.01 * (bead.place[1] - 4),
                            0.01 * (2.3 - bead.place[2]));
    EXPECT_LT((bead.rest - expected).norm(), 0.0055)
        << bead.place[0] << ' ' << bead.place[1] << ' ' << bead.place[2];
  }
}

TEST_F(TruthCubeTest, NeoHookeanElementsFindTheInnerBeads) {
  constexpr std::array<double, 3> kAllowed{0.34, 0.37, 0.41};  // [mm]; the beads' noise is 0.3
  const auto found = errors(Law::kNeoHookean, 8);
  for (std::size_t state = 0; state < TruthCube::kStates; ++state) {
    EXPECT_LT(found[state], kAllowed[state]) << state;
    EXPECT_LT(found[state], 0.95 * affine_error(cube_, state)) << state;
    EXPECT_GT(found[state], 0.29) << state << ": below the noise";
  }
}

TEST_F(TruthCubeTest, LawsOfSmallStrainsMissTheLargestOne) {
  const auto found = errors(Law::kCorotational, 8);
  EXPECT_GT(found[2], 1.5 * errors(Law::kNeoHookean, 8)[2]);
}

}  // namespace
}  // namespace haptrial::deformable
