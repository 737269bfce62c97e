#include "analysis/contact/evaluation/registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/contact/evaluation/in_trajectory.h"
#include "core/base/random.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::evaluation {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using testing::HasSubstr;

Eigen::Isometry3d a_pose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(0.3, -1.2, 0.7));
  pose.rotate(Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, -1).normalized()));
  return pose;
}

struct Body {
  geometry::Mesh mesh;
  contact::ContactSurface surface{mesh};
  contact::SignedDistance distance{mesh, surface};
};

/// A path wound over a body that every ray from its centre leaves once, seen from elsewhere.
Points path_over(const geometry::Bvh& bvh, std::size_t n, double radius) {
  Points path;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(n);
    const double height = 0.9 * (2.0 * u - 1.0), turn = 17.0 * u;
    const double r = std::sqrt(1.0 - height * height);
    const Eigen::Vector3d ray(r * std::cos(turn), r * std::sin(turn), height);
    const Eigen::Vector3d p = bvh.nearest_hit({10.0 * ray, -ray})->t * -ray + 10.0 * ray;
    path.emplace_back(a_pose().inverse() * Eigen::Vector3d(p + radius * ray));
  }
  return path;
}

double pose_error(const Eigen::Isometry3d& found, double size) {
  const Eigen::Isometry3d rest = found * a_pose().inverse();
  return rest.translation().norm() + size * Eigen::AngleAxisd(rest.linear()).angle();
}

TEST(RegistrationTest, AnExactPathIsFoundFromNowhere) {
  const Body body{geometry::make_rough_solid(0.1, 30, 3)};
  const Registration found = register_path(body.distance, path_over(body.surface.bvh(), 600, 0.0));
  EXPECT_LT(pose_error(found.body_from_world, 0.05), 1e-7);
  EXPECT_LT(found.worst, 1e-7);
  EXPECT_THAT(found.unfixed, testing::IsEmpty());
}

TEST(RegistrationTest, NoiseAndStrayContactsAreBorne) {
  const Body body{geometry::make_rough_solid(0.1, 30, 3)};
  Points path = path_over(body.surface.bvh(), 1000, 0.0);
  RandomStream random(8, "stray");
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double noise = i % 12 == 0 ? 0.02 : 0.0005;  // 8 % are 20 mm off
    const Eigen::Vector3d one(random.normal(), random.normal(), random.normal());
    path[i] += noise * one;
  }
  const Registration found = register_path(body.distance, path);
  // Better than any single contact.
  EXPECT_LT(pose_error(found.body_from_world, 0.05), 5e-4);
  EXPECT_NEAR(found.median, 0.6745 * 0.0005, 1e-4);
  EXPECT_GT(found.worst, 0.005);
}

TEST(RegistrationTest, ASphereLeavesItsTurnsOpen) {
  const Body body{geometry::make_sphere(0.05, 30)};
  const double radius = 0.002;
  Points path;  // of a true sphere: the mesh's own facets would fix its turns
  for (const auto& p : path_over(body.surface.bvh(), 400, 0.0)) {
    path.emplace_back(a_pose().inverse() * ((0.05 + radius) * (a_pose() * p).normalized()));
  }
  const Registration found = register_path(body.distance, path, {.radius = radius, .starts = 5});
  EXPECT_LT(found.worst, 1e-4);
  ASSERT_EQ(found.unfixed.size(), 3u);
  for (const auto& sentence : found.unfixed) {
    EXPECT_THAT(sentence, HasSubstr("hardly fix a turn about"));
  }
}

TEST(RegistrationTest, APlaneLeavesTwoShiftsAndATurnOpen) {
  const Body body{{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}};
  Points path;
  for (int i = 0; i < 100; ++i) {
    path.emplace_back(0.1 * std::cos(0.3 * i), 0.1 * std::sin(0.5 * i), 0.0);
  }
  const Registration found = register_path(body.distance, path, {.starts = 0});
  ASSERT_EQ(found.unfixed.size(), 3u);
}

TEST(RegistrationTest, BadArgumentsAreRefused) {
  const Body body{geometry::make_sphere(1.0, 3)};
  EXPECT_THROW(register_path(body.distance, Points(5)), std::invalid_argument);
  EXPECT_THROW(register_path(body.distance, Points(20, Eigen::Vector3d::Zero()), {.trimmed = 0.6}),
               std::invalid_argument);
  EXPECT_THROW(register_path(body.distance, Points(20, Eigen::Vector3d::Constant(NAN))),
               std::invalid_argument);
}

TEST(InTrajectoryTest, DepthIsForceOverStiffness) {
  RandomStream random(6, "in");
  Points out, force, normals;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d n(random.normal(), random.normal(), random.normal());
    normals.push_back(n.normalized());
    out.emplace_back(random.normal(), random.normal(), random.normal());
    force.emplace_back(random.normal(), random.normal(), random.normal());
  }
  const Points in = in_trajectory(out, force, normals, 800.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double push = force[i].dot(normals[i]);
    EXPECT_NEAR((out[i] - in[i]).norm(), std::max(0.0, push) / 800.0, 1e-14);
    EXPECT_GE((out[i] - in[i]).dot(normals[i]), -1e-15);  // never outside
  }
  EXPECT_THROW(in_trajectory(out, force, normals, 0.0), std::invalid_argument);
}

TEST(InTrajectoryTest, NormalsOfASphereAreRadialAndSmoothingCalmsThem) {
  const Body body{geometry::make_sphere(0.05, 12)};
  RandomStream random(6, "sphere");
  Points path;
  double direct = 0.0, smooth = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double a = 0.01 * i;
    const Eigen::Vector3d one(random.normal(), random.normal(), random.normal());
    path.emplace_back(0.05 * Eigen::Vector3d(std::cos(a), std::sin(a), 0.0) + 0.0005 * one);
  }
  const contact::Shading shading(body.mesh, body.surface, std::numbers::pi / 2.0);
  const Points normals = path_normals(body.surface, shading, path, 0.0);
  const Points calm = path_normals(body.surface, shading, path, 0.003);
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d truth(std::cos(0.01 * i), std::sin(0.01 * i), 0.0);
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(normals[k].norm(), 1.0, 1e-12);
    EXPECT_NEAR((normals[k] - path[k].normalized()).norm(), 0.0, 0.01);
    direct += (normals[k] - truth).squaredNorm();
    smooth += (calm[k] - truth).squaredNorm();
  }
  EXPECT_LT(smooth, 0.5 * direct);
}

}  // namespace
}  // namespace haptrial::evaluation
