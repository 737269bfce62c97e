// Limits of finer meshes: Lamé's sphere, Timoshenko's cantilever, Cook's membrane.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/deformable/elements/static_solver.h"
#include "tests/support/even_strain.h"
#include "tests/support/mapped_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using geometry::TetMesh;
using Lattice = std::array<std::int32_t, 3>;

/// Lamé: a thick sphere under pressure p inside moves outwards by a r + b / r².
struct LameSphere {
  Material material;
  double inner{0.01};
  double outer{0.02};
  double pressure{1000};

  double moved(double r) const {
    const Moduli m = moduli(material);
    const double a3 = std::pow(inner, 3);
    const double b3 = std::pow(outer, 3);
    return pressure * a3 / (b3 - a3) * (r / (3 * m.bulk) + b3 / (4 * m.shear * r * r));
  }
};

/// The root mean square error beside that of the displacement, on a sixth of the sphere in
/// 2n x 2n x n cubes, which is moved as it should at its four sides, pressed inside and free
/// outside.
double lame_error(const LameSphere& sphere, VolumeForm volume, std::int32_t n) {
  const Lattice cubes{2 * n, 2 * n, n};
  const TetMesh mesh = test::mapped_block(cubes, [&](const Vector3d& x) -> Vector3d {
    const auto angle = [](double s) { return std::tan(M_PI / 4 * (2 * s - 1)); };
    const double r = sphere.inner + x.z() * (sphere.outer - sphere.inner);
    return r * Vector3d(angle(x.x()), angle(x.y()), 1).normalized();
  });
  LoadCase load{"pressure", {}, {}};
  const auto truth = [&](const Vector3d& x) -> Vector3d {
    return sphere.moved(x.norm()) * x.normalized();
  };
  for (const std::int32_t v : test::lattice_vertices(cubes, [&](const Lattice& at) {
         return at[0] % cubes[0] == 0 || at[1] % cubes[1] == 0;
       })) {
    load.holds.push_back({v, truth(mesh.vertices[static_cast<std::size_t>(v)])});
  }
  const auto layer = static_cast<std::int32_t>((2 * n + 1) * (2 * n + 1));
  for (const Face& face : mesh_parts(mesh.tetrahedra).surface) {
    if (face[0] >= layer || face[1] >= layer || face[2] >= layer) {
      continue;
    }
    const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(face[i])]; };
    const Vector3d push = -sphere.pressure / 6 * (at(1) - at(0)).cross(at(2) - at(0));
    for (const std::int32_t v : face) {
      load.forces.push_back({v, push});
    }
  }
  const ElasticBody body(mesh, Elasticity{{sphere.material}, {}, Law::kLinear, volume});
  const Vectors u = solve_static(body, load, {.tolerance = 1e-9}).displacement;
  double squares = 0;
  double whole = 0;
  for (std::size_t v = 0; v < u.size(); ++v) {
    squares += (u[v] - truth(mesh.vertices[v])).squaredNorm();
    whole += truth(mesh.vertices[v]).squaredNorm();
  }
  return std::sqrt(squares / whole);
}

TEST(LameTest, TheErrorFallsWithTheSquareOfTheSize) {
  for (const VolumeForm volume : {VolumeForm::kTetrahedra, VolumeForm::kPatches}) {
    const LameSphere sphere{{1e5, 0.3, 1000}};
    const double coarse = lame_error(sphere, volume, 4);
    const double fine = lame_error(sphere, volume, 8);
    EXPECT_GT(std::log2(coarse / fine), 1.7) << coarse << ' ' << fine;
    EXPECT_LT(fine, 0.01);
  }
}

TEST(LameTest, PatchesDoNotLockNearIncompressibility) {
  const LameSphere sphere{{1e5, 0.499, 1000}};
  const double coarse = lame_error(sphere, VolumeForm::kPatches, 4);
  const double fine = lame_error(sphere, VolumeForm::kPatches, 8);
  EXPECT_GT(std::log2(coarse / fine), 1.2) << coarse << ' ' << fine;
  EXPECT_LT(fine, 0.01);
  EXPECT_GT(lame_error(sphere, VolumeForm::kTetrahedra, 8), 5 * fine);
}

/// How far the end of a cantilever of n cubes across moves [m]: ten times as long as thick.
double cantilever_tip(std::int32_t n, const Material& material, VolumeForm volume) {
  const Lattice cubes{10 * n, n, n};
  const TetMesh mesh = test::mapped_block(
      cubes, [](const Vector3d& x) { return Vector3d(0.1 * x.x(), 0.01 * x.y(), 0.01 * x.z()); });
  LoadCase load{"tip", {}, {}};
  for (const auto v : test::lattice_vertices(cubes, [](const Lattice& at) { return at[0] == 0; })) {
    load.holds.push_back({v, Vector3d::Zero()});
  }
  const auto tip =
      test::lattice_vertices(cubes, [&](const Lattice& at) { return at[0] == cubes[0]; });
  double weights = 0;
  const auto weight = [&](std::int32_t v) {  // of an even shear: corners a quarter, edges a half
    const Vector3d& x = mesh.vertices[static_cast<std::size_t>(v)];
    const auto half = [](double y) { return y < 1e-9 || y > 0.01 - 1e-9 ? 0.5 : 1.0; };
    return half(x.y()) * half(x.z());
  };
  for (const auto v : tip) {
    weights += weight(v);
  }
  for (const auto v : tip) {
    load.forces.push_back({v, {0, 0, -1e-3 * weight(v) / weights}});
  }
  const ElasticBody body(mesh, Elasticity{{material}, {}, Law::kLinear, volume});
  const Vectors u = solve_static(body, load).displacement;
  double sum = 0;
  for (const auto v : tip) {
    sum += u[static_cast<std::size_t>(v)].z() * weight(v) / weights;
  }
  return -sum;
}

