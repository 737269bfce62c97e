#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/force_training/report/study_figures.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "tests/analysis/force_training/example_study.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class Figures : public testing::Test {
 protected:
  Figures() : folder_(fs::path(testing::TempDir()) / ("figures " + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Figures() override { fs::remove_all(folder_); }

  std::string read(const std::string& name) const { return file_text(folder_ / name); }

  fs::path folder_;
};

Figure simple() {
  Figure figure;
  figure.name = "simple";
  figure.title = "t";
  figure.series = {{"line", Mark::kLine, {}, {0, 1, 2}, {0, 1, 4}}};
  return figure;
}

// Width and height are big-endian at byte 16 of a PNG.
unsigned big_endian(const std::string& bytes, std::size_t at) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  }
  return value;
}

TEST_F(Figures, OfAPaperAreAsWideAsItsColumnAndHaveNoTitle) {
  Figure figure = simple();
  figure.title = "Tracks of S01";
  figure.simulated = true;
  draw_figures({figure}, folder_, 85);
  const std::string pdf = read("simple.pdf");
  const std::size_t box = pdf.find("/MediaBox");
  ASSERT_NE(box, std::string::npos);
  double width = 0.0, height = 0.0;
  ASSERT_EQ(std::sscanf(pdf.c_str() + box, "/MediaBox [ 0 0 %lf %lf", &width, &height), 2);
  EXPECT_NEAR(width, 85.0 / 25.4 * 72.0, 1.0) << "in points";
  EXPECT_NEAR(height, 0.6 * width + 10.0 / 25.4 * 72.0, 1.0) << "with room for the key";
  EXPECT_NE(pdf.find("/FontFile"), std::string::npos) << "fonts are inside";
  EXPECT_THAT(read("simple-paper.svg"), HasSubstr("width=\"85mm\" height=\"61.0mm\""));
  const std::string script = gnuplot_script(figure, 85);
  const std::string paper = script.substr(script.find("unset label 1"));
  EXPECT_THAT(paper, HasSubstr("SIMULATED"));
  EXPECT_THAT(paper, Not(HasSubstr("Tracks of S01")));
  draw_figures({figure}, folder_);
  EXPECT_THAT(gnuplot_script(figure), Not(HasSubstr("pdf")));
}

TEST_F(Figures, OfAStudyAreAllDrawn) {
  const auto figures = study_figures(example_study(true));
  EXPECT_EQ(figures.size(), 11u);  // 28, learning twice, 26 and 27 three times, 22, 23
  draw_figures(figures, folder_);
  for (const auto& figure : figures) {
    EXPECT_FALSE(figure.alt.empty() || figure.caption.empty());
    const auto svg = read(figure.name + ".svg");
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    EXPECT_THAT(svg, HasSubstr("SIMULATED PARTICIPANTS"));
    const auto png = read(figure.name + ".png");
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(big_endian(png, 16), 1800u);
    EXPECT_EQ(big_endian(png, 20), 1080u);
    EXPECT_GT(png.size(), 10'000u);  // not an empty frame
  }
  // Only the pictures stay.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 22);
}

TEST_F(Figures, OfRealParticipantsCarryNoMark) {
  auto figures = study_figures(example_study(false));
  figures.resize(1);
  draw_figures(figures, folder_);
  EXPECT_THAT(read("figure-28-recall-error.svg"), Not(HasSubstr("SIMULATED")));
}

TEST_F(Figures, GiveTheSameSvgTwice) {
  draw_figures(study_figures(example_study(true)), folder_);
  const auto first = read("figure-28-recall-error.svg") + read("figure-26-alignment-best.svg");
  draw_figures(study_figures(example_study(true)), folder_);
  EXPECT_EQ(first, read("figure-28-recall-error.svg") + read("figure-26-alignment-best.svg"));
}

TEST_F(Figures, TextFromOutsideStaysText) {
  Figure figure = simple();
  const fs::path trap = folder_ / "trap";
  figure.title = "it's `touch trap` \"$(touch trap)\"\nsystem('touch trap') \\";
  figure.series[0].label = "'; system('touch trap'); '";
  figure.x_names = {{1.0, "`touch trap`'"}};
  draw_figures({figure}, folder_);
  EXPECT_FALSE(fs::exists(trap));
  EXPECT_THAT(read("simple.svg"), HasSubstr("`touch trap`"));
}

TEST_F(Figures, OfNoDataAreNotAttempted) {
  StudyResult nothing;
  EXPECT_TRUE(study_figures(nothing).empty());
}

TEST_F(Figures, RejectColumnsThatDoNotFit) {
  Figure figure = simple();
  figure.series[0].y.pop_back();
  EXPECT_THROW(gnuplot_script(figure), std::invalid_argument);
  figure = simple();
  figure.series[0].mark = Mark::kBars;
  EXPECT_THROW(gnuplot_script(figure), std::invalid_argument);
  figure = simple();
  figure.name = "../escape";
  EXPECT_THROW(gnuplot_script(figure), std::invalid_argument);
}

TEST_F(Figures, SayThatGnuplotIsAbsent) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder_.c_str(), 1);
  try {
    draw_figures({simple()}, folder_);
    ADD_FAILURE() << "drew without gnuplot";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gnuplot-nox"));
  }
  ::setenv("PATH", path.c_str(), 1);
}

TEST_F(Figures, SayThatGnuplotFailed) {
  const std::string path = std::getenv("PATH");
  std::ofstream(folder_ / "gnuplot") << "#!/bin/sh\necho out of ink >&2\nexit 3\n";
  fs::permissions(folder_ / "gnuplot", fs::perms::owner_all);
  ::setenv("PATH", (folder_.string() + ":" + path).c_str(), 1);
  try {
    draw_figures({simple()}, folder_);
    ADD_FAILURE() << "drew with a failing gnuplot";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("status 3"), HasSubstr("out of ink")));
  }
  ::setenv("PATH", path.c_str(), 1);
}

TEST_F(Figures, SayThatAPictureIsCutShort) {
  const std::string path = std::getenv("PATH");
  std::ofstream(folder_ / "gnuplot") << "#!/bin/sh\nprintf '<svg>' > simple.svg\n";
  fs::permissions(folder_ / "gnuplot", fs::perms::owner_all);
  ::setenv("PATH", (folder_.string() + ":" + path).c_str(), 1);
  try {
    draw_figures({simple()}, folder_);
    ADD_FAILURE() << "took half a picture";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("simple.svg"), HasSubstr("disk full")));
  }
  ::setenv("PATH", path.c_str(), 1);
}

}  // namespace

// Contents of the figures, before anything is drawn.

namespace {

using testing::ElementsAre;

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
