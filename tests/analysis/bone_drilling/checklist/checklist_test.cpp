#include "analysis/bone_drilling/checklist/checklist.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "analysis/bone_drilling/checklist/checklist_sheet.h"
#include "analysis/bone_drilling/report/checklist_section.h"
#include "tests/analysis/bone_drilling/hand_made.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::drilling::checklist_test {
namespace {

using testing::HasSubstr;

constexpr const char* kText = R"(name = "Mastoidectomy"
[[items]]
name = "time"
text = "Done <soon>"
points = 4
weight = 3.0
measure = "time"
none = 10.0
full = 2.0
[[items]]
name = "smooth"
text = "Walls are smooth"
)";

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

Checklist read(const std::string& text) {
  const test::TemporaryFolder folder;
  write(folder / "list.toml", text);
  return load_checklist(folder / "list.toml");
}

ProcedureSummary lasting(int seconds) {
  Procedure p = test::procedure_on(test::block(4, 4, 4));
  for (int n = 0; n < 1000 * seconds; ++n) {
    p.ticks.push_back(test::drilling_tick(static_cast<std::uint64_t>(n), {1e-3, 1e-3, 1e-3}));
  }
  StudyBones bones;
  return summarize(p, {}, bones);
}

TEST(ChecklistTest, MeasuresProposePointsInProportion) {
  const Checklist list = read(kText);
  ASSERT_EQ(list.items.size(), 2u);
  const int expected[][2] = {{1, 4}, {2, 4}, {3, 3},  {4, 3}, {5, 2},
                             {6, 2}, {9, 0}, {10, 0}, {12, 0}};
  for (const auto& [seconds, points] : expected) {
    EXPECT_EQ(proposed_points(list.items[0], lasting(seconds)), points) << seconds << " s";
  }
  EXPECT_EQ(proposed_points(list.items[1], lasting(1)), std::nullopt);
  EXPECT_DOUBLE_EQ(total_of(list, {2, 1}), 100.0 * (3.0 * 0.5 + 1.0) / 4.0);
}

// "All points from this one on": a limit that is not reached is not met.
TEST(ChecklistTest, AnItemOfOnePointIsMetAtItsLimitOnly) {
  Checklist list = read(kText);
  list.items[0].points = 1;
  EXPECT_EQ(proposed_points(list.items[0], lasting(2)), 1);
  EXPECT_EQ(proposed_points(list.items[0], lasting(3)), 0);
}

// (1 - 0.3) / (1.1 - 0.3) of 8 points are 7, and a little less in binary numbers.
TEST(ChecklistTest, AWholeNumberOfPointsIsNotLostToRounding) {
  Checklist list = read(kText);
  list.items[0].points = 8;
  list.items[0].none = 0.3;
  list.items[0].full = 1.1;
  EXPECT_EQ(proposed_points(list.items[0], lasting(1)), 7);
}

TEST(ChecklistTest, MistakesAreSaid) {
  const auto refusal = [](const std::string& from, const std::string& to) {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    return test::message_of([&] { read(text); });
  };
  EXPECT_THAT(refusal("points = 4", "points = 0"), HasSubstr("points"));
  EXPECT_THAT(refusal("full = 2.0", "full = 10.0"), HasSubstr("another value than none"));
  EXPECT_THAT(refusal("measure = \"time\"\n", ""), HasSubstr("stands without a measure"));
  EXPECT_THAT(refusal("name = \"smooth\"", "name = \"time\""), HasSubstr("no other item has"));
  EXPECT_THAT(refusal("weight", "wieght"), HasSubstr("weight"));
  Checklist list = read(kText);
  list.items[0].measure = "tme";
  EXPECT_THAT(test::message_of([&] { check_measures(list, lasting(1), "list.toml"); }),
              HasSubstr("list.toml: measure of item \"time\" is \"tme\"; allowed: visible_share,"));
}

TEST(ChecklistTest, ThePageHasEveryItemOfEveryProcedure) {
  const std::string html =
      checklist_page(read(kText), {{"K7QM", "K7QM.mp4", {3, {}}}, {"ABCD", "ABCD.mp4", {{}, {}}}});
  EXPECT_THAT(html, HasSubstr("Done &lt;soon&gt;"));
  EXPECT_THAT(html, HasSubstr("<option value=\"3\" selected>3 of 4 (measured)</option>"));
  EXPECT_THAT(html, HasSubstr("src=\"ABCD.mp4\""));
  std::size_t selects = 0;
  for (std::size_t at = html.find("<select"); at != std::string::npos;
       at = html.find("<select", at + 1)) {
    ++selects;
  }
  EXPECT_EQ(selects, 4u);
}

std::vector<CheckedRow> sheet(const std::string& rows) {
  const test::TemporaryFolder folder;
  write(folder / "Li-checklist.csv", "code,item,points\n" + rows);
  EXPECT_TRUE(is_checklist_sheet(folder / "Li-checklist.csv"));
  return read_checklist_sheet(folder / "Li-checklist.csv", read(kText), {"A", "B"});
}

