#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/document/finding.h"
#include "analysis/document/finding_json_internal.h"
#include "core/base/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kOpen = std::numeric_limits<double>::infinity();

FindingRow row_of(const std::string& participant) {
  return {{.name = "participant", .title = "participant", .value = participant},
          {.name = "way", .title = "way", .value = 0.25, .low = 0.125, .high = 0.5, .unit = "m"},
          {.name = "passes", .title = "passes", .value = 12, .form = JsonForm::kPlain}};
}

std::string markdown_of(const FindingTable& table) {
  Document document;
  add_table(document, table, false);
  return to_markdown(document);
}

TEST(FindingTest, ALineSaysValueIntervalUnitAndNumber) {
  EXPECT_EQ(line_of({.name = "way",
                     .title = "Way",
                     .value = 0.25,
                     .low = 0.125,
                     .high = kOpen,
                     .unit = "m",
                     .n = 12}),
            "Way: 0.2500 [0.1250, open] m (n = 12)");
  EXPECT_EQ(line_of({.name = "passes", .title = "Passes", .value = 12}), "Passes: 12");
  EXPECT_EQ(line_of({.name = "way", .title = "Way", .unit = "m", .why_not = "nobody moved"}),
            "Way: not defined, because nobody moved");
}

TEST(FindingTest, EachFormOfJsonHasItsKeys) {
  Finding f{
      .name = "a/b", .title = "B", .value = 2.0, .low = 1.0, .high = 3.0, .unit = "m", .n = 4};
  const auto text = [&](JsonForm form) {
    f.form = form;
    return json_of(FindingRow{f}).dump();
  };
  EXPECT_EQ(
      text(JsonForm::kDescribed),
      R"({"a":{"b":{"title":"B","estimate":2.0,"low_95":1.0,"high_95":3.0,"unit":"m","n":4}}})");
  EXPECT_EQ(text(JsonForm::kAbsent), "{}");
  EXPECT_EQ(text(JsonForm::kPlain), R"({"a":{"b":2.0}})");
  EXPECT_EQ(text(JsonForm::kEstimate),
            R"({"a":{"b":{"estimate":2.0,"low_95":1.0,"high_95":3.0}}})");
  EXPECT_EQ(text(JsonForm::kBeside), R"({"a":{"b":2.0,"b_low_95":1.0,"b_high_95":3.0}})");
  f.why_not = "there is none";
  for (const JsonForm form : {JsonForm::kPlain, JsonForm::kBeside}) {  // no interval of nothing
    EXPECT_EQ(text(form), R"({"a":{"b":{"not_defined":"there is none"}}})");
  }
}

TEST(FindingTest, ATableHasAColumnForEachTitleThatSaysSomething) {
  FindingTable table{"people", "People", {row_of("P01"), row_of("P02")}};
  table.rows[0].push_back({.name = "condition", .title = "condition", .value = ""});
  table.rows[1].push_back({.name = "remark", .title = "remark", .value = "late"});
  EXPECT_THAT(markdown_of(table),
              HasSubstr("| participant | way \\[95 %\\] (m) | passes | remark |\n"
                        "| --- | --- | --- | --- |\n"
                        "| P01 | 0.2500 \\[0.1250, 0.5000\\] | 12 | – |\n"
                        "| P02 | 0.2500 \\[0.1250, 0.5000\\] | 12 | late |\n"));
}

TEST(FindingTest, ATitleThatComesAgainBeginsALine) {
  const FindingRow row{{.name = "participant", .title = "participant", .value = "P01"},
                       {.name = "source", .title = "fit", .value = "posterior"},
                       {.name = "x", .title = "threshold", .value = 2.0},
                       {.name = "source", .title = "fit", .value = "bayesian"},
                       {.name = "y", .title = "threshold", .value = 3.0}};
  EXPECT_THAT(markdown_of({"functions", "Functions", {row}}),
              HasSubstr("| P01 | posterior | 2.000 |\n| P01 | bayesian | 3.000 |\n"));
}

TEST(FindingTest, AnEstimateHasTheLabelsBeforeItAndOnlyNumbersAreEstimates) {
  FindingRow row{{.name = "source", .value = "first"},
                 {.name = "x", .value = 2.0, .low = 1.0, .high = kOpen, .unit = "m", .csv = "x"},
                 {.name = "source", .value = "second"},
                 {.name = "x", .value = 3.0, .csv = "x"},
                 {.name = "y", .value = kOpen, .csv = "y"},
                 {.name = "z", .why_not = "there is none", .csv = "z"}};
  EXPECT_EQ(findings_csv({{"", "", {row}}}, {{"from", "source"}, {"track", "track"}}),
            "from,track,name,estimate,low,high,unit\n"
            "first,,x,2,1,,m\n"
            "second,,x,3,,,\n");
}

TEST(FindingTest, ListsStandBeforeTheMethods) {
  Figure figure;
  figure.name = "ways";
  const std::vector<Drawing> drawings{{figure, "<svg></svg>"}};
  const std::vector<FindingList> lists{{"way",
                                        "Way of the hand",
                                        {{.name = "way", .title = "Mean way", .value = 0.25}},
                                        {{"people", "People", {row_of("P01")}}},
                                        {figure}}};
  Document document;
  document.heading("Results");
  document.heading("Methods");
  add_findings(document, lists, drawings);
  const std::string text = to_markdown(document);
  std::vector<std::size_t> places;
  for (const char* part : {"## Results", "## Way of the hand", "- Mean way: 0.2500", "### People",
                           "| P01 |", "(ways.svg)", "## Methods"}) {
    places.push_back(text.find(part));
    EXPECT_NE(places.back(), std::string::npos) << part;
  }
  EXPECT_TRUE(std::ranges::is_sorted(places)) << text;
  EXPECT_THAT(lines_of(lists.front()), ElementsAre("Mean way: 0.2500", "People: 1 rows"));
  FindingList spelled = lists.front();
  spelled.tables.front().in_lines = true;
  EXPECT_THAT(lines_of(spelled),
              ElementsAre("Mean way: 0.2500", HasSubstr("participant: P01; way: 0.2500")));
  EXPECT_EQ(json_of(lists).dump(),
            R"({"way":{"heading":"Way of the hand","findings":{"way":{"title":"Mean way",)"
            R"("estimate":0.25}},"tables":{"people":[{"participant":"P01","way":{"title":"way",)"
            R"("estimate":0.25,"low_95":0.125,"high_95":0.5,"unit":"m"},"passes":12}]},)"
            R"("figures":["ways"]}})");
}

}  // namespace

// Figures without files that stay are the same pictures as those of a report.

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
