#include "analysis/force_training/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/document/html.h"
#include "analysis/force_training/report/study_figures.h"
#include "analysis/force_training/report/study_json.h"
#include "analysis/force_training/study/study_result.h"
#include "analysis/statistics/design/wording.h"
#include "tests/analysis/force_training/example_study.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;
using testing::Not;

// Stands in for gnuplot's pictures: the same ids in each.
std::vector<Drawing> drawings(const StudyResult& study) {
  std::vector<Drawing> result;
  for (const auto& figure : study_figures(study)) {
    result.push_back({figure,
                      "<?xml version=\"1.0\"?>\n<svg width=\"9\"><defs><path id='gpPt0'/></defs>"
                      "<g id=\"gnuplot_canvas\"><use xlink:href='#gpPt0'/></g></svg>\n"});
  }
  return result;
}

std::string report(const StudyResult& study) {
  const auto pictures = drawings(study);
  return to_html(study_report(study, pictures));
}

std::string markdown(const StudyResult& study) {
  const auto pictures = drawings(study);
  return to_markdown(study_report(study, pictures));
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) {
    ++found;
  }
  return found;
}

TEST(Report, ALoopThatDidNotKeepItsRateIsSaid) {
  auto study = example_study(false);
  EXPECT_THAT(report(study), Not(HasSubstr("did not keep its rate")));
  study.sessions[1].timing.overruns = 850'000;
  EXPECT_THAT(report(study), HasSubstr("The servo loop of P02 did not keep its rate: 850000 of "
                                       "1000000 ticks (85.0 %) overran their period."));
}

TEST(Report, SaysThatParticipantsAreSimulatedExactlyWhenTheyAre) {
  const auto simulated = report(example_study(true));
  EXPECT_THAT(simulated, HasSubstr("class=\"banner\" role=\"note\">SIMULATED PARTICIPANTS"));
  EXPECT_THAT(simulated, HasSubstr("<title>SIMULATED"));
  EXPECT_THAT(report(example_study(false)), Not(HasSubstr("SIMULATED")));
  auto mixed = example_study(false);
  mixed.sessions.back().info.simulated = true;
  EXPECT_THAT(report(mixed), HasSubstr("class=\"banner\" "));
}

