#include "analysis/contact/demo_study/failure_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/contact/felt_body.h"
#include "core/contact/renderer_kinds.h"

namespace haptrial::evaluation {
namespace {

using contact::RendererKind;

const std::vector<FailureMap>& maps() {
  static const std::vector<FailureMap> all = failure_maps();
  return all;
}

TEST(RidgeTest, TheMeshIsClosedAndHasTheRidgesVolume) {
  const Ridge ridge;
  const contact::FeltBody body(ridge_mesh(ridge));
  EXPECT_TRUE(body.closed);
  double volume = 0.0;
  for (const geometry::Triangle& t : body.mesh.triangles) {
    const auto at = [&](std::size_t k) {
      return body.mesh.vertices[static_cast<std::size_t>(t[k])];
    };
    volume += at(0).dot(at(1).cross(at(2))) / 6.0;
  }
  const double trapezoid = ridge.height * 0.5 * (ridge.top - 2.0 * ridge.foot());
  EXPECT_NEAR(volume,
              2.0 * ridge.half_width * (2.0 * ridge.half_length * ridge.thickness + trapezoid),
              1e-15);
}

TEST(RidgeTest, BadRidgesAreRefused) {
  Ridge flat;
  flat.height = 0.0;
  EXPECT_THROW(ridge_mesh(flat), std::invalid_argument);
  Ridge upright;
  upright.flank = 1.6;
  EXPECT_THROW(ridge_mesh(upright), std::invalid_argument);
}

/// The proxy climbs every ridge that Coulomb's law lets it climb, and no other, and sets out where
/// the law says.
TEST(FailureMapTest, TheProxySticksNowhereThatFrictionDoesNotExplain) {
  int climbed = 0, held = 0;
  for (const FailureMap& map : maps()) {
    if (map.renderer != "proxy") {
      continue;
    }
    for (const FailureMap::Cell& cell : map.cells) {
      ASSERT_EQ(cell.result.outcome, RidgeOutcome::kRight)
          << name_of(map) << ", " << cell.flank << " rad, " << cell.depth << " m";
      if (!cell.law.leaves_foot || *cell.law.on_top > 0.04) {
        held += cell.result.left_foot ? 0 : 1;
        continue;
      }
      ASSERT_TRUE(cell.result.left_foot);
      ASSERT_NEAR(*cell.result.left_foot, *cell.law.seen(), 1.1e-4)
          << name_of(map) << ", " << cell.flank;
      ++climbed;
    }
  }
  EXPECT_GT(climbed, 400);
  EXPECT_GT(held, 20);
}

/// A proxy has no length and no force of its own: the law holds for every height and stiffness.
TEST(FailureMapTest, HeightAndStiffnessChangeNothing) {
  int climbed = 0;
  for (const double height : {0.001, 0.004}) {
    for (int degrees = 10; degrees <= 80; degrees += 10) {
      Ridge ridge;
      ridge.height = height;
      ridge.flank = degrees * M_PI / 180.0;
      const contact::FeltBody body(ridge_mesh(ridge));
      for (const double friction : {0.0, 0.3}) {
        for (const double stiffness : {100.0, 5000.0}) {
          contact::RendererOptions options;
          options.stiffness = stiffness;
          options.friction = {friction, friction};
          const auto renderer =
              contact::make_renderer(RendererKind::kProxy, body.mesh, body.surface, options);
          for (const double depth : {0.0005, 0.002, 0.008}) {
            const RidgeResult found = drag_over(ridge, {depth, friction}, *renderer);
            ASSERT_EQ(found.outcome, RidgeOutcome::kRight)
                << height << " m, " << degrees << ", " << stiffness << ", " << depth << " m";
            climbed += found.left_foot ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_GT(climbed, 100);
}

/// A tool that is drawn to the nearest surface loses the ridge once it is deeper than the ridge is
/// high.
TEST(FailureMapTest, RenderersWithoutAProxyPassUnder) {
  for (const FailureMap& map : maps()) {
    if (map.renderer == "penalty" || map.renderer == "distance field") {
      EXPECT_GT(map.count(RidgeOutcome::kPassesUnder), 20) << name_of(map);
    }
  }
}

TEST(FailureMapTest, TheTableHasEveryCell) {
  const std::string text = failure_csv(maps());
  std::size_t cells = 0;
  for (const FailureMap& map : maps()) {
    cells += map.cells.size();
    EXPECT_FALSE(failure_figure(map).series.empty());
  }
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), cells + 1);
}

}  // namespace
}  // namespace haptrial::evaluation
