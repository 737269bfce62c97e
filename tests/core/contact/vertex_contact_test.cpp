#include "core/contact/vertex_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/contact/contact_surface.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

/// Triangles in planes that all but touch the origin: some around it, some with it at a side or a
/// corner, to within a few skins.
class Corner {
 public:
  explicit Corner(RandomStream& random, int count) : skin_(Skin::of(1.0)), random_(&random) {
    for (int k = 0; k < count; ++k) {
      add();
    }
    surface_.emplace(mesh_);
    near_.emplace(*surface_, 0.0);
    for (std::size_t k = 0; k < surface_->triangles(); ++k) {
      const auto slot = static_cast<std::int32_t>(k);
      Vector3d down = surface_->normal(slot);
      down *= down.z() > 0.0 ? -1e-3 : 1e-3;
      SweepHit hit;
      if (near_->meets(sweep(down), slot, hit) && hit.t * down.norm() <= enough()) {
        met_.add(hit.plane);
      }
    }
  }

  const PlaneSet& met() const { return met_; }
  const Skin& skin() const { return skin_; }
  NearTriangles& near() { return *near_; }
  double enough() const { return 4.0 * skin_.rest(); }

  /// Whether sweeps find one of the triangles in the way at once.
  bool is_stopped(const Vector3d& move) {
    for (int k = 0; k < met_.size(); ++k) {
      SweepHit hit;
      if (near_->meets(sweep(move), met_[k].slot, hit) && hit.t * move.norm() <= enough()) {
        return true;
      }
    }
    return false;
  }
  /// Whether a way along a few planes leads nearer to the goal, and nothing stops it.
  bool leads_on(std::span<const int> which, const Vector3d& wish) {
    const PlaneSolution s = met_.solve_on(which, Vector3d::Zero(), wish);
    return s.solved && s.move.norm() > enough() && s.residual.norm() < wish.norm() &&
           !is_stopped(s.move);
  }
  bool is_held(const Vector3d& wish) {
    bool held = is_stopped(wish);
    for (int j = 0; j < met_.size(); ++j) {
      held = held && !leads_on(std::array{j}, wish);
      for (int i = 0; i < j; ++i) {
        held = held && !leads_on(std::array{i, j}, wish);
      }
    }
    return held;
  }

 private:
  Sweep sweep(const Vector3d& move) const { return {Vector3d::Zero(), move, 0.0, skin_}; }

  void add() {
    const double turn = random_->uniform(0.0, 2.0 * std::numbers::pi),
                 tilt = random_->uniform(0.2, 1.5);
    const Vector3d normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                          std::cos(tilt));
    const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    const double start = random_->uniform(0.0, 2.0 * std::numbers::pi);
    const auto towards = [&](double a) -> Vector3d { return std::cos(a) * u + std::sin(a) * v; };
    // Distance from the foot of the origin to the side that is nearest.
    constexpr double kWithin = 0.15;
    const bool inside = random_->uniform(0.0, 1.0) < 0.5;
    const double side = inside ? kWithin : random_->uniform(-0.4, 4.0) * skin_.thickness;
    const Vector3d middle = -skin_.rest() * normal + (side - kWithin) * towards(start);
    const auto first = static_cast<std::int32_t>(mesh_.vertices.size());
    for (const double third : {1.0, 3.0, 5.0}) {
      mesh_.vertices.push_back(middle +
                               2.0 * kWithin * towards(start + third * std::numbers::pi / 3.0));
    }
    mesh_.triangles.push_back({first, first + 1, first + 2});
  }

  Skin skin_;
  RandomStream* random_;
  geometry::Mesh mesh_;
  std::optional<ContactSurface> surface_;
  std::optional<NearTriangles> near_;
  PlaneSet met_;
};

TEST(VertexContactTest, WhatItHoldsSweepsHoldToo) {
  RandomStream random(3, "corner");
  int held = 0, told = 0, free = 0;
  for (int i = 0; i < 4000; ++i) {
    Corner corner(random, 3 + i % 4);
    VertexContact known;
    known.set(corner.met(), Vector3d::Zero(), corner.skin());
    ASSERT_TRUE(known.known(corner.skin())) << i;
    for (int k = 0; k < 10; ++k) {
      const Vector3d wish(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), -1e-3);
      const bool holds = known.holds(wish, corner.enough(), corner.near());
      const bool truth = corner.is_held(wish);
      ASSERT_TRUE(truth || !holds) << i << " " << k;
      held += truth;
      told += holds;
      free += !truth;
    }
  }
  EXPECT_GT(free, 10000);
  EXPECT_GT(held, 10000);
  EXPECT_GT(told, 0.95 * held) << "else it saves nothing";
}

TEST(VertexContactTest, AnotherSkinOrAFewPlanesAreNotKnown) {
  RandomStream random(4, "skin");
  Corner corner(random, 8);
  ASSERT_GE(corner.met().size(), 3);
  VertexContact known;
  EXPECT_FALSE(known.known(corner.skin()));
  known.set(corner.met(), Vector3d::Zero(), corner.skin());
  EXPECT_TRUE(known.known(corner.skin()));
  EXPECT_FALSE(known.known(Skin::of(2.0)));
  PlaneSet two = corner.met();
  two.keep_first(2);
  known.set(two, Vector3d::Zero(), corner.skin());
  EXPECT_FALSE(known.known(corner.skin()));
  known.set(corner.met(), Vector3d::Zero(), corner.skin());
  known.forget();
  EXPECT_FALSE(known.known(corner.skin()));
}

}  // namespace
}  // namespace haptrial::contact
