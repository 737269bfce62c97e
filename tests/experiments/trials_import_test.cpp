// haptrial import: a study of trials that another program presented.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;
using testing::Not;

using Row = std::map<std::string, std::string>;

/// The rows of a table without quotes, by the names of its columns.
std::vector<Row> rows_of(const fs::path& file) {
  std::istringstream text(test::read_text(file));
  const auto fields = [](const std::string& line) {
    std::vector<std::string> all;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) {
      all.push_back(field);
    }
    return all;
  };
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = fields(line);
  std::vector<Row> rows;
  while (std::getline(text, line)) {
    Row row;
    const std::vector<std::string> values = fields(line);
    for (std::size_t i = 0; i < values.size(); ++i) {
      row[names[i]] = values[i];
    }
    rows.push_back(row);
  }
  return rows;
}

class TrialsImportTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const {
    return fmt::format("'{}'", (folder_ / name).string());
  }

  /// The trials of an exported study in one table, as another program might have written them.
  void write_table(const std::string& tables, const std::string& name) {
    std::map<std::string, Row> levels;
    for (const Row& row : rows_of(folder_ / (tables + "/levels.csv"))) {
      levels[row.at("subject") + row.at("pass")] = row;
    }
    std::ofstream out(folder_ / name);
    out << "subject,staircase,stim,response,correct,rt_s,simulated\n";
    for (const Row& row : rows_of(folder_ / (tables + "/responses.csv"))) {
      const auto level = levels.find(row.at("subject") + row.at("pass"));
      if (level != levels.end()) {
        out << row.at("subject") << ',' << level->second["track"] << ',' << level->second["applied"]
            << ',' << row.at("text") << ',' << row.at("correct") << ',' << row.at("reaction_time")
            << ",true\n";
      }
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(TrialsImportTest, GivesTheEstimatesOfTheNativeSessions) {
  const std::string definition =
      fmt::format("'{}/experiments/stiffness_discrimination.toml'", HAPTRIAL_SOURCE_DIR);
  const CommandResult native = run_command(
      fmt::format("haptrial dry-run {} --subjects 3 --out {} && haptrial analyze {} && haptrial "
                  "export --csv {} {}",
                  definition, path("native"), path("native"), path("tables"), path("native")));
  ASSERT_EQ(native.status, 0) << native.errors;
  write_table("tables", "theirs.csv");
  const CommandResult run = run_command(fmt::format(
      "haptrial import {} --column level=stim --definition {} --out {} && haptrial analyze {} && "
      "haptrial info {}/S01.h5",
      path("theirs.csv"), definition, path("study"), path("study"), path("study")));
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(test::read_text(folder_ / "study/estimates.csv"),
            test::read_text(folder_ / "native/estimates.csv"));
  const std::string sum = run_command("sha256sum " + path("theirs.csv") + " | cut -c-64").output;
  EXPECT_THAT(run.output, HasSubstr("theirs.csv, SHA-256 " + sum.substr(0, 64)));
  EXPECT_THAT(run.output, HasSubstr("recording   imported: no ticks were recorded"));
  EXPECT_THAT(test::read_text(folder_ / "study/report.md"), HasSubstr("SIMULATED"));
  EXPECT_THAT(test::read_text(folder_ / "study/report.md"), Not(HasSubstr("force limit")));
}

// R 4.2.2: glm(cbind(faster, slower) ~ speed, binomial(probit)); -intercept / slope of each.
TEST_F(TrialsImportTest, GivesTheThresholdsOfRForPeopleOfAnotherLaboratory) {
  const auto data = test::shared_data("psychometric/vibro_exp3.csv");
  if (!data) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds psychometric/vibro_exp3.csv";
  }
  const std::map<std::string, std::pair<double, double>> theirs{
      {"MI", {9.07496303, 8.53275227}}, {"NI", {8.65494077, 8.39214017}},
      {"MA", {8.67804586, 8.77122643}}, {"RV", {9.12969822, 8.55203558}},
      {"FA", {8.39313500, 8.05864180}}, {"NN", {8.29155284, 7.91248153}},
      {"AK", {8.29257927, 8.36820004}}, {"AR", {7.74553138, 8.81536436}},
      {"DN", {8.82812764, 8.28101001}}};
  const std::string expand =
      "awk -F, '{gsub(/\"/, \"\")} NR == 1 {print \"subject,speed,vibration,response\"} NR > 1 "
      "{for (i = 0; i < $3 + $4; ++i) print $5 \",\" $1 \",\" $2 \",\" (i < $3 ? \"faster\" : "
      "\"slower\")}' ";
  const CommandResult run = run_command(fmt::format(
      "set -e; {} '{}' > {}; haptrial import {} --column level=speed --factor vibration --yes "
      "faster --guess 0 --out {}; sed -i '$alapse = 0.0' {}; haptrial import {} --column "
      "level=speed --definition {} --out {}; haptrial analyze {}",
      expand, data->string(), path("t.csv"), path("t.csv"), path("first"), path("first/study.toml"),
      path("t.csv"), path("first/study.toml"), path("study"), path("study")));
  ASSERT_EQ(run.status, 0) << run.errors;
  int compared = 0;
  for (const Row& row : rows_of(folder_ / "study/estimates.csv")) {
    if (row.at("source") == "likelihood" && row.at("name") == "threshold") {
      const auto& [still, vibrating] = theirs.at(row.at("participant"));
      EXPECT_NEAR(std::stod(row.at("estimate")), row.at("vibration") == "0" ? still : vibrating,
                  1e-6)
          << row.at("participant");
      ++compared;
    }
  }
  EXPECT_EQ(compared, 18);
}

TEST_F(TrialsImportTest, WhatWasImportedIsExportedIfNoTimesAreNeeded) {
  test::write_text(folder_ / "t.csv",
                   "subject,level,response,correct\nP1,1,left,1\nP1,2,right,0\nP1,3,,\n");
  const CommandResult run = run_command(fmt::format(
      "haptrial import {} --out {} && haptrial export --csv {} {} && haptrial export --psych-ds {} "
      "{} && /usr/bin/python3 '{}/tests/analysis/exchange/read_psych_ds.py' {} {}/P1.h5",
      path("t.csv"), path("study"), path("csv"), path("study"), path("psych"), path("study"),
      HAPTRIAL_SOURCE_DIR, path("psych"), path("study")));
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("1 trial without an answer"));
  EXPECT_THAT(run.output, testing::EndsWith("equal\n"));
  for (const char* form : {"--bids", "--xdf"}) {
    const CommandResult no =
        run_command(fmt::format("haptrial export {} {} {}", form, path("x"), path("study")));
    EXPECT_EQ(no.status, 2);
    EXPECT_THAT(no.errors, HasSubstr("was imported, so that no time of a trial is known"));
  }
}

