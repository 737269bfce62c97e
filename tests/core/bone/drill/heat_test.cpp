#include "core/bone/drill/heat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace haptrial::bone::heat_test {
namespace {

constexpr double kDrag = 0.4;
constexpr double kRadius = 3e-3;

double power_of(const HeatParameters& p) {
  return p.share * kDrag * 2.0 * std::numbers::pi * p.turns * kRadius;
}

// C T' = P - G (T - T_body) has T_body + P / G (1 - exp(-G t / C)), however time is cut.
TEST(DrillHeatTest, WarmsUpAsTheEquationSays) {
  const HeatParameters p;
  for (const double dt : {1e-3, 0.25}) {
    DrillHeat heat(p);
    for (int i = 1; i <= static_cast<int>(std::lround(20.0 / dt)); ++i) {
      heat.tick(kDrag, kRadius, 1.0, false, dt);
      const double expected =
          p.body + power_of(p) / p.loss * (1.0 - std::exp(-p.loss * i * dt / p.capacity));
      ASSERT_NEAR(heat.temperature(), expected, 1e-8) << i;
    }
    EXPECT_EQ(heat.hottest(), heat.temperature());
  }
}

TEST(DrillHeatTest, WaterCoolsAndRestCools) {
  const HeatParameters p;
  DrillHeat dry(p);
  DrillHeat rinsed(p);
  for (int i = 0; i < 60'000; ++i) {
    dry.tick(kDrag, kRadius, 1.0, false, 1e-3);
    rinsed.tick(kDrag, kRadius, 1.0, true, 1e-3);
  }
  EXPECT_NEAR((dry.temperature() - p.body) / (rinsed.temperature() - p.body),
              p.rinsed_loss / p.loss, 0.05);
  const double hot = dry.temperature();
  dry.tick(0.0, 0.0, 0.0, false, p.capacity / p.loss);
  EXPECT_NEAR(dry.temperature() - p.body, (hot - p.body) / std::numbers::e, 1e-9);
  EXPECT_EQ(dry.hottest(), hot);
}

TEST(DrillHeatTest, TimeAboveTheHarmfulTemperatureIsCounted) {
  HeatParameters p;
  p.share = 1.0;
  DrillHeat heat(p);
  const double above = power_of(p) / p.loss;
  const double until = -p.capacity / p.loss * std::log(1.0 - (p.harmful - p.body) / above);
  for (int i = 0; i < 10'000; ++i) {
    heat.tick(kDrag, kRadius, 1.0, false, 1e-3);
  }
  EXPECT_NEAR(heat.harmful_time(), 10.0 - until, 2e-3);
  EXPECT_EQ(DrillHeat(p).harmful_time(), 0.0);
}

}  // namespace
}  // namespace haptrial::bone::heat_test
