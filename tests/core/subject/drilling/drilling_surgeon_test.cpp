#include "core/subject/drilling/drilling_surgeon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/subject/hand.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::subject {
namespace {

constexpr double kStep = 1e-3;

/// Flat bone 10 mm below the chart's corner; a structure lies 16 mm below it.
std::shared_ptr<const DrillingChart> flat() {
  auto chart = std::make_shared<DrillingChart>();
  chart->corner = {-10e-3, 20e-3, -10e-3};
  chart->axes.col(0) = Eigen::Vector3d::UnitX();
  chart->axes.col(1) = -Eigen::Vector3d::UnitZ();
  chart->axes.col(2) = -Eigen::Vector3d::UnitY();
  chart->corner.z() = 10e-3;
  chart->size = {41, 41, 41};
  chart->end = {10e-3, 10e-3, 14e-3};
  chart->floor_radius = 3e-3;
  chart->slope = 0.5;
  chart->surface.assign(chart->columns(), 10e-3F);
  for (int k = 0; k < 41; ++k) {
    chart->clearance.insert(chart->clearance.end(), chart->columns(),
                            static_cast<float>(16e-3 - k * chart->cell));
  }
  return chart;
}

constexpr double kWall = 14e-3;  // (u) where a structure beside a deep cavity begins [m]

/// Flat bone as above; a structure stands upright beside the cavity, with a margin of 1 mm.
std::shared_ptr<const DrillingChart> walled() {
  auto chart = std::make_shared<DrillingChart>(*flat());
  chart->end.z() = 19e-3;
  for (int k = 0; k < 41; ++k) {
    for (int j = 0; j < 41; ++j) {
      for (int i = 0; i < 41; ++i) {
        chart->clearance[chart->columns() * static_cast<std::size_t>(k) + chart->column(i, j)] =
            static_cast<float>(kWall - 1e-3 - i * chart->cell);
      }
    }
  }
  return chart;
}

/// A world with a plane of bone that gives way where a burr turns on it.
class Scene {
 public:
  explicit Scene(double skill, std::uint64_t seed = 1,
                 std::shared_ptr<const DrillingChart> chart = flat())
      : chart_(std::move(chart)),
        hand_(HandParameters{}, kStep, {0.0, 25e-3, 0.0}),
        device_({}, hand_, 1.0 / kStep),
        surgeon_(parameters(skill), {chart_, chart_}, hand_, device_, 1.0, seed, kStep) {
    heights_ = chart_->surface;
  }
  static SurgeonParameters parameters(double skill) {
    SurgeonParameters p;
    p.skill = skill;
    p.spread = {0.0, 0.0, 0.0};
    p.rough = {0, 3e-3};
    p.fine = {1, 2e-3};
    return p;
  }

  void tick(bool drills = true) {
    device::DeviceReading reading;
    device_.read(reading);
    const Eigen::Vector3d place = chart_->place(reading.tool.position);
    const double radius = tool_ == 0 ? 3e-3 : 2e-3;
    const bool power = (reading.buttons & 1U) != 0;
    tool_ += (reading.buttons & ~last_ & 2U) != 0 ? 1 : 0;
    tool_ -= (reading.buttons & ~last_ & 4U) != 0 ? 1 : 0;
    finish_ = finish_ || (reading.buttons & 32U) != 0;
    powered_ += power ? 1 : 0;
    last_ = reading.buttons;
    deepest_ = std::max(deepest_, place.z() + radius);
    const double depth = meet(place, radius, power);
    const Eigen::Vector3d force = chart_->axes.col(2) * (-4000.0 * depth);
    device_.write(force);
    bone::DrillingView seen;
    seen.progress = 1e-5 * ++ticks_;
    seen.time_limit = 100.0;
    seen.shown = drills;
    seen.tip = reading.tool.position;
    seen.tool = tool_;
    seen.power = power;
    seen.contact = depth > 0.0;
    seen.eye = {0.0, 0.2, 0.0};
    seen.up = {0.0, 0.0, -1.0};
    seen.tone = tone_;
    contact_ = seen.contact;
    surgeon_.observe(seen, force, kStep);
  }

  std::shared_ptr<const DrillingChart> chart_;
  Hand hand_;
  device::VirtualDevice device_;
  DrillingSurgeon surgeon_;
  std::vector<float> heights_;
  int tool_{0};
  std::uint32_t last_{0};
  int ticks_{0};
  int powered_{0};
  bool finish_{false};
  bool tone_{false};  // of a nerve monitor
  bool contact_{false};
  double deepest_{0.0};