TEST_F(TrialsImportTest, AMistakeIsASentenceAndLeavesNothing) {
  test::write_text(folder_ / "t.csv", "subject,level,correct\nP1,1,1\nP1,two,0\n");
  const auto refused = [&](const std::string& more) {
    const CommandResult run =
        run_command("haptrial import " + path("t.csv") + " --out " + path("study") + " " + more);
    EXPECT_EQ(run.status, 2) << more;
    EXPECT_FALSE(fs::exists(folder_ / "study")) << more;
    return run.errors;
  };
  EXPECT_THAT(refused("--guess 0.5"), HasSubstr("t.csv:3: level is 'two'; allowed: a finite"));
  EXPECT_THAT(refused("--only level=1"), HasSubstr("add --guess RATE, as 0.5"));
  EXPECT_THAT(refused("--column right=correct"), HasSubstr("--column is 'right=correct'"));
  EXPECT_THAT(refused("--kind psychometrics --only level=1 --guess 0.5"), HasSubstr("kind"));
  EXPECT_THAT(refused(fmt::format("--definition '{}/experiments/force_training.toml'",
                                  HAPTRIAL_SOURCE_DIR)),
              HasSubstr("allowed: protocol = \"trials\""));
  EXPECT_THAT(refused(fmt::format("--only level=1 --definition "
                                  "'{}/experiments/stiffness_discrimination.toml'",
                                  HAPTRIAL_SOURCE_DIR)),
              HasSubstr("add --column track=COLUMN"));
}

}  // namespace
}  // namespace haptrial