TEST(ChecklistSheetTest, IsReadAndMistakesAreSaid) {
  const auto rows = sheet("A,time,3\nA,smooth,1\n\"B\",\"smooth\",0\nB,time,4\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].rater, "Li");
  EXPECT_EQ(rows[1].points, std::vector<int>({4, 0}));
  const auto refusal = [](const std::string& text) {
    return test::message_of([&] { sheet(text); });
  };
  EXPECT_THAT(refusal("C,time,3\n"), HasSubstr("a code of this study's page"));
  EXPECT_THAT(refusal("A,tidy,3\n"), HasSubstr("an item of checklist \"Mastoidectomy\""));
  EXPECT_THAT(refusal("A,time,5\n"), HasSubstr("a whole number from 0 to 4"));
  EXPECT_THAT(refusal("A,time,3\nA,time,3\n"), HasSubstr("each item once for a code"));
  EXPECT_THAT(refusal("A,time,3\n"), HasSubstr("A has no points for item \"smooth\""));
  EXPECT_THAT(refusal("A,time,3\nA,smooth,1\n"), HasSubstr("has 1 of the 2 codes"));
}

TEST(ChecklistSheetTest, TheTableIsReadAsItWasWritten) {
  const test::TemporaryFolder folder;
  const std::vector<CheckedRow> rows{{"S01.h5", 1, "Li", {3, 1}, {4, -1}},
                                     {"S01.h5", 2, "Li", {0, 0}, {1, -1}}};
  write(folder / "checklist.csv", checked_csv(read(kText), rows));
  EXPECT_EQ(load_checked(folder / "checklist.csv", read(kText)), rows);
}

TEST(ChecklistSheetTest, AChecklistChangedAfterRatingIsRefused) {
  const test::TemporaryFolder folder;
  write(folder / "checklist.csv", checked_csv(read(kText), {{"S01.h5", 1, "Li", {3, 1}, {4, -1}}}));
  Checklist points = read(kText), weight = points;
  points.items[0].points = 9;
  weight.items[1].weight = 0.5;
  const auto refusal = [&](const Checklist& list) {
    return test::message_of([&] { load_checked(folder / "checklist.csv", list); });
  };
  EXPECT_THAT(refusal(points), HasSubstr(":2: most is '4'; allowed: 9, as checklist"));
  EXPECT_THAT(refusal(weight), HasSubstr("weight is '1'; allowed: 0.5"));
}

TEST(ChecklistSectionTest, AgreementIsThatOfTheTotals) {
  CheckedStudy study{read(kText), {}};
  const int points[][4] = {{4, 1, 4, 1}, {2, 1, 2, 0}, {0, 0, 1, 0}, {3, 1, 3, 1}};
  Eigen::MatrixXd totals(4, 2);
  for (int n = 0; n < 4; ++n) {
    const auto& p = points[n];
    study.rows.push_back({"S01.h5", n + 1, "B", {p[2], p[3]}, {-1, -1}});
    study.rows.push_back({"S01.h5", n + 1, "A", {p[0], p[1]}, {4, -1}});
    totals(n, 0) = 25.0 * (0.75 * p[0] + p[1]);
    totals(n, 1) = 25.0 * (0.75 * p[2] + p[3]);
  }
  const auto agreement = checklist_agreement(study);
  ASSERT_TRUE(agreement);
  EXPECT_NEAR(agreement->random_raters->value, intraclass_correlation(totals)->random_raters->value,
              1e-12);
  EXPECT_EQ(same_points(study, 0), 0.75);
  EXPECT_EQ(same_points(study, 1), 0.75);
  Document document;
  add_findings(document, {checklist_findings(study, {}, {"surgeons"})}, {});
  const std::string text = to_markdown(document);
  EXPECT_THAT(text, HasSubstr("Checklist: Mastoidectomy"));
  EXPECT_THAT(text, HasSubstr("ICC(2,1)"));
  EXPECT_THAT(text, HasSubstr("there is none: participants have several"));
  const Finding one_person = checklist_findings(study, {}, {}).findings.back();
  EXPECT_TRUE(std::isnan(one_person.low)) << "four procedures of one participant";
  std::vector<ProcedureSummary> people(4);
  for (int n = 0; n < 4; ++n) {
    people[static_cast<std::size_t>(n)].session = "S01.h5";
    people[static_cast<std::size_t>(n)].number = n + 1;
    people[static_cast<std::size_t>(n)].participant = std::string(1, static_cast<char>('a' + n));
  }
  EXPECT_EQ(checklist_findings(study, people, {}).findings.back().low,
            agreement->random_raters->low);
}

}  // namespace
}  // namespace haptrial::analysis::drilling::checklist_test
