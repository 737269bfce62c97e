#include "core/deformable/springs/spring_energies.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/deformable/springs/spring_hessian.h"
#include "tests/support/force_law.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using test::expect_force_law;
using test::leak_of;

constexpr double kStep = 1e-7;  // of differences, for points some centimetres apart [m]
constexpr int kShapes = 50;

class SpringEnergiesTest : public testing::Test {
 protected:
  template <std::size_t n>
  std::array<Vector3d, n> some_points() {
    std::array<Vector3d, n> points;
    for (Vector3d& p : points) {
      p = {random_.uniform(-0.02, 0.02), random_.uniform(-0.02, 0.02),
           random_.uniform(-0.02, 0.02)};
    }
    return points;
  }
  RandomStream random_{3, "springs"};
};

TEST_F(SpringEnergiesTest, ALengthObeysTheLaw) {
  const Spring spring{0.3, 0.015};
  for (int i = 0; i < kShapes; ++i) {
    expect_force_law<2>([&](const Points2& p) { return length_energy(spring, p); },
                        [&](const Points2& p) { return length_forces(spring, p); },
                        some_points<2>(), kStep);
  }
}

TEST_F(SpringEnergiesTest, AnAreaObeysTheLaw) {
  const Spring spring{0.3, 1.5e-4};
  for (int i = 0; i < kShapes; ++i) {
    expect_force_law<3>([&](const Points3& p) { return area_energy(spring, p); },
                        [&](const Points3& p) { return area_forces(spring, p, ForceForm::kExact); },
                        some_points<3>(), kStep);
  }
}

TEST_F(SpringEnergiesTest, AVolumeObeysTheLawAlsoInsideOut) {
  const Spring spring{0.3, 1e-6};
  int inside_out = 0;
  for (int i = 0; i < kShapes; ++i) {
    const Points4 points = some_points<4>();
    inside_out += volume_of(points) < 0 ? 1 : 0;
    expect_force_law<4>(
        [&](const Points4& p) { return volume_energy(spring, p); },
        [&](const Points4& p) { return volume_forces(spring, p, ForceForm::kExact); }, points,
        kStep);
  }
  EXPECT_GT(inside_out, kShapes / 4);
}

// The printed force of the source pushes and turns a triangle that is not equilateral.
TEST_F(SpringEnergiesTest, ThePrintedAreaFormLeaks) {
  const Spring spring{0.3, 1e-4};
  const Vector3d off{0.02, -0.01, 0};  // at the corner where its heights meet it would not turn
  const Points3 right{off, off + Vector3d{0.01, 0, 0}, off + Vector3d{0, 0.03, 0}};
  const test::Leak leak = leak_of<3>(right, area_forces(spring, right, ForceForm::kPrinted));
  EXPECT_GT(leak.force, 0.1);
  EXPECT_GT(leak.torque, 0.01);
}

TEST_F(SpringEnergiesTest, ThePrintedVolumeFormLeaks) {
  const Spring spring{0.3, 2e-6};
  const Points4 flat{Vector3d{0, 0, 0}, Vector3d{0.02, 0, 0}, Vector3d{0, 0.02, 0},
                     Vector3d{0, 0, 0.005}};
  EXPECT_GT(leak_of<4>(flat, volume_forces(spring, flat, ForceForm::kPrinted)).force, 0.1);
}

TEST_F(SpringEnergiesTest, RegularElementsHaveTheSameForcesInBothForms) {
  const double a = 0.013;
  const Points4 regular{Vector3d{0, 0, 0}, Vector3d{a, a, 0}, Vector3d{0, a, a}, Vector3d{a, 0, a}};
  const Points4 turned{regular[0], regular[1], regular[3], regular[2]};
  const Points4& p = volume_of(regular) > 0 ? regular : turned;
  const Spring volume{0.2, volume_of(p) * 1.0001};  // a rest shape of nearly this size
  const Points3 face{p[0], p[1], p[2]};
  const Spring area{0.2, area_of(face) * 1.0001};
  const Points4 exact = volume_forces(volume, p, ForceForm::kExact);
  const Points4 printed = volume_forces(volume, p, ForceForm::kPrinted);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((exact[i] - printed[i]).norm(), 1e-3 * exact[i].norm());
  }
  const Points3 exact_area = area_forces(area, face, ForceForm::kExact);
  const Points3 printed_area = area_forces(area, face, ForceForm::kPrinted);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((exact_area[i] - printed_area[i]).norm(), 1e-3 * exact_area[i].norm());
  }
}

TEST_F(SpringEnergiesTest, CollapsedElementsHaveNoForceAndNoNaN) {
  const Vector3d p{0.01, 0.02, 0.03};
  for (const Vector3d& f : length_forces({1, 0.01}, {p, p})) {
    EXPECT_TRUE(f.isZero(0));
  }
  for (const Vector3d& f : area_forces({1, 1e-4}, {p, p, p}, ForceForm::kExact)) {
    EXPECT_TRUE(f.isZero(0));
  }
}

/// Blocks of second derivatives, by central differences of the forces.
template <std::size_t n, class Forces, class Blocks>
void expect_derivatives(const Forces& forces, const Blocks& blocks,
                        const std::array<Vector3d, n>& points) {
  double largest = 0;
  for (const auto& row : blocks) {
    for (const auto& block : row) {
      largest = std::max(largest, block.cwiseAbs().maxCoeff());
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      auto above = points;
      auto below = points;
      above[j][axis] += kStep;
      below[j][axis] -= kStep;
      const auto up = forces(above);
      const auto down = forces(below);
      for (std::size_t i = 0; i < n; ++i) {
        const Vector3d slope = (down[i] - up[i]) / (2 * kStep);
        EXPECT_LT((blocks[i][j].col(axis) - slope).norm(), 1e-5 * largest) << i << j << axis;
      }
    }
  }
}

TEST_F(SpringEnergiesTest, SecondDerivativesAreThoseOfTheForces) {
  for (int i = 0; i < kShapes; ++i) {
    const Spring length{0.3, 0.015};
    const Points2 two = some_points<2>();
    expect_derivatives<2>([&](const Points2& p) { return length_forces(length, p); },
                          length_hessian(length, two), two);
    const Spring area{0.3, 1.5e-4};
    const Points3 three = some_points<3>();
    if (area_of(three) > 2e-5) {  // differences are poor at slivers
      expect_derivatives<3>(
          [&](const Points3& p) { return area_forces(area, p, ForceForm::kExact); },
          area_hessian(area, three), three);
    }
    const Spring volume{0.3, 1e-6};
    const Points4 four = some_points<4>();
    expect_derivatives<4>(
        [&](const Points4& p) { return volume_forces(volume, p, ForceForm::kExact); },
        volume_hessian(volume, four), four);
  }
}

}  // namespace
}  // namespace haptrial::deformable
