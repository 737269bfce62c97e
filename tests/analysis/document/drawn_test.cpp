// Figures without files that stay are the same pictures as those of a report.

#include <gtest/gtest.h>

#include "analysis/document/figure_gnuplot.h"
#include "core/base/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

Figure small_figure(const std::string& name) {
  Figure figure;
  figure.name = name;
  figure.title = "a title";
  figure.simulated = true;
  figure.series = {{"a series", Mark::kLine, {}, {0.0, 1.0}, {0.0, 2.0}}};
  return figure;
}

TEST(DrawnTest, PicturesAreThoseOfAReport) {
  const std::vector<Figure> figures{small_figure("one"), small_figure("two")};
  const test::TemporaryFolder folder;
  draw_figures(figures, folder.path());
  const std::vector<Drawing> drawings = drawn(figures);
  ASSERT_EQ(2U, drawings.size());
  for (std::size_t i = 0; i < figures.size(); ++i) {
    EXPECT_EQ(drawings[i].figure.name, figures[i].name);
    EXPECT_EQ(drawings[i].svg, file_text(folder / (figures[i].name + ".svg")));
  }
  EXPECT_TRUE(drawn({}).empty());
}

/// gnuplot takes the names of ticks for formats.
TEST(DrawnTest, NamesOfTicksAreDrawnAsTheyAre) {
  Figure figure = small_figure("names");
  figure.x_names = {{0.0, "half, 50 %"}, {1.0, "all of 100%d"}};
  const std::vector<Drawing> drawings = drawn({figure});
  EXPECT_NE(drawings.at(0).svg.find("half, 50 %"), std::string::npos);
  EXPECT_NE(drawings.at(0).svg.find("all of 100%d"), std::string::npos);
}

}  // namespace
}  // namespace haptrial::analysis
