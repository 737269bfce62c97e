// Contents of the figures, before anything is drawn.
#include "analysis/force_training/report/study_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "tests/analysis/force_training/example_study.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const Figure& named(const std::vector<Figure>& figures, const std::string& name) {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
  EXPECT_NE(found, figures.end()) << name;
  return *found;
}

const Series& labelled(const Figure& figure, const std::string& label) {
  const auto found = std::find_if(figure.series.begin(), figure.series.end(),
                                  [&](const Series& s) { return s.label == label; });
  EXPECT_NE(found, figure.series.end()) << label;
  return *found;
}

TEST(StudyFigures, RecallErrorShowsMeansIntervalsAndEveryParticipant) {
  const auto study = example_study(true);
  const auto figures = study_figures(study);
  const auto& figure = named(figures, "figure-28-recall-error");
  EXPECT_EQ(figure.x_names[2].second, "Visuohaptic");
  const auto& bars = labelled(figure, "mean of participants' means, 95 % CI");
  const auto& people = labelled(figure, "mean of one participant");
  ASSERT_EQ(people.y.size(), 18u);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& interval = *study.statistics.summaries[c].participants;
    EXPECT_EQ(bars.y[c], interval.mean);
    EXPECT_EQ(bars.low[c], interval.low);
    EXPECT_EQ(bars.high[c], interval.high);
    for (std::size_t p = 0; p < 6; ++p) {
      EXPECT_EQ(people.y[6 * c + p], study.statistics.table_1[p].means[c]);
      EXPECT_NEAR(people.x[6 * c + p], figure.x_names[c].first, 0.4);
    }
  }
  // Nothing lies outside the axes.
  EXPECT_EQ(figure.y_range->first, 0.0);
  EXPECT_GT(figure.y_range->second, *std::max_element(people.y.begin(), people.y.end()));
  EXPECT_GT(figure.y_range->second, *std::max_element(bars.high.begin(), bars.high.end()));
}

TEST(StudyFigures, AMeanWithoutAnIntervalIsStillShown) {
  auto study = example_study(true);
  study.scores.resize(1);
  study.statistics = study_statistics(study.scores);
  const auto figures = study_figures(study);
  const auto& figure = named(figures, "figure-28-recall-error");
  EXPECT_THAT(figure.series.back().y, ElementsAre(study.scores[0].score));
  EXPECT_EQ(figure.series.back().mark, Mark::kPoints);
}

TEST(StudyFigures, ConditionsDifferInMoreThanColour) {
  const auto figures = study_figures(example_study(true));
  const auto& figure = named(figures, "learning");
  ASSERT_EQ(figure.series.size(), 6u);
  std::set<std::string> colors, dashes;
  std::set<int> points;
  const auto study = example_study(true);
  for (const auto& s : figure.series) {
    if (s.label.empty()) {  // each participant's mean at each of three repetitions
      EXPECT_EQ(s.y.size(), 3u * study.statistics.subjects.size());
      continue;
    }
    colors.insert(s.look.color);
    dashes.insert(s.look.dash);
    points.insert(s.look.point);
    EXPECT_EQ(s.y.size(), 3u);
  }
  EXPECT_EQ(colors.size(), 3u);
  EXPECT_EQ(dashes.size(), 3u);
  EXPECT_EQ(points.size(), 3u);
}

TEST(StudyFigures, AlignmentLinesJoinPointsOfBothCurves) {
  const auto study = example_study(true);
  const auto figures = study_figures(study);
  const auto& figure = named(figures, "figure-26-alignment-median");
  const auto& pairs = labelled(figure, "aligned points");
  const auto& target = labelled(figure, "target");
  const auto& applied = labelled(figure, "applied");
  EXPECT_GT(pairs.x.size(), 30u);
  EXPECT_LT(pairs.x.size(), 130u);  // a picture, not a carpet
  const auto lies_on = [](double x, double y, const Series& curve) {
    const auto at = std::find(curve.x.begin(), curve.x.end(), x);
    return at != curve.x.end() && curve.y[static_cast<std::size_t>(at - curve.x.begin())] == y;
  };
  for (std::size_t k = 0; k < pairs.x.size(); ++k) {
    EXPECT_TRUE(lies_on(pairs.x[k], pairs.y[k], target));
    EXPECT_TRUE(lies_on(pairs.x2[k], pairs.y2[k], applied));
  }
  EXPECT_EQ(target.x.back(), study.recalls[1].duration);
  EXPECT_THAT(figure.title, HasSubstr("median recall, P01 trial 8"));
}

TEST(StudyFigures, StimulusIsInCentimetresAndNewtons) {
  const auto study = example_study(true);
  const auto figures = study_figures(study);
  const auto& path = named(figures, "figure-22-trajectory");
  EXPECT_NEAR(path.series[0].x.back() - path.series[0].x.front(), 10.0, 1e-9);
  EXPECT_TRUE(path.equal_scale);
  const auto& force = named(figures, "figure-23-force-pattern");
  EXPECT_EQ(force.series[0].y[10], study.stimulus[10].force);
}

TEST(StudyFigures, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const auto& figure : study_figures(example_study(false))) {
    EXPECT_TRUE(names.insert(figure.name).second);
    EXPECT_FALSE(figure.simulated);
    EXPECT_FALSE(figure.title.empty() || figure.x_label.empty() || figure.y_label.empty());
  }
}

}  // namespace
}  // namespace haptrial::analysis
