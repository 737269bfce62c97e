// Patch tests and the exact cases of each law: uniaxial, biaxial, simple shear.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "core/deformable/elements/static_solver.h"
#include "tests/support/even_strain.h"
#include "tests/support/jittered_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSize = 0.01;

struct EvenCase {
  Law law;
  double poisson;
  VolumeForm volume;

  friend void PrintTo(const EvenCase& c, std::ostream* out) {
    *out << name_of(c.law) << ' ' << c.poisson
         << (c.volume == VolumeForm::kPatches ? " patches" : " tetrahedra");
  }
};

/// Principal Piola stresses for principal stretches, from each law's energy written in stretches.
Vector3d principal_stress(Law law, const Moduli& m, const Vector3d& stretch) {
  const Vector3d strain = stretch - Vector3d::Ones();
  if (law != Law::kNeoHookean) {  // without a turn the corotational law is the linear one
    const double lambda = m.bulk - 2.0 / 3 * m.shear;
    return 2 * m.shear * strain + Vector3d::Constant(lambda * strain.sum());
  }
  const double j = stretch.prod();
  const double i1 = stretch.squaredNorm();
  const Vector3d inverse = stretch.cwiseInverse();
  return m.shear * std::pow(j, -2.0 / 3) * (stretch - i1 / 3 * inverse) +
         m.bulk * (j - 1) * j * inverse;
}

/// The stretch of the free directions at which their stress vanishes, by bisection.
double free_stretch(Law law, const Moduli& m, double along, int free_directions) {
  double low = 0.3;
  double high = 2;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    const Vector3d stretch(along, free_directions == 2 ? mid : along, mid);
    (principal_stress(law, m, stretch).z() > 0 ? high : low) = mid;
  }
  return 0.5 * (low + high);
}

class EvenStrainTest : public testing::TestWithParam<EvenCase> {
 protected:
  ElasticBody body() const {
    const Elasticity elasticity{{material_}, {}, GetParam().law, GetParam().volume};
    return ElasticBody(mesh_, elasticity);
  }

  double farthest(const Matrix3d& f, const Matrix3d& piola,
                  const std::vector<std::int32_t>& held) const {
    const LoadCase load = test::even_load(mesh_, f, piola, held);
    const StaticResult result =
        solve_static(body(), load, {.tolerance = 1e-13, .solver = LinearSolver::kCholesky});
    return test::farthest_from_even(mesh_, result.displacement, f);
  }

  void expect_stretched(const Vector3d& stretch) {
    const Vector3d stress = principal_stress(GetParam().law, moduli(material_), stretch);
    const auto last = static_cast<std::int32_t>(mesh_.vertices.size()) - 1;
    EXPECT_LE(farthest(stretch.asDiagonal(), stress.asDiagonal(), {0, 1, last}), allowed());
  }

  /// Rounding, by how much stiffer the volume is than the form.
  double allowed() const {
    const Moduli m = moduli(material_);
    return 1e-13 * kSize * (10 + m.bulk / m.shear);
  }

  Material material_{1.5e4, GetParam().poisson, 1000};
  geometry::TetMesh mesh_ = test::jittered_block({3, 2, 2}, 0.005, 0.1);
};

TEST_P(EvenStrainTest, AnEvenlyMovedBoundaryMovesTheInsideEvenly) {
  mesh_ = test::jittered_block({3, 3, 3}, 0.003, 0.1);
  Matrix3d f;
  f << 1.1, 0.2, -0.1, 0.05, 0.9, 0.1, 0, -0.15, 1.05;
  LoadCase load{"moved", {}, {}};
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    if (mesh_.on_surface[v] == 0) {
      continue;
    }
    load.holds.push_back(
        {static_cast<std::int32_t>(v), (f - Matrix3d::Identity()) * mesh_.vertices[v]});
  }
  ASSERT_EQ(mesh_.vertices.size() - load.holds.size(), 8u);
  const StaticResult result =
      solve_static(body(), load, {.tolerance = 1e-13, .solver = LinearSolver::kCholesky});
  EXPECT_LE(test::farthest_from_even(mesh_, result.displacement, f), allowed());
}

TEST_P(EvenStrainTest, UniaxialIsExact) {
  const double along = 1.3;
  const double across = free_stretch(GetParam().law, moduli(material_), along, 2);
  if (GetParam().law == Law::kLinear) {
    EXPECT_NEAR(across, 1 - material_.poisson * (along - 1), 1e-12);
    EXPECT_NEAR(principal_stress(Law::kLinear, moduli(material_), {along, across, across}).x(),
                material_.young * (along - 1), 1e-8);
  }
  expect_stretched({along, across, across});
}

TEST_P(EvenStrainTest, BiaxialIsExact) {
  const double along = 1.15;
  expect_stretched({along, along, free_stretch(GetParam().law, moduli(material_), along, 1)});
}

TEST_P(EvenStrainTest, SimpleShearIsExact) {
  const double shear = 0.4;
  const Moduli m = moduli(material_);
  Matrix3d f = Matrix3d::Identity();
  f(0, 1) = shear;
  Matrix3d piola = Matrix3d::Zero();
  if (GetParam().law == Law::kLinear) {
    piola(0, 1) = piola(1, 0) = m.shear * shear;
  } else if (GetParam().law == Law::kCorotational) {
    // The turn of a simple shear is by atan(shear / 2).
    const Matrix3d r = Eigen::AngleAxisd(-std::atan(shear / 2), Vector3d::UnitZ()).matrix();
    const Matrix3d strain = r.transpose() * f - Matrix3d::Identity();
    ASSERT_LE((strain - strain.transpose()).norm(), 1e-15);
    piola = r * (2 * m.shear * strain +
                 (m.bulk - 2.0 / 3 * m.shear) * strain.trace() * Matrix3d::Identity());
  } else {
    piola = m.shear * (f - (3 + shear * shear) / 3 * f.inverse().transpose());
  }
  // Held along its bottom: forces that do not turn with the body leave it unstable otherwise.
  std::vector<std::int32_t> bottom(4 * 3);
  std::iota(bottom.begin(), bottom.end(), 0);
  EXPECT_LE(farthest(f, piola, bottom), allowed());
}

INSTANTIATE_TEST_SUITE_P(Laws, EvenStrainTest,
                         testing::Values(EvenCase{Law::kLinear, 0.3, VolumeForm::kTetrahedra},
                                         EvenCase{Law::kLinear, 0.499, VolumeForm::kPatches},
                                         EvenCase{Law::kCorotational, 0.3, VolumeForm::kTetrahedra},
                                         EvenCase{Law::kCorotational, 0.45, VolumeForm::kPatches},
                                         EvenCase{Law::kNeoHookean, 0.3, VolumeForm::kTetrahedra},
                                         EvenCase{Law::kNeoHookean, 0.499, VolumeForm::kPatches}));

}  // namespace
}  // namespace haptrial::deformable
