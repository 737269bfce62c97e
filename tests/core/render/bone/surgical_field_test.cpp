// Soft tissue and drapes surround a bone and leave the field free.

#include "core/render/bone/surgical_field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::render::surgical_field_test {
namespace {

constexpr double kSpacing = 1e-3;
constexpr int kSize = 41;

/// A block of 41 mm about the origin of W, which the eye sees from +z.
bone::BoneModel block() {
  bone::BoneModel model;
  model.grid = {{kSize, kSize, kSize}, Eigen::Vector3d::Constant(-0.02), kSpacing};
  model.structures = {{}, {"bone", {0.9, 0.9, 0.8}, 1.0, false}};
  model.labels.assign(model.grid.count(), 1);
  return model;
}

Camera above() { return {{0.0, 0.0, 0.22}, {0.0, 0.0, 0.02}, Eigen::Vector3d::UnitY(), 0.16}; }

/// All triangles' middles. @returns the least distance from the line of sight [m]
template <class Visit>
void each_middle(const std::vector<SceneMesh>& scenery, const Visit& visit) {
  for (const SceneMesh& part : scenery) {
    for (const geometry::Triangle& t : part.mesh->triangles) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const std::int32_t corner : t) {
        sum += part.mesh->vertices[static_cast<std::size_t>(corner)];
      }
      visit(Eigen::Vector3d(sum / 3.0));
    }
  }
}

TEST(SurgicalFieldTest, TheFieldIsFreeAndTheBoneAroundItIsCovered) {
  const auto scenery = surgical_field(block(), Eigen::Isometry3d::Identity(), above());
  const double half = 0.2 * std::tan(0.08);  // of the picture's height at the target: 16 mm
  double above_bone = 0.0;
  int covering = 0;
  each_middle(scenery, [&](const Eigen::Vector3d& p) {
    ASSERT_TRUE(p.allFinite());
    const double out = std::hypot(p.x() / (1.12 * half), p.y() / (0.88 * half));
    EXPECT_GT(out, 0.85);
    if (out > 1.2 && std::abs(p.x()) < 0.018 && std::abs(p.y()) < 0.018) {
      above_bone = std::max(above_bone, p.z() - 0.02);
      EXPECT_GT(p.z(), 0.02) << p.transpose();
      ++covering;
    }
  });
  EXPECT_GT(covering, 50);
  EXPECT_LT(above_bone, 0.012);  // it lies on the bone
}

TEST(SurgicalFieldTest, AllOfItFacesTheEye) {
  const Camera view = above();
  for (const SceneMesh& part : surgical_field(block(), Eigen::Isometry3d::Identity(), view)) {
    int away = 0;
    for (const geometry::Triangle& t : part.mesh->triangles) {
      const auto corner = [&](std::size_t n) {
        return part.mesh->vertices[static_cast<std::size_t>(t[n])];
      };
      const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      away += normal.dot(view.eye - corner(0)) <= 0.0 ? 1 : 0;
    }
    EXPECT_LT(away, static_cast<int>(part.mesh->triangles.size()) / 20);
  }
}

}  // namespace
}  // namespace haptrial::render::surgical_field_test
