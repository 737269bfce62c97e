#include "analysis/reaching/reaching_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "analysis/document/figure_gnuplot.h"
#include "core/base/random.h"
#include "tests/analysis/reaching/recorded.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using Eigen::Vector3d;

TEST(ReachingFiguresTest, TheMeanOfOppositeArcsIsTheirChord) {
  const test::Recorded left = test::arc(0.1, 1.0);
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(0, 0) = -1.0;
  const test::Recorded right = test::transformed(left, mirror);
  const std::vector<TimedReach> both{{left.reach(), 0.5, 1.0}, {right.reach(), 0.5, 1.0}};
  const auto path = mean_path(both, 51);
  for (const Vector3d& p : path) {
    EXPECT_NEAR(p.x(), 0.0, 1e-15);
  }
  EXPECT_NEAR(path.front().z(), 0.0, 1e-12);
  EXPECT_NEAR(path.back().z(), -0.1, 1e-12);
  EXPECT_THROW(mean_path({}), std::invalid_argument);
  const std::vector<TimedReach> late{{left.reach(), 0.5, 100.0}};
  EXPECT_THROW(mean_path(late), std::invalid_argument);
}

/// A reach of minimum jerk over 0.1 m in 0.5 s: its speed is 30 D/T (s² - 2 s³ + s⁴), s = t/T.
TEST(ReachingFiguresTest, ASpeedProfileIsThatOfTheReach) {
  const test::Recorded straight = test::straight(Vector3d::Zero(), {0.0, 0.0, -0.1});
  const TimedReach one{straight.reach(), 0.5, 1.0};
  const std::vector<double> speed = speed_profile(one);
  ASSERT_GE(speed.size(), 50u);
  const auto expected = [&](double time) {
    const double s = time / 0.5;
    return s < 1.0 ? 30.0 * 0.1 / 0.5 * s * s * (1.0 - s) * (1.0 - s) : 0.0;
  };
  for (std::size_t i = 0; i < speed.size(); ++i) {
    EXPECT_NEAR(speed[i], expected(kProfileStep * static_cast<double>(i)), 1e-3) << i;
  }
  EXPECT_THROW(speed_profile({straight.reach(), -1.0, 1.0}), std::invalid_argument);
}

TEST(ReachingFiguresTest, AMeanProfileLastsAsLongAsHalfOfTheReaches) {
  const std::vector<std::vector<double>> three{{1.0}, {2.0, 4.0, 5.0}, {3.0, 6.0}};
  EXPECT_EQ(mean_profile(three), (std::vector<double>{2.0, 5.0}));
  EXPECT_THROW(mean_profile({}), std::invalid_argument);
}

TEST(ReachingFiguresTest, SpeedsAreDrawnInCentimetresPerSecond) {
  const std::vector<DrawnProfile> drawn{{"baseline (last cycle)", 0, "solid", {0.0, 0.2, 0.1}},
                                        {"empty", 1, "solid", {}}};
  const Figure figure = speed_figure(drawn, true);
  ASSERT_EQ(figure.series.size(), 1u);
  EXPECT_EQ(figure.series[0].x, (std::vector<double>{0.0, 0.01, 0.02}));
  EXPECT_DOUBLE_EQ(figure.series[0].y[1], 20.0);
  EXPECT_TRUE(figure.simulated);
}

BlockPaths block(const std::string& name, double bulge) {
  BlockPaths paths{name, {0.0, 0.0, 0.0}, {}, {}};
  for (int k = 0; k < 8; ++k) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.25 * std::numbers::pi * k, Vector3d::UnitY()).toRotationMatrix();
    const test::Recorded r = test::transformed(test::arc(0.06, bulge), turn);
    paths.targets.push_back(r.target);
    const std::vector<TimedReach> one{{r.reach(), 0.5, 1.0}};
    paths.paths.push_back(mean_path(one));
  }
  return paths;
}

LearningFigure learning() {
  RandomStream random(4, "a learning curve");
  CycleTable table;
  for (std::size_t p = 0; p < 12; ++p) {
    std::vector<std::optional<double>> row;
    for (int n = 0; n < 32; ++n) {
      row.emplace_back(0.002 + 0.012 * std::exp(-n / 5.0) + 0.003 * random.normal());
    }
    table.values.push_back(row);
  }
  LearningFigure drawn;
  drawn.metric = "Maximum perpendicular error [mm]";
  drawn.scale = 1000.0;
  drawn.curves.push_back({"curl field", learning_curve(table), 13.0, fit_learning(table)->fit});
  drawn.blocks = {{"baseline", 1.0}, {"adaptation", 13.0}};
  drawn.simulated = true;
  return drawn;
}

TEST(ReachingFiguresTest, BlocksShareTheirScale) {
  const std::vector<BlockPaths> blocks{block("baseline", 0.05), block("curl field", 1.2)};
  const auto figures = trajectory_figures(blocks, true);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(figures[0].x_range, figures[1].x_range);
  EXPECT_EQ(figures[0].y_range, figures[1].y_range);
  EXPECT_EQ(figures[1].name, "trajectories-curl-field");
  EXPECT_GT(figures[0].y_range->first, figures[0].y_range->second) << "z points downwards";
  for (const Series& series : figures[1].series) {
    for (const double x : series.x) {
      EXPECT_GE(x, figures[1].x_range->first);
      EXPECT_LE(x, figures[1].x_range->second);
    }
  }
  EXPECT_TRUE(trajectory_figures({}, true).empty());
}

TEST(ReachingFiguresTest, ALearningCurveHasItsMeansAndItsFit) {
  const LearningFigure drawn = learning();
  const Figure figure = learning_figure(drawn);
  const auto& means = figure.series[2];
  ASSERT_EQ(means.x.size(), 32u);
  EXPECT_EQ(means.x.front(), 13.0);
  EXPECT_NEAR(means.y.front(), 1000.0 * drawn.curves[0].points[0].mean, 1e-12);
  EXPECT_LT(means.low.front(), means.y.front());
  const auto& fit = figure.series[3];
  EXPECT_NEAR(fit.y.front(), 1000.0 * drawn.curves[0].fit->at(0.0), 1e-12);
  EXPECT_EQ(fit.x.back(), 44.0);
}

TEST(ReachingFiguresTest, GnuplotDrawsThem) {
  std::vector<Figure> figures =
      trajectory_figures(std::vector{block("baseline", 0.05), block("curl field", 1.2)}, true);
  figures.push_back(learning_figure(learning()));
  const test::TemporaryFolder folder;
  const char* kept = std::getenv("HAPTRIAL_KEEP_FIGURES");  // a folder to look at them
  const std::filesystem::path where = kept != nullptr ? kept : folder.path();
  draw_figures(figures, where);
  for (const Figure& figure : figures) {
    EXPECT_GT(std::filesystem::file_size(where / (figure.name + ".png")), 1000u) << figure.name;
  }
}

}  // namespace
}  // namespace haptrial::analysis
