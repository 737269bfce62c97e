#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

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
}  // namespace haptrial::analysis
