#include "core/subject/drilling/drilling_memory.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/allocation_guard.h"

namespace haptrial::subject {
namespace {

constexpr double kRadius = 2e-3;

/// Flat bone at 10 mm, to be drilled 6 mm deep in a disc of 8 mm about the middle.
struct Flat {
  Flat() {
    chart.size = {61, 61, 2};
    chart.surface.assign(chart.columns(), 10e-3F);
    floor.assign(chart.columns(), 10e-3F);
    for (int j = 0; j < 61; ++j) {
      for (int i = 0; i < 61; ++i) {
        if ((i - 30) * (i - 30) + (j - 30) * (j - 30) <= 16 * 16) {
          floor[chart.column(i, j)] = 16e-3F;
        }
      }
    }
    reach = burr_reach(chart, floor, kRadius);
  }
  DrillingChart chart;
  std::vector<float> floor;
  BurrReach reach;
};

/// Goes along a bout as deep as allowed.
void drill(DrillingMemory& memory, const StrokeSeries& strokes, double deepest) {
  for (int step = 0; step <= 40; ++step) {
    const Eigen::Vector2d at = strokes.from + (strokes.to - strokes.from) * step / 40.0;
    memory.sweep({at.x(), at.y(), std::min(memory.limit(at), deepest)});
  }
}

TEST(DrillingMemoryTest, ABurrTouchesWhatStandsAndRemembersWhereItWas) {
  const Flat flat;
  DrillingMemory memory(flat.chart);
  memory.begin(flat.chart.surface);
  memory.begin_burr(flat.reach, kRadius);
  const Eigen::Vector2d middle(15e-3, 15e-3);
  EXPECT_NEAR(memory.touch(middle), 8e-3, 1e-6);
  EXPECT_NEAR(memory.limit(middle), 14e-3, 1e-6);
  EXPECT_NEAR(memory.left(), 1.0, 1e-6);
  memory.sweep({15e-3, 15e-3, 12e-3});
  EXPECT_GT(memory.touch(middle), 9e-3);
  EXPECT_LT(memory.touch(middle), 12.1e-3);
  EXPECT_LT(memory.left(), 1.0);
  EXPECT_NEAR(memory.over({5e-3, 15e-3}, {25e-3, 15e-3}), 8e-3, 1e-6);
}

TEST(DrillingMemoryTest, BoutsComeToAnEndWithAllOfItGone) {
  const Flat flat;
  DrillingMemory memory(flat.chart);
  memory.begin(flat.chart.surface);
  memory.begin_burr(flat.reach, kRadius);
  RandomStream random(1, "bouts");
  StrokeSeries strokes;
  int series = 0;
  while (memory.choose({}, {0.0, 0.0}, random, strokes) && series < 2000) {
    drill(memory, strokes, memory.touch(strokes.from) + 1e-3);
    memory.end_strokes(strokes);
    ++series;
  }
  EXPECT_LT(memory.left(), 0.01);
  EXPECT_GT(series, 20);
  EXPECT_LT(series, 2000);
}

TEST(DrillingMemoryTest, WhoWorksEvenlyGoesFarForTheHighestBone) {
  const Flat flat;
  const auto way = [&](double evenness) {
    DrillingMemory memory(flat.chart);
    memory.begin(flat.chart.surface);
    memory.begin_burr(flat.reach, kRadius);
    RandomStream random(1, "bouts");
    StrokeSeries strokes;
    Eigen::Vector2d hand(10e-3, 15e-3);
    double sum = 0.0;
    for (int n = 0; n < 12; ++n) {
      StrokeChoice choice;
      choice.evenness = evenness;
      choice.length = 3e-3;
      EXPECT_TRUE(memory.choose(choice, hand, random, strokes));
      sum += (0.5 * (strokes.from + strokes.to) - hand).norm();
      drill(memory, strokes, memory.touch(strokes.from) + 1e-3);
      memory.end_strokes(strokes);
      hand = strokes.to;
    }
    return sum;
  };
  EXPECT_GT(way(1.0), 1.5 * way(0.0));
}

TEST(DrillingMemoryTest, BoutsUnderAnEdgeGoBeyondIt) {
  const Flat flat;
  DrillingMemory memory(flat.chart);
  memory.begin(flat.chart.surface);
  memory.begin_burr(flat.reach, kRadius);
  RandomStream random(1, "bouts");
  for (int j = 25; j <= 35; ++j) {
    for (int i = 25; i <= 35; ++i) {
      memory.sweep({i * 0.5e-3, j * 0.5e-3, 14e-3});
    }
  }
  StrokeChoice choice;
  choice.undercut = 1.0;
  StrokeSeries strokes;
  int under = 0;
  for (int n = 0; n < 20; ++n) {
    ASSERT_TRUE(memory.choose(choice, {15e-3, 15e-3}, random, strokes));
    if (strokes.under) {
      ++under;
      EXPECT_NEAR(memory.touch(strokes.to), 8e-3, 0.5e-3) << "bone stands where the stroke ends";
    }
  }
  EXPECT_GT(under, 10);
}

TEST(DrillingMemoryTest, NothingAllocatesWhileItWorks) {
  const Flat flat;
  DrillingMemory memory(flat.chart);
  RandomStream random(1, "bouts");
  StrokeSeries strokes;
  const test::AllocationGuard guard;
  memory.begin(flat.chart.surface);
  memory.begin_burr(flat.reach, kRadius);
  for (int n = 0; n < 5; ++n) {
    memory.choose({}, {0.0, 0.0}, random, strokes);
    drill(memory, strokes, memory.touch(strokes.from) + 1e-3);
    memory.end_strokes(strokes);
  }
}

}  // namespace
}  // namespace haptrial::subject