/// Timoshenko: F L³ / (3 E I) + F L / (k A G), k = 10 (1 + nu) / (12 + 11 nu).
double timoshenko_tip(const Material& m) {
  const double force = 1e-3, length = 0.1, side = 0.01;
  const double k = 10 * (1 + m.poisson) / (12 + 11 * m.poisson);
  return force * std::pow(length, 3) / (3 * m.young * std::pow(side, 4) / 12) +
         force * length / (k * side * side * moduli(m).shear);
}

TEST(CantileverTest, ConvergesToTimoshenko) {
  const Material material{1e5, 0.3, 1000};
  const double truth = timoshenko_tip(material);
  const double coarse = cantilever_tip(2, material, VolumeForm::kTetrahedra) / truth;
  const double middle = cantilever_tip(4, material, VolumeForm::kTetrahedra) / truth;
  const double fine = cantilever_tip(8, material, VolumeForm::kTetrahedra) / truth;
  EXPECT_GT(std::log2((middle - coarse) / (fine - middle)), 1.3);
  const double limit = fine + (fine - middle) * (fine - middle) / (middle - coarse - fine + middle);
  EXPECT_NEAR(limit, 1, 0.02);  // the theory of beams leaves out how the held end is clamped
}

TEST(CantileverTest, PatchesBendAt0499AsTetrahedraDoAt03) {
  const Material rubber{1e5, 0.499, 1000};
  const Material cork{1e5, 0.3, 1000};
  for (const std::int32_t n : {2, 4}) {
    const double patches = cantilever_tip(n, rubber, VolumeForm::kPatches) / timoshenko_tip(rubber);
    const double locked =
        cantilever_tip(n, rubber, VolumeForm::kTetrahedra) / timoshenko_tip(rubber);
    const double soft = cantilever_tip(n, cork, VolumeForm::kTetrahedra) / timoshenko_tip(cork);
    EXPECT_GT(patches, soft) << n;
    EXPECT_LT(patches, 1) << n;
    EXPECT_LT(locked, 0.92 * soft) << n;
  }
}

/// Cook's membrane as a body 10 mm thick: 48 mm long, 44 mm high at the held end, 16 mm at the
/// other, which is pulled along itself. @returns how far its upper corner moves [m]
struct Membrane {
  double corner{};
  double alternating{};  // share of the pressure that changes its sign from cube to cube
};

Membrane cook(std::int32_t n, double poisson, VolumeForm volume) {
  const Lattice cubes{4 * n, 4 * n, n};
  const TetMesh mesh = test::mapped_block(cubes, [](const Vector3d& x) {
    const double low = 0.044 * x.x();
    const double high = 0.044 + 0.016 * x.x();
    return Vector3d(0.048 * x.x(), low + x.y() * (high - low), 0.010 * x.z());
  });
  LoadCase load{"shear", {}, {}};
  for (const auto v : test::lattice_vertices(cubes, [](const Lattice& at) { return at[0] == 0; })) {
    load.holds.push_back({v, Vector3d::Zero()});
  }
  constexpr double kTraction = 1e3;  // [Pa]
  for (const Face& face : mesh_parts(mesh.tetrahedra).surface) {
    const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(face[i])]; };
    if (std::min({at(0).x(), at(1).x(), at(2).x()}) < 0.048 - 1e-9) {
      continue;
    }
    const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    for (const std::int32_t v : face) {
      load.forces.push_back({v, {0, kTraction * area / 3, 0}});
    }
  }
  const ElasticBody body(mesh, Elasticity{{{1e5, poisson, 1000}}, {}, Law::kLinear, volume});
  const Vectors u = solve_static(body, load).displacement;
  Membrane result;
  for (const auto v : test::lattice_vertices(
           cubes, [&](const Lattice& at) { return at[0] == cubes[0] && at[1] == cubes[1]; })) {
    result.corner += u[static_cast<std::size_t>(v)].y() / (n + 1);
  }
  if (volume == VolumeForm::kPatches) {
    const std::vector<double> strain = body.volume_strains(u);
    double sum = 0, squares = 0;
    std::size_t cube = 0;
    for (int k = 0; k < cubes[2]; ++k) {
      for (int j = 0; j < cubes[1]; ++j) {
        for (int i = 0; i < cubes[0]; ++i, ++cube) {
          sum += (i + j + k) % 2 == 0 ? strain[cube] : -strain[cube];
          squares += strain[cube] * strain[cube];
        }
      }
    }
    const auto count = static_cast<double>(strain.size());
    result.alternating = std::abs(sum / count) / std::sqrt(squares / count);
  }
  return result;
}

TEST(CookTest, PatchesConvergeAt0499WhereTetrahedraLock) {
  // CalculiX with 20-node bricks (C3D20R), 14 x 14 x 4 of them; 8 x 8 x 2 give 3.913 mm.
  constexpr double kTruth = 3.951e-3;  // [m]
  double before = 1;
  for (const std::int32_t n : {1, 2, 4}) {
    const Membrane patches = cook(n, 0.499, VolumeForm::kPatches);
    const double error = 1 - patches.corner / kTruth;
    EXPECT_GT(error, 0) << n;  // from the stiff side
    EXPECT_LT(error, 0.5 * before) << n;
    EXPECT_GT(1 - cook(n, 0.499, VolumeForm::kTetrahedra).corner / kTruth, 1.5 * error) << n;
    if (n > 1) {
      EXPECT_LT(patches.alternating, 0.01) << n;
    }
    before = error;
  }
  EXPECT_LT(before, 0.06);
}

}  // namespace
}  // namespace haptrial::deformable