TEST(Report, HoldsEveryPartOfTheAnalysis) {
  const auto study = example_study(false);
  const auto html = report(study);
  for (const auto& line : summary_lines(study)) {
    EXPECT_THAT(html, HasSubstr("<li>" + escape_html(line) + "</li>"));
  }
  for (const char* part :
       {"Design and exclusions", "As published", "Participants as the unit", "Table 1", "Learning",
        "How recalls were aligned", "Tracking", "Timing", "Methods, parameters and versions",
        "Mixed model", "Levene", "Mauchly", "Friedman", "d_z", "Generalized", "aborted",
        "0.1.0 (0123abc)", "name = &quot;example&quot;", "1000 / 1020 / 1080 / 1500"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
  EXPECT_EQ(count(html, "<figure>"), 11u);
  EXPECT_EQ(count(html, "<figcaption>"), 11u);
  EXPECT_EQ(count(html, "<svg role=\"img\" aria-label=\""), 11u);
}

TEST(Report, SaysThePlannedTestsAsJournalsWantThem) {
  const auto study = example_study(false);
  const SideTest& test = study.statistics.tests.planned.tests.at(0);
  const auto html = report(study);
  EXPECT_THAT(html, testing::ContainsRegex("Recall error was (not )?significantly lower after "
                                           "visual \\(M = [0-9.]+, SD = [0-9.]+\\) than after "
                                           "haptic"));
  EXPECT_THAT(html, HasSubstr(escape_html(side_result(test) + ", d_z = " + effect(test.size))));
}

TEST(Report, LeadsWithTestsOverParticipants) {
  const auto html = report(example_study(false));
  const auto contents = html.find("</details>");  // names every section
  const auto lead = html.find("Planned, visual");
  const auto participants = html.find("Participants as the unit", contents);
  const auto mixed = html.find("Mixed model", contents);
  const auto published = html.find("As published", contents);
  EXPECT_LT(lead, participants);
  EXPECT_LT(participants, mixed);
  EXPECT_LT(mixed, published);
  EXPECT_NE(published, std::string::npos);
  EXPECT_THAT(html, HasSubstr("These tests assume that all trials are independent."));
  for (const auto& line : summary_lines(example_study(false))) {
    EXPECT_THAT(line, Not(HasSubstr("pooled")));
  }
}

TEST(Report, OfOtherConditionsComparesEveryTwo) {
  auto study = example_study(false);
  for (auto& score : study.scores) {
    score.condition = score.condition == "visual" ? "slow" : score.condition + " fast";
  }
  study.statistics = study_statistics(study.scores);
  EXPECT_TRUE(study.statistics.comparisons.empty());
  ASSERT_EQ(study.statistics.tests.families.size(), 1u);
  ASSERT_EQ(study.statistics.tests.families[0].tests.size(), 3u);
  const auto html = report(study);
  EXPECT_THAT(html, HasSubstr("haptic fast and slow"));
  EXPECT_THAT(html, HasSubstr("No test was planned"));
}

TEST(Report, SaysWhetherTheOrderIsBalanced) {
  auto study = example_study(false);
  EXPECT_THAT(report(study), HasSubstr("Order is not balanced"));  // always haptic first
  EXPECT_THAT(report(study), Not(HasSubstr("counterbalanced")));
}

TEST(Report, IsTheSameInMarkdown) {
  const auto study = example_study(true);
  const auto text = markdown(study);
  EXPECT_TRUE(text.starts_with("# Recall of force patterns\n"));
  EXPECT_THAT(text, HasSubstr("> **SIMULATED PARTICIPANTS"));
  EXPECT_EQ(count(text, "\n## ") + count(text, "\n### "),
            count(report(study), "<h2 ") + count(report(study), "<h3 "));
  EXPECT_EQ(count(text, ".svg)"), 11u);
  EXPECT_THAT(text, HasSubstr("](figure-28-recall-error.svg)"));
  for (const auto& row : study.statistics.table_1) {
    EXPECT_THAT(text, HasSubstr("| " + row.subject + " | " + row.best + " | " + row.worst + " | "));
  }
}

TEST(Markdown, LeavesNothingThatReadsAsMarkup) {
  Document document;
  document.title = "a_b *c*";
  document.table({"x"}, {{"1 | 2\n# 3 <b>"}});
  document.source("file", "one\n```\ntwo");
  const auto text = to_markdown(document);
  EXPECT_THAT(text, HasSubstr("# a\\_b \\*c\\*\n"));
  EXPECT_THAT(text, HasSubstr("| 1 \\| 2 \\# 3 &lt;b&gt; |\n"));
  EXPECT_THAT(text, HasSubstr("````\none\n```\ntwo\n````\n"));
}

// Texts between each `before` and the next quote.
std::vector<std::string> quoted_after(const std::string& text, const std::string& before) {
  std::vector<std::string> result;
  for (std::size_t at = 0; (at = text.find(before, at)) != std::string::npos;) {
    at += before.size();
    result.push_back(text.substr(at, text.find_first_of("\"'", at) - at));
  }
  return result;
}

TEST(Report, NeedsNothingButItself) {
  const auto html = report(example_study(true));
  for (const char* outside : {" src=", "<script", "<link", "@import", "url(http"}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
  EXPECT_EQ(count(html, "href="), count(html, "href='#") + count(html, "href=\"#"));
}

TEST(Report, HasEachIdOnce) {
  const auto html = report(example_study(true));
  auto ids = quoted_after(html, " id=\"");
  const auto single = quoted_after(html, " id='");
  ids.insert(ids.end(), single.begin(), single.end());
  const std::set<std::string> unique(ids.begin(), ids.end());
  EXPECT_EQ(ids.size(), 22u + count(html, "<h2 ") + count(html, "<h3 "));  // figures, contents
  EXPECT_EQ(unique.size(), ids.size());
  for (const char* link : {"href='#", "href=\"#"}) {
    for (const auto& used : quoted_after(html, link)) {
      EXPECT_EQ(unique.count(used), 1u) << used;
    }
  }
}

TEST(Report, EscapesWhatComesFromFiles) {
  auto study = example_study(true);
  const std::string trap = "<script>alert(\"1\")</script>&'";
  study.sessions[0].info.subject = trap;
  study.sessions[0].file = trap;
  study.sessions[0].info.device = trap;
  study.sessions[0].info.definition = trap;
  study.sessions[0].info.definition_name = trap;
  study.sessions[0].info.program_commit = trap;
  study.exclusions[0].reason = trap;
  study.sessions[0].tracking.subject = trap;
  for (auto& s : study.scores) {
    s.subject += trap;
    s.condition += trap;
  }
  study.statistics = study_statistics(study.scores);
  for (auto& picture : study.recalls) {
    picture.score.subject = trap;
  }
  const auto html = report(study);
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;&amp;&#39;"));
}

TEST(Report, PrintsWhyAStatisticIsNotDefined) {
  auto study = example_study(false);
  study.scores.resize(1);
  study.statistics = study_statistics(study.scores);
  study.tracking = summarize_tracking("all", {});
  const auto html = report(study);
  EXPECT_THAT(html, HasSubstr("not defined, because there are fewer than two groups"));
  EXPECT_THAT(html, HasSubstr("not defined, because an interval needs at least two values"));
  for (const char* number : {">nan", " nan", "-nan", "(nan", ">inf", " inf ", "-inf"}) {
    EXPECT_THAT(html, Not(HasSubstr(number)));
  }
}

TEST(Report, OfNoScoredTrialStillStands) {
  StudyResult study;
  study.statistics = study_statistics({});
  const auto html = report(study);
  EXPECT_THAT(html, HasSubstr("No participant has a scored trial in every condition."));
  EXPECT_THAT(html, HasSubstr("</html>"));
}

TEST(Report, SaysWhenTimingDoesNotApply) {
  EXPECT_THAT(report(example_study(true)), HasSubstr("Timing does not apply to these sessions"));
  EXPECT_THAT(report(example_study(true)), Not(HasSubstr("Overruns")));
  EXPECT_THAT(report(example_study(false)), Not(HasSubstr("Timing does not apply")));
  auto mixed = example_study(false);
  mixed.sessions[1].timing.applies = false;
  mixed.sessions[2].timing.complete = false;
  EXPECT_THAT(report(mixed), HasSubstr("Timing does not apply to P02:"));
  EXPECT_THAT(report(mixed), HasSubstr("did not come to its end: P03."));
}

TEST(Json, HoldsTheNumbersOfTheStudy) {
  const auto study = example_study(true);
  const auto json = nlohmann::json::parse(statistics_json(study));
  EXPECT_EQ(json["simulated"], true);
  EXPECT_EQ(json["trials"], 108);
  EXPECT_EQ(json["published"]["one_way_anova"]["f"], study.statistics.anova->f);
  EXPECT_EQ(json["repeated_measures"]["anova"]["p_corrected"],
            study.statistics.repeated->p_corrected);
  EXPECT_EQ(json["conditions"][1]["pooled_trials"]["low_95"],
            study.statistics.summaries[1].trials->low);
  EXPECT_EQ(json["published"]["comparisons"][0]["test"], "visual < haptic");
  EXPECT_EQ(json["participants_as_unit"]["planned"][0]["p_holm"],
            *study.statistics.tests.planned.tests[0].holm);
  EXPECT_EQ(json["participants_as_unit"]["effects"][0]["p"],
            study.statistics.repeated->p_corrected);
  EXPECT_EQ(json["table_1"].size(), 6u);
  EXPECT_EQ(json["exclusions"][2]["subject"], "P03");
  EXPECT_EQ(json["tracking"]["participants"].size(), 6u);
}

TEST(Json, SaysWhyAStatisticIsNotDefined) {
  auto study = example_study(false);
  study.statistics = study_statistics({});
  study.sessions[0].info.device = "caf\xe9";  // not UTF-8
  const auto text = statistics_json(study);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["published"]["one_way_anova"]["not_defined"], "there are fewer than two groups");
  EXPECT_THAT(text, Not(HasSubstr("null")));
}

TEST(Html, EscapesAndAligns) {
  EXPECT_EQ(escape_html("a<b>&\"'\x01\n"), "a&lt;b&gt;&amp;&quot;&#39;\n");
  const auto table = html_table({"Name", "Value"}, {{"1", "2.5"}, {"<x>", "-3"}});
  EXPECT_THAT(table, HasSubstr("<tr><td>&lt;x&gt;</td><td class=\"n\">-3</td></tr>"));
}

TEST(Wording, RoundsForReaders) {
  EXPECT_EQ(number(3.04), "3.040");
  EXPECT_EQ(number(1234.4), "1234");
  EXPECT_EQ(p_value(0.00099), "p < 0.001");
  EXPECT_EQ(p_value(0.0123), "p = 0.012");
  EXPECT_EQ(p_value(0.5), "p = 0.50");
  EXPECT_EQ(p_value(0.04987), "p = 0.0499");
  EXPECT_EQ(p_value(0.049996), "p = 0.049996");
  EXPECT_EQ(p_value(0.05), "p = 0.050");
  EXPECT_EQ(p_value(0.0504), "p = 0.0504");
  EXPECT_EQ(p_value(0.0506), "p = 0.051");
  EXPECT_EQ(counted(1, "pass"), "1 pass");
  EXPECT_EQ(counted(3, "pass"), "3 passes");
  EXPECT_EQ(quantity(Undefined{"of this"}, 1.0, "m"), "not defined, because of this");
}

}  // namespace
}  // namespace haptrial::analysis
