// Findings of a program of one's own, through the analysis of each protocol: no file of the product
// knows them.
#include "analysis/exchange/own_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/file_text.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/line/whole_command.h"
#include "tests/experiments/command.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::own_findings_test {
namespace {

using analysis::FindingList;
using testing::HasSubstr;
using Files = std::vector<std::filesystem::path>;

/// Passes of each session, their sum, and a figure of them.
FindingList count_passes(const Files& sessions) {
  FindingList list;
  list.heading = "Passes of each participant";
  analysis::FindingTable table{"sessions", "Sessions"};
  analysis::Figure figure;
  figure.name = "passes";
  figure.title = "Passes";
  analysis::Series& series = figure.series.emplace_back();
  std::size_t sum = 0;
  for (const std::filesystem::path& file : sessions) {
    const record::SessionReader session(file);
    const std::size_t passes = session.passes().size();
    sum += passes;
    table.rows.push_back(
        {{.name = "participant", .title = "participant", .value = session.info().subject},
         {.name = "passes", .title = "passes", .value = passes}});
    series.x.push_back(static_cast<double>(series.x.size() + 1));
    series.y.push_back(static_cast<double>(passes));
  }
  list.findings.push_back(
      {.name = "passes", .title = "Passes of the study", .value = sum, .n = sessions.size()});
  list.findings.push_back({.name = "slope", .title = "Slope", .why_not = "nothing was fitted"});
  list.tables.push_back(table);
  list.figures.push_back(figure);
  return list;
}

/// Analyses a study in a program that adds the source, a child of this one.
void analyze_with_source(const std::string& study, const std::string& terminal) {
  const auto child = [&] {
    if (std::freopen(terminal.c_str(), "w", stdout) == nullptr) {
      return 3;
    }
    analysis::add_finding_source({"counts", count_passes});
    CLI::App app;
    int status = 0;
    declare_subcommands(app, status);
    app.parse(std::vector<std::string>{study, "analyze"});  // CLI11 takes the last word first
    return std::fclose(stdout) == 0 ? status : 4;
  };
  EXPECT_EXIT(std::_Exit(child()), testing::ExitedWithCode(0), "");
}

struct StudyCase {
  const char* definition;  // a shipped one; empty: a small drilling
  const char* trials;
  const char* json;  // file with the results
};

class OwnFindings : public testing::TestWithParam<StudyCase> {};

TEST_P(OwnFindings, StandInReportJsonTableAndTerminal) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "study").string();
  const std::string shipped = GetParam().definition;
  const std::string definition = shipped.empty()
                                     ? test::write_small_drilling(folder.path(), 2.0).string()
                                     : HAPTRIAL_SOURCE_DIR "/experiments/" + shipped;
  const test::CommandResult dry =
      test::run_command("haptrial dry-run '" + definition + "' --subjects 2 --trials " +
                        GetParam().trials + " --out '" + out + "'");
  ASSERT_EQ(dry.status, 0) << dry.errors;
  analyze_with_source(out, (folder / "terminal").string());
  const std::string terminal = file_text(folder / "terminal");

  const std::size_t first = record::SessionReader(folder / "study/S01.h5").passes().size();
  const std::size_t second = record::SessionReader(folder / "study/S02.h5").passes().size();
  const std::string line = "Passes of the study: " + std::to_string(first + second) + " (n = 2)";
  EXPECT_THAT(terminal, HasSubstr("\n" + line + "\n"));
  EXPECT_THAT(terminal, HasSubstr("\nSlope: not defined, because nothing was fitted\n"));

  const std::string report = file_text(folder / "study/report.md");
  EXPECT_THAT(report, HasSubstr("## Passes of each participant (simulated)\n\n- " + line));
  EXPECT_THAT(report, HasSubstr("| S02 | " + std::to_string(second) + " |"));
  EXPECT_THAT(report, HasSubstr("(own-counts-passes.svg)"));
  EXPECT_LT(report.find("## Passes of each"), report.find("## Methods"));
  EXPECT_THAT(file_text(folder / "study/own-counts-passes.svg"), HasSubstr("SIMULATED"));

  const auto json =
      nlohmann::json::parse(file_text(folder / "study" / GetParam().json)).at("own_findings");
  const auto& own = json.at("counts");
  EXPECT_EQ(own.at("findings").at("passes").at("estimate"), first + second);
  EXPECT_EQ(own.at("findings").at("slope").at("not_defined"), "nothing was fitted");
  EXPECT_EQ(own.at("tables").at("sessions").at(1).at("participant"), "S02");

  EXPECT_EQ(file_text(folder / "study/own_findings.csv"),
            "findings,participant,name,estimate,low,high,unit\n"
            "counts,,passes," +
                std::to_string(first + second) +
                ",,,\n"
                "counts,S01,passes," +
                std::to_string(first) +
                ",,,\n"
                "counts,S02,passes," +
                std::to_string(second) + ",,,\n");
}

INSTANTIATE_TEST_SUITE_P(Protocols, OwnFindings,
                         testing::Values(StudyCase{"first_experiment.toml", "4", "results.json"},
                                         StudyCase{"force_training.toml", "3", "statistics.json"},
                                         StudyCase{"", "1", "statistics.json"}));

TEST(OwnFindingsTest, ASourceNeedsAPlainNameOfItsOwn) {
  const auto nothing = [](const Files&) { return FindingList{}; };
  for (const char* name : {"", "two words", "../up"}) {
    EXPECT_THROW(analysis::add_finding_source({name, nothing}), std::invalid_argument) << name;
  }
  analysis::add_finding_source({"first", nothing});
  EXPECT_THROW(analysis::add_finding_source({"first", nothing}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::experiments::own_findings_test