 private:
  /// How deep the burr is in the bone; what it covers goes a little.
  double meet(const Eigen::Vector3d& place, double radius, bool power) {
    double deepest = 0.0;
    const int reach = static_cast<int>(radius / chart_->cell);
    const auto i = static_cast<int>(std::lround(place.x() / chart_->cell));
    const auto j = static_cast<int>(std::lround(place.y() / chart_->cell));
    for (int b = std::max(0, j - reach); b <= std::min(40, j + reach); ++b) {
      for (int a = std::max(0, i - reach); a <= std::min(40, i + reach); ++a) {
        const double aside = chart_->cell * chart_->cell * ((a - i) * (a - i) + (b - j) * (b - j));
        if (aside > radius * radius) {
          continue;
        }
        float& height = heights_[chart_->column(a, b)];
        const double depth =
            place.z() + std::sqrt(radius * radius - aside) - static_cast<double>(height);
        deepest = std::max(deepest, depth);
        if (power && depth > 0.0) {
          height += static_cast<float>(depth * 0.02);
        }
      }
    }
    return deepest;
  }
};

TEST(DrillingSurgeonTest, AnExpertDrillsTheCavityStopsShortOfTheStructureAndSaysSo) {
  Scene scene(1.0);
  for (int n = 0; n < 200000 && !scene.finish_; ++n) {
    scene.tick();
  }
  EXPECT_TRUE(scene.finish_);
  EXPECT_EQ(scene.tool_, 1) << "the fine burr comes last";
  EXPECT_GT(scene.surgeon_.series(), 10U);
  const float middle = scene.heights_[scene.chart_->column(20, 20)];
  EXPECT_GT(middle, 12.5e-3F);
  EXPECT_LT(scene.deepest_, 16e-3);
  EXPECT_EQ(scene.heights_[scene.chart_->column(0, 0)], 10e-3F);
}

TEST(DrillingSurgeonTest, WorkUnderAnEdgeEndsBeforeAStructureBesideTheCavity) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scene scene(0.85, seed, walled());
    for (int n = 0; n < 150000 && !scene.finish_; ++n) {
      scene.tick();
    }
    float lost = 0.0F;  // of the structure's height
    for (int j = 0; j < 41; ++j) {
      for (int i = static_cast<int>(kWall / scene.chart_->cell); i < 41; ++i) {
        lost = std::max(lost, scene.heights_[scene.chart_->column(i, j)] - 10e-3F);
      }
    }
    EXPECT_LT(lost, 0.35e-3F) << seed;  // strokes into it take 0.8 mm
    EXPECT_GT(scene.heights_[scene.chart_->column(20, 20)], 13e-3F) << seed << ": it drills";
  }
}

TEST(DrillingSurgeonTest, NobodyWorksUnlessToldTo) {
  Scene scene(1.0);
  for (int n = 0; n < 2000; ++n) {
    scene.tick(false);
  }
  EXPECT_EQ(scene.powered_, 0);
  EXPECT_EQ(scene.surgeon_.series(), 0U);
}

TEST(DrillingSurgeonTest, OneSeedOneProcedureAnotherSeedAnother) {
  Scene a(0.5, 3);
  Scene b(0.5, 3);
  Scene c(0.5, 4);
  for (int n = 0; n < 8000; ++n) {
    a.tick();
    b.tick();
    c.tick();
  }
  EXPECT_EQ(a.heights_, b.heights_);
  EXPECT_NE(a.heights_, c.heights_);
}

TEST(DrillingSurgeonTest, AToneIsAnsweredByLiftingTheBurr) {
  Scene scene(0.7);
  int n = 0;
  for (; n < 50000 && !(n > 5000 && scene.contact_); ++n) {
    scene.tick();
  }
  ASSERT_TRUE(scene.contact_);
  scene.tone_ = true;
  for (int tick = 0; tick < 600 + 300; ++tick) {  // reaction and the way up [ms]
    scene.tick();
  }
  for (int quiet = 0; quiet < 1500; ++quiet) {
    scene.tick();
    EXPECT_FALSE(scene.contact_) << "while the tone goes on";
  }
  scene.tone_ = false;
  for (n = 0; n < 20000 && !scene.contact_; ++n) {
    scene.tick();
  }
  EXPECT_TRUE(scene.contact_) << "it goes on when it is quiet";
}

TEST(DrillingSurgeonTest, ObserveDoesNotAllocate) {
  Scene scene(0.7);
  const test::AllocationGuard guard;
  for (int n = 0; n < 20000; ++n) {
    scene.tick();
  }
}

}  // namespace
}  // namespace haptrial::subject
