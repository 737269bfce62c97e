// The same meshes in CalculiX, whose .dat file prints seven digits.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "core/deformable/elements/static_solver.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/voxelize.h"
#include "tests/core/deformable/elements/calculix.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using geometry::TetMesh;

constexpr double kPounds50 = 222.4;  // [N]

struct Problem {
  TetMesh mesh;
  LoadCase load;
  Material material;
};

/// Ten times as long as thick, one end held, a force across on the other.
Problem beam(double force) {
  Problem p{test::solid_block({20, 2, 2}, 0.005), {"tip", {}, {}}, {1e5, 0.3, 1000}};
  for (std::size_t v = 0; v < p.mesh.vertices.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (p.mesh.vertices[v].x() < 1e-9) {
      p.load.holds.push_back({vertex, Vector3d::Zero()});
    }
    if (p.mesh.vertices[v].x() > 0.1 - 1e-9) {
      p.load.forces.push_back({vertex, {0, 0, force / 9}});
    }
  }
  return p;
}

/// Source: Morris 2006, §5.3.4 and Figure 34: a gear 2 m wide, its base held, two opposing forces
/// at its front that twist it.
Problem gear(double force) {
  const geometry::Mesh surface = geometry::make_gear(
      {.teeth = 12, .tip_radius = 1, .root_radius = 0.75, .bore_radius = 0.3, .thickness = 0.5});
  Problem p{{}, {"twist", {}, {}}, {1e5, 0.45, 1000}};
  p.mesh = geometry::tetrahedralize(geometry::voxelize(
      surface, geometry::make_grid(geometry::bounds(surface), 12), geometry::InsideRule::kParity));
  double low = 0, high = 0;
  std::int32_t left = 0, right = 0;
  const auto& x = p.mesh.vertices;
  for (const Vector3d& v : x) {
    low = std::min(low, v.z());
    high = std::max(high, v.z());
  }
  for (std::size_t v = 0; v < x.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (x[v].z() < low + 1e-9) {
      p.load.holds.push_back({vertex, Vector3d::Zero()});
    }
    if (x[v].z() < high - 1e-9) {
      continue;
    }
    if (x[v].x() < x[static_cast<std::size_t>(left)].x()) {
      left = vertex;
    }
    if (x[v].x() > x[static_cast<std::size_t>(right)].x()) {
      right = vertex;
    }
  }
  p.load.forces = {{left, {0, force, 0}}, {right, {0, -force, 0}}};
  return p;
}

/// Compares with CalculiX to the seventh digit that it prints of each number.
/// @param units  of that digit that the two may be apart
void expect_as_calculix(const Problem& p, Law law, int increments, double units = 1) {
  const ElasticBody body(p.mesh, Elasticity{{p.material}, {}, law, VolumeForm::kTetrahedra});
  const Vectors ours = solve_static(body, p.load, {.tolerance = 1e-11}).displacement;
  const Vectors theirs = calculix::displacements(body, p.load, increments);
  double largest = 0;
  for (const Vector3d& u : theirs) {
    largest = std::max(largest, u.cwiseAbs().maxCoeff());
  }
  double worst = 0;  // in units of a number's seventh digit
  std::string where;
  for (std::size_t v = 0; v < ours.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const double printed = theirs[v][axis];
      const double digit =
          printed == 0 ? 0 : std::pow(10, std::floor(std::log10(std::abs(printed))) - 6);
      // Numbers that are nearly nothing beside the largest have no seven digits to share.
      const double off = std::abs(ours[v][axis] - printed) / std::max(digit, 1e-8 * largest);
      if (off <= worst) {
        continue;
      }
      worst = off;
      where = fmt::format("vertex {} axis {}: {:.9e}, CalculiX {:.6e}, largest {:.3e}", v, axis,
                          ours[v][axis], printed, largest);
    }
  }
  EXPECT_LE(worst, units) << "units of the seventh digit at " << where;
  EXPECT_GT(largest, 0);
}

TEST(CalculixTest, LinearBeam) { expect_as_calculix(beam(0.02), Law::kLinear, 1); }
TEST(CalculixTest, LinearGear) { expect_as_calculix(gear(kPounds50), Law::kLinear, 1); }
TEST(CalculixTest, NeoHookeanBeam) {
  // The end moves by 84 % of the beam's length: 2.6e-7 apart in each number, whatever the tolerance
  // of either; KINSOL (KinsolTest) agrees with ours to 1e-8.
  expect_as_calculix(beam(0.1), Law::kNeoHookean, 8, 3);
}
TEST(CalculixTest, NeoHookeanGear) { expect_as_calculix(gear(kPounds50), Law::kNeoHookean, 4); }

}  // namespace
}  // namespace haptrial::deformable
