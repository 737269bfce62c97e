#include "core/render/bone/bone_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/random.h"
#include "tests/core/bone/surface/surface_checks.h"

namespace haptrial::render {
namespace {

using bone::BoneVolume;
using bone::Surface;
using bone::SurfaceTriangle;
using bone::Voxel;

/// Triangles that face the eye by the angle, in degrees, one after the other.
std::set<SurfaceTriangle> by_angles(const Surface& surface, const Eigen::Vector3d& eye) {
  std::set<SurfaceTriangle> visible;
  for (const SurfaceTriangle& t : bone::living(surface.triangles())) {
    for (const std::uint32_t v : t) {
      const auto& vertex = surface.vertices()[v];
      const double cosine =
          bone::normal_of(vertex).dot((eye - bone::place_of(vertex)).normalized());
      if (std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / M_PI < 90.0) {
        visible.insert(t);
      }
    }
  }
  return visible;
}

std::set<SurfaceTriangle> set_of(std::span<const SurfaceTriangle> triangles) {
  const auto all = bone::living(triangles);
  return {all.begin(), all.end()};
}

void carve(BoneVolume& volume, RandomStream& random) {
  const int size = volume.grid().size[0];
  const Voxel centre(static_cast<int>(random.below(static_cast<std::uint64_t>(size))),
                     static_cast<int>(random.below(static_cast<std::uint64_t>(size))),
                     static_cast<int>(random.below(static_cast<std::uint64_t>(size))));
  for (int k = -3; k <= 3; ++k) {
    for (int j = -3; j <= 3; ++j) {
      for (int i = -3; i <= 3; ++i) {
        const std::int32_t at = volume.address(centre + Voxel(i, j, k));
        if (at != 0 && i * i + j * j + k * k < 12) {
          volume.take(at, 1.0F);
        }
      }
    }
  }
}

const Eigen::Vector3d kEye(0.09, 0.02, 0.06);

TEST(BoneVisibilityTest, APassFindsWhatAnglesSay) {
  const BoneVolume volume(bone::ball_model(30, 12.0));
  Surface surface;
  surface.update(volume);
  std::vector<SurfaceTriangle> found;
  for (const std::uint32_t slot :
       visible_triangles(surface.vertices(), surface.triangles(), std::array{kEye})) {
    found.push_back(surface.triangles()[slot]);
  }
  EXPECT_EQ(set_of(found), by_angles(surface, kEye));
  EXPECT_GT(found.size(), surface.triangle_count() / 3);
  EXPECT_LT(found.size(), surface.triangle_count() / 2) << "an eye sees less than half a ball";
}

TEST(BoneVisibilityTest, TwoEyesSeeWhatEitherSees) {
  const BoneVolume volume(bone::ball_model(30, 12.0));
  Surface surface;
  surface.update(volume);
  const Eigen::Vector3d other(-0.1, 0.0, 0.0);
  const auto both =
      visible_triangles(surface.vertices(), surface.triangles(), std::array{kEye, other});
  std::set<std::uint32_t> either;
  for (const Eigen::Vector3d& eye : {kEye, other}) {
    const auto one = visible_triangles(surface.vertices(), surface.triangles(), std::array{eye});
    either.insert(one.begin(), one.end());
  }
  EXPECT_EQ(std::vector<std::uint32_t>(either.begin(), either.end()), both);
}

TEST(BoneVisibilityTest, TheArrayFollowsTheSurfaceAsAPassWould) {
  RandomStream random(4, "visible");
  BoneVolume volume(bone::ball_model(34, 15.0));
  Surface surface;
  surface.update(volume);
  VisibleArray array;
  const std::array eyes{kEye};
  array.set(surface, visible_triangles(surface.vertices(), surface.triangles(), eyes));
  std::vector<SurfaceTriangle> copy;
  for (int step = 0; step < 60; ++step) {
    carve(volume, random);
    surface.update(volume);
    ASSERT_FALSE(surface.rebuilt());
    for (const std::int32_t quad : surface.changed_quads()) {
      array.refresh(surface, quad, eyes);
    }
    copy.resize(array.size());
    for (const std::uint32_t place : array.take_changed()) {
      copy[place] = array.triangle(surface, place);
    }
    for (std::size_t place = 0; place < array.size(); ++place) {
      ASSERT_EQ(copy[place], array.triangle(surface, place)) << step;
    }
    ASSERT_EQ(set_of(copy), by_angles(surface, kEye)) << step;
  }
}

TEST(BoneVisibilityTest, TheWorkerGivesTheResultOfTheLastJobOfABone) {
  const BoneVolume volume(bone::ball_model(30, 12.0));
  Surface surface;
  surface.update(volume);
  VisibilityWorker worker;
  for (std::uint64_t generation = 1; generation <= 20; ++generation) {
    worker.submit({7,
                   generation,
                   facing(surface.vertices(), std::array{kEye}),
                   {surface.triangles().begin(), surface.triangles().end()}});
  }
  worker.wait();
  const auto results = worker.take();
  ASSERT_FALSE(results.empty());
  EXPECT_EQ(results.back().generation, 20U);
  EXPECT_EQ(results.back().id, 7U);
  EXPECT_EQ(results.back().triangles,
            visible_triangles(surface.vertices(), surface.triangles(), std::array{kEye}));
  EXPECT_TRUE(worker.take().empty());
}

}  // namespace
}  // namespace haptrial::render
