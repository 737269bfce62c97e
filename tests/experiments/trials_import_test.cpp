// haptrial import: a study of trials that another program presented.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>
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
  void write_table(const std::string& tables, const std::vector<std::string>& factors) {
    std::map<std::string, Row> trials;
    const auto trial = [&](const Row& row) -> Row& {
      return trials[row.at("subject") + " " + row.at("pass")];
    };
    for (const Row& row : rows_of(folder_ / (tables + "/levels.csv"))) {
      trial(row).insert({{"level", row.at("applied")},
                         {"track", row.at("track")},
                         {"outcome", row.at("outcome")}});
    }
    for (const Row& row : rows_of(folder_ / (tables + "/variables.csv"))) {
      if (row.at("interval") == "0") {
        const auto word = row.find("word");
        trial(row)[row.at("name")] =
            word != row.end() && !word->second.empty() ? word->second : row.at("value");
      }
    }
    for (const Row& row : rows_of(folder_ / (tables + "/responses.csv"))) {
      Row& own = trial(row);
      const bool first = !own.contains("answer");
      const std::string answer = row.at("text").empty() ? row.at("value") : row.at("text");
      own[first ? "answer" : "rating"] = answer;
      own.insert({{"correct", row.at("correct")}, {"rt", row.at("reaction_time")}});
    }
    std::vector<std::string> columns{"level",  "track", "probe",  "outcome",
                                     "answer", "rt",    "rating", "correct"};
    columns.insert(columns.end(), factors.begin(), factors.end());
    std::ofstream out(folder_ / "theirs.csv");
    out << fmt::format("subject,simulated,{}\n", fmt::join(columns, ","));
    for (const Row& row : rows_of(folder_ / (tables + "/trials.csv"))) {
      if (row.at("practice") == "1" || row.at("status") != "completed") {
        continue;
      }
      Row& own = trial(row);
      own["correct"] = own["correct"] == "-1" ? "" : own["correct"];
      out << row.at("subject") << ",true";
      for (const std::string& column : columns) {
        out << ',' << own[column];
      }
      out << '\n';
    }
  }

  test::TemporaryFolder folder_;
};

/// The normal quantile by bisection of the error function.
double quantile(double share) {
  double low = -10.0, high = 10.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Trials of a detection under a factor, and what was answered, counted while they are made.
struct Counted {
  std::map<std::string, int> yes, trials;  // by "P1,slow,1": participant, factor, stimulus
  std::string table{"subject,stimulus,answer,speed\n"};

  Counted() {
    unsigned draw = 7;
    for (const char* who : {"P1", "P2", "P3", "P4"}) {
      for (int trial = 0; trial < 160; ++trial) {
        const int there = trial % 2;
        const std::string speed = trial % 4 < 2 ? "slow" : "fast";
        draw = draw * 1664525u + 1013904223u;
        const double chance = there == 0 ? 0.2 : speed == "slow" ? 0.5 : 0.9;
        const bool answer = static_cast<double>(draw >> 8) / (1 << 24) < chance;
        const std::string cell = fmt::format("{},{},{}", who, speed, there);
        ++trials[cell];
        yes[cell] += answer ? 1 : 0;
        table += fmt::format("{},{},{},{}\n", who, there, answer ? "yes" : "no", speed);
      }
    }
  }
  /// Share of yes with half a trial added on each side, as a normal deviate.
  double deviate(const std::string& cell) const {
    return quantile((yes.at(cell) + 0.5) / (trials.at(cell) + 1.0));
  }
  double d_prime(const std::string& person_and_speed) const {
    return deviate(person_and_speed + ",1") - deviate(person_and_speed + ",0");
  }
};

/// Hits and false alarms of each participant under each level of an imported factor.
TEST_F(TrialsImportTest, DetectionsAreComparedByTheirFactor) {
  const Counted counted;
  test::write_text(folder_ / "theirs.csv", counted.table);
  const CommandResult run = run_command(
      fmt::format("haptrial import {} --kind detection --yes yes --column level=stimulus --factor "
                  "speed --out {} && haptrial analyze {}",
                  path("theirs.csv"), path("study"), path("study")));
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Sensitivity d'. Effect of speed: significant"));
  std::map<std::string, double> found;
  for (const Row& row : rows_of(folder_ / "study/estimates.csv")) {
    if (row.at("name") == "d_prime") {
      found[row.at("participant") + "," + row.at("speed")] = std::stod(row.at("estimate"));
    }
  }
  ASSERT_EQ(found.size(), 8u);
  for (const auto& [cell, d_prime] : found) {
    EXPECT_NEAR(d_prime, counted.d_prime(cell), 1e-9) << cell;
  }
}

/// The share of right answers under each level of a factor beside the stimulus.
TEST_F(TrialsImportTest, IdentificationsAreComparedByTheirFactor) {
  std::string table = "subject,stimulus,answer,correct,hand\n";
  for (int i = 0; i < 160; ++i) {
    const char* shown = i % 2 == 0 ? "soft" : "stiff";
    const bool glove = i % 4 < 2;
    const bool right = glove ? i % 8 < 4 : i % 20 != 3;
    const char* said = right == (i % 2 == 0) ? "soft" : "stiff";
    table += fmt::format("P{},{},{},{},{}\n", i / 40, shown, said, right ? 1 : 0,
                         glove ? "glove" : "bare");
  }
  test::write_text(folder_ / "theirs.csv", table);
  const CommandResult run = run_command(
      fmt::format("haptrial import {} --kind identification --factor hand --factor stimulus --out "
                  "{} && haptrial analyze {}",
                  path("theirs.csv"), path("study"), path("study")));
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Share of right answers, bare: 0.9000"));
  EXPECT_THAT(run.output, HasSubstr("Share of right answers, glove: 0.5000"));
}

/// The name of an answer changes neither the guess rate nor the threshold.
TEST_F(TrialsImportTest, CatchTrialsCountWhateverTheirAnswersAreCalled) {
  constexpr const char* kDefinition = R"([experiment]
protocol = "trials"
name = "catches"
[design]
participants = 3
[[stages]]
name = "feel"
until = {{ time = 0.2 }}
[response]
question = "Felt it?"
choices = [{{ value = "{0}" }}, {{ value = "{1}" }}]
correct = "$probe == 'no' ? 1 : 2"
[procedure]
kind = "constant"
variable = "level"
levels = [1.0, 2.0, 3.0, 4.0, 5.0]
repetitions = 40
counts = "$answer == 1"
[[blocks]]
name = "b"
probe = {{ name = "catch", share = 0.2, level = 0.0 }}
[analysis]
resamples = 0
)";
  std::map<std::string, std::string> thresholds;
  for (const auto& [felt, nothing] : {std::pair("felt", "nothing"), {"yes", "no"}}) {
    std::string table = "participant,level,answer,correct,outcome,probe\n";
    const auto add = [&](const char* level, int of_forty, bool caught) {
      for (int i = 0; i < 40; ++i) {
        const bool said = i < of_forty;
        table +=
            fmt::format("P1,{},{},{},{},{}\n", level, said ? felt : nothing, said != caught ? 1 : 0,
                        caught ? "" : fmt::format("{:d}", said), caught ? "catch" : "");
      }
    };
    add("1", 12, false);
    add("2", 16, false);
    add("3", 25, false);
    add("4", 35, false);
    add("5", 39, false);
    add("", 10, true);
    test::write_text(folder_ / "theirs.csv", table);
    test::write_text(folder_ / "theirs.toml", fmt::format(kDefinition, felt, nothing));
    const CommandResult run = run_command(fmt::format(
        "haptrial import {} --definition {} --column outcome=outcome --column probe=probe --out {} "
        "&& haptrial analyze {}",
        path("theirs.csv"), path("theirs.toml"), path(felt), path(felt)));
    ASSERT_EQ(run.status, 0) << run.errors;
    for (const Row& row : rows_of(folder_ / (std::string(felt) + "/estimates.csv"))) {
      if (row.at("name") == "guess_rate") {
        EXPECT_NEAR(std::stod(row.at("estimate")), 0.25, 0.03) << felt;
      } else if (row.at("name") == "threshold") {
        thresholds[felt] = row.at("estimate");
      }
    }
  }
  EXPECT_EQ(thresholds.size(), 2u);
  EXPECT_EQ(thresholds["felt"], thresholds["yes"]);
}

/// Thresholds that fall to half in everybody, on a logarithmic axis.
TEST_F(TrialsImportTest, AChangeFromABaselineIsNoLevel) {
  std::string table = "participant,session,level,answer,outcome\n";
  const std::vector<std::pair<double, int>> answers{
      {0.5, 2}, {1.0, 8}, {2.0, 20}, {4.0, 33}, {8.0, 39}};
  for (const char* who : {"P1", "P2", "P3"}) {
    for (const auto& [level, felt] : answers) {
      for (int i = 0; i < 40; ++i) {
        const char* said = i < felt ? "yes,1" : "no,0";
        table += fmt::format("{0},1,{1},{2}\n{0},2,{3},{2}\n", who, level, said, 0.5 * level);
      }
    }
  }
  test::write_text(folder_ / "theirs.csv", table);
  test::write_text(folder_ / "theirs.toml", R"([experiment]
protocol = "trials"
name = "base"
[design]
participants = 3
sessions = 2
[design.session.1]
name = "pre"
blocks = ["b"]
[design.session.2]
name = "post"
blocks = ["b"]
[[stages]]
name = "feel"
until = { time = 0.3 }
[response]
question = "Felt?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "constant"
variable = "level"
unit = "N"
levels = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0]
repetitions = 40
counts = "$answer == 1"
[[blocks]]
name = "b"
[analysis]
by = ["session"]
baseline = "pre"
scale = "log10"
guess = 0.0
resamples = 0
)");
  const CommandResult run = run_command(fmt::format(
      "haptrial import {} --definition {} --column outcome=outcome --out {} && haptrial "
      "analyze {}",
      path("theirs.csv"), path("theirs.toml"), path("study"), path("study")));
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Change of threshold, post: -0.3010"));
  EXPECT_THAT(run.output, testing::ContainsRegex("Change of threshold, post: .* log10\\(N\\)"));
}

TEST_F(TrialsImportTest, ValuesOfBlocksThatMakeConditionsNeedAColumn) {
  test::write_text(folder_ / "theirs.toml", R"([experiment]
protocol = "trials"
name = "blocks"
[design]
participants = 1
[variables]
level = 0.0
[[blocks]]
name = "eyes"
trials = 100
modality = "eye"
[[blocks]]
name = "hands"
trials = 100
modality = "hand"
[[stages]]
name = "feel"
until = { time = 0.3 }
[response]
question = "Larger?"
choices = [{ value = "larger" }, { value = "smaller" }]
[analysis]
kind = "psychometric"
level = "level"
yes = "larger"
guess = 0.0
by = ["modality"]
resamples = 0
)");
  std::string table = "participant,level,answer,modality\n";
  for (int i = 0; i < 200; ++i) {
    const int level = i % 5 - 2;
    const bool eye = i < 100;
    const bool larger = i % 100 / 5 < 10 + 4 * level + (eye ? 3 : -3);
    table +=
        fmt::format("P1,{},{},{}\n", level, larger ? "larger" : "smaller", eye ? "eye" : "hand");
  }
  test::write_text(folder_ / "theirs.csv", table);
  const std::string import =
      fmt::format("haptrial import --definition {} --out {} ", path("theirs.toml"), path("study"));
  const CommandResult run =
      run_command(import + path("theirs.csv") + " && haptrial analyze " + path("study"));
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Threshold, eye: -"));
  EXPECT_THAT(run.output, HasSubstr("Threshold, hand: 0."));
  const std::string other = table.replace(table.find("modality"), 8, "sense");
  test::write_text(folder_ / "other.csv", other);
  fs::remove_all(folder_ / "study");
  const CommandResult refused = run_command(import + path("other.csv"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("add --factor modality=COLUMN"));
}

TEST_F(TrialsImportTest, AUnitOfTimeIsThatOfItsOwnColumn) {
  test::write_text(folder_ / "theirs.csv",
                   "participant,rt_s,latency\nP1,0.5,50\nP1,0.6,25\nP1,0.7,24\n");
  const std::string import = "haptrial import " + path("theirs.csv") +
                             " --column time=latency --kind times --out " + path("study");
  const CommandResult refused = run_command(import);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("latency may be seconds or milliseconds"));
  EXPECT_EQ(run_command(import + " --time-unit ms").status, 0);
}

/// A shipped experiment, factors that blocks or trials vary, and columns that it lacks.
struct Shipped {
  const char* name;
  std::vector<std::string> factors;
  std::vector<std::string> absent;
};

class ShippedTrials : public TrialsImportTest, public testing::WithParamInterface<Shipped> {};

TEST_P(ShippedTrials, GiveTheEstimatesOfTheNativeSessions) {
  const Shipped& shipped = GetParam();
  const std::string definition =
      fmt::format("'{}/experiments/{}.toml'", HAPTRIAL_SOURCE_DIR, shipped.name);
  const CommandResult native = run_command(
      fmt::format("haptrial dry-run {} --subjects 3 --out {} && haptrial analyze {} && haptrial "
                  "export --csv {} {}",
                  definition, path("native"), path("native"), path("tables"), path("native")));
  ASSERT_EQ(native.status, 0) << native.errors;
  write_table("tables", shipped.factors);
  std::string options = "--column probe=probe --column outcome=outcome --time-unit s";
  for (const std::string& factor : shipped.factors) {
    options += " --factor " + factor;
  }
  for (const std::string& role : shipped.absent) {
    options += " --column " + role + "=";
  }
  const CommandResult run = run_command(fmt::format(
      "haptrial import {} {} --definition {} --out {} && haptrial analyze {} && "
      "haptrial info {}/S01.h5",
      path("theirs.csv"), options, definition, path("study"), path("study"), path("study")));
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string ours = test::read_text(folder_ / "study/estimates.csv");
  EXPECT_EQ(ours, test::read_text(folder_ / "native/estimates.csv"));
  EXPECT_GT(std::count(ours.begin(), ours.end(), '\n'), 3);
  const std::string sum = run_command("sha256sum " + path("theirs.csv") + " | cut -c-64").output;
  EXPECT_THAT(run.output, HasSubstr("theirs.csv, SHA-256 " + sum.substr(0, 64)));
  EXPECT_THAT(run.output, HasSubstr("recording   imported: no ticks were recorded"));
  const std::string report = test::read_text(folder_ / "study/report.md");
  EXPECT_THAT(report, HasSubstr("SIMULATED"));
  EXPECT_THAT(report, HasSubstr("Another program ran 3 sessions and wrote the tables"));
  for (const char* unknown : {"force limit", "Forces were computed", "Recorded by haptrial",
                              "told whether they were right", "planned breaks", "were planned.",
                              "Combinations of factors"}) {
    EXPECT_THAT(report, Not(HasSubstr(unknown))) << unknown;
  }
}

INSTANTIATE_TEST_SUITE_P(
    TrialsImportTest, ShippedTrials,
    testing::Values(Shipped{"stiffness_discrimination", {}, {"rating"}},
                    Shipped{"viscosity_magnitude", {}, {"rating", "correct"}},
                    Shipped{"wall_detection", {}, {}},
                    Shipped{"force_discrimination", {}, {"rating"}},
                    Shipped{"shape_recognition", {"shape"}, {"level", "track", "outcome"}}),
    [](const auto& shipped) { return std::string(shipped.param.name); });

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

TEST_F(TrialsImportTest, AFactorOfOneLevelIsNamedByItsColumn) {
  test::write_text(folder_ / "t.csv",
                   "participant,cond,response,correct\nP1,0.1,a,1\nP1,0.10,b,0\nP2,0.1,a,1\n");
  const CommandResult run =
      run_command("haptrial import " + path("t.csv") + " --factor cond --out " + path("one"));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("t.csv: the column cond has one level, 0.1; allowed: two"));
  EXPECT_FALSE(fs::exists(folder_ / "one"));
}

TEST_F(TrialsImportTest, AnAnalysisThatNothingJudgesIsRefused) {
  test::write_text(folder_ / "t.csv",
                   "participant,first,second,answer\nP1,A,B,first\nP1,B,A,second\n");
  const std::string table = "haptrial import " + path("t.csv") + " --factor first --factor second";
  ASSERT_EQ(run_command(table + " --out " + path("plain")).status, 0);
  std::string text = test::read_text(folder_ / "plain/study.toml");
  const std::string kind = "kind = \"none\"\n";
  ASSERT_NE(text.find(kind), std::string::npos) << text;
  text.replace(text.find(kind), kind.size(),
               "kind = \"paired\"\nfirst = \"first\"\nsecond = \"second\"\n");
  test::write_text(folder_ / "pairs.toml", text);
  const CommandResult run = run_command("haptrial import " + path("t.csv") + " --definition " +
                                        path("pairs.toml") + " --out " + path("pairs"));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("no column says whether answers are right"));
  EXPECT_FALSE(fs::exists(folder_ / "pairs"));
  const std::string validate = "haptrial validate " + path("pairs.toml");
  EXPECT_THAT(run_command(validate).output, HasSubstr("nothing says which answers are right"));
  test::write_text(folder_ / "pairs.toml", text + "yes = \"first\"\n");
  EXPECT_THAT(run_command(validate).output, Not(HasSubstr("nothing says")));
}

/// Names whose alphabet is their order, and others, give the same looks.
TEST_F(TrialsImportTest, TheRuleThatEndsAStudyTakesTheOrderOfTheRows) {
  test::write_text(folder_ / "rule.toml", R"([experiment]
protocol = "trials"
name = "imported"
[design]
participants = 20
[factors]
cond = ["a", "b"]
[[blocks]]
name = "trials"
trials = 8
[[stages]]
name = "presented"
until = { time = 0.0 }
[[responses]]
name = "answer"
question = "answer"
number = [-1000000000.0, 1000000000.0]
[analysis]
kind = "times"
by = ["cond"]
tests = ["a < b"]
[analysis.sequential]
rule = "group sequential"
looks = [6, 20]
error = 0.05
)");
  for (const int digits : {1, 2}) {
    std::ofstream out(folder_ / "t.csv");
    out << "participant,cond,rt_s\n";
    for (int person = 1; person <= 10; ++person) {
      for (int trial = 0; trial < 8; ++trial) {
        const bool b = trial >= 4;
        out << fmt::format(
            "P{:0{}},{},{:.4f}\n", person, digits, b ? "b" : "a",
            0.5 + 0.01 * (person * 7 % 5) + 0.003 * (trial % 4) + (b ? 0.02 * person : 0.0));
      }
    }
    out.close();
    const std::string study = path(fmt::format("study{}", digits));
    const CommandResult made = run_command("haptrial import " + path("t.csv") + " --definition " +
                                           path("rule.toml") + " --out " + study);
    ASSERT_EQ(made.status, 0) << made.errors;
    const CommandResult found = run_command("haptrial analyze " + study);
    EXPECT_THAT(found.output, HasSubstr("a < b, after 6 of at most 20 participants: z 2.75, "));
    const fs::path report = folder_ / fmt::format("study{}/report.md", digits);
    EXPECT_THAT(test::read_text(report), HasSubstr("in the order of the tables' rows"));
  }
}

/// A high standard beside a low comparison takes 0.22 s longer; the alphabet would exchange the
/// two.
TEST_F(TrialsImportTest, CombinationsAreReadInTheOrderOfTheFactorsAsWritten) {
  test::write_text(folder_ / "two.toml", R"([experiment]
protocol = "trials"
name = "two"
[design]
participants = 5
[factors]
standard = ["low", "high"]
comparison = ["low", "high"]
[[blocks]]
name = "trials"
trials = 16
[[stages]]
name = "presented"
until = { time = 0.0 }
[[responses]]
name = "answer"
question = "answer"
choices = [{ value = "go" }, { value = "stop" }]
[analysis]
kind = "times"
tests = ["low, high < high, low"]
)");
  std::ofstream out(folder_ / "t.csv");
  out << "participant,standard,comparison,response,correct,rt_s\n";
  for (int person = 1; person <= 5; ++person) {
    for (int trial = 0; trial < 16; ++trial) {
      const bool standard = trial % 4 >= 2, comparison = trial % 2 == 1;
      if (standard && !comparison && (trial < 4 || trial >= 12)) {
        continue;  // so that counts tell the two conditions apart
      }
      const double longer = standard && !comparison ? 0.2 + 0.01 * (person * 7 % 5) : 0.0;
      out << fmt::format("P{},{},{},go,1,{:.4f}\n", person, standard ? "high" : "low",
                         comparison ? "high" : "low", 0.5 + 0.003 * (trial / 4) + longer);
    }
  }
  out.close();
  const CommandResult made = run_command("haptrial import " + path("t.csv") + " --definition " +
                                         path("two.toml") + " --out " + path("two"));
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(run_command("haptrial analyze " + path("two")).output,
              HasSubstr("Planned, low, high < high, low: significant; difference -0.2200, "));
  const std::string report = test::read_text(folder_ / "two/report.md");
  for (const char* count :
       {"low, low | 20", "low, high | 20", "high, low | 10", "high, high | 20"}) {
    EXPECT_THAT(report, HasSubstr(fmt::format("| {} |", count)));
  }
}

TEST_F(TrialsImportTest, LongLevelsShareTheRoomOfACondition) {
  test::write_text(folder_ / "t.csv", R"(participant,material,tool,rt_s
P1,hard acrylic,short needle,0.5
P1,soft silicone with a rough coating,short needle,0.6
P1,hard acrylic,long steel needle with a bevelled tip,0.5
P1,soft silicone with a rough coating,long steel needle with a bevelled tip,0.7
)");
  const CommandResult made =
      run_command("haptrial import " + path("t.csv") +
                  " --factor material --factor tool --kind times --out " + path("long"));
  ASSERT_EQ(made.status, 0) << made.errors;
  ASSERT_EQ(run_command("haptrial analyze " + path("long")).status, 0);
  EXPECT_THAT(test::read_text(folder_ / "long/report.md"),
              HasSubstr("soft silicone with a rough coat, long steel needle with a bevell"));
}

TEST_F(TrialsImportTest, SettingsNeedAProcedure) {
  test::write_text(folder_ / "t.csv", "participant,level,answer\nP1,1,10.72\nP1,2,11.79\n");
  ASSERT_EQ(run_command("haptrial import " + path("t.csv") + " --kind magnitude --out " +
                        path("magnitudes"))
                .status,
            0);
  std::string text = test::read_text(folder_ / "magnitudes/study.toml");
  const std::string kind = "\"magnitude\"";
  ASSERT_NE(text.find(kind), std::string::npos) << text;
  test::write_text(folder_ / "set.toml",
                   text.replace(text.find(kind), kind.size(), "\"adjustment\""));
  const CommandResult run = run_command("haptrial import " + path("t.csv") + " --definition " +
                                        path("set.toml") + " --out " + path("settings"));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("set.toml: has no procedure"));
  EXPECT_FALSE(fs::exists(folder_ / "settings"));
  EXPECT_THAT(run_command("haptrial validate " + path("set.toml")).output,
              HasSubstr("so that the report has no setting"));
}

TEST_F(TrialsImportTest, PlannedTestsNeedConditions) {
  test::write_text(folder_ / "t.csv",
                   "subject,speed,response,rt_ms\nP1,slow,a,400\nP1,slow,a,410\nP2,slow,b,390\n");
  const std::string table = "haptrial import " + path("t.csv") + " --kind times --out ";
  const std::string planned = " --planned 'slow < fast'";
  ASSERT_EQ(run_command(table + path("one")).status, 0);
  const CommandResult none = run_command("haptrial analyze " + path("one") + planned);
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors,
              HasSubstr("the planned test \"slow < fast\" compares conditions, but the "
                        "study has one; state the factors in analysis.by"));
  test::write_text(folder_ / "both.csv",
                   "subject,speed,response,rt_ms\nP1,slow,a,400\nP1,fast,b,410\n");
  ASSERT_EQ(run_command("haptrial import " + path("both.csv") +
                        " --kind times --factor speed --out " + path("both"))
                .status,
            0);
  const CommandResult half =
      run_command("haptrial import " + path("t.csv") + " --definition " + path("both/study.toml") +
                  " --out " + path("half") + " && haptrial analyze " + path("half") + planned);
  EXPECT_EQ(half.status, 0) << half.errors;
  EXPECT_THAT(half.output, HasSubstr("The planned tests were not made, because"));
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
  EXPECT_THAT(refused("--kind psychometrics --only level=1 --guess 0.5"),
              HasSubstr("--kind is 'psychometrics'; did you mean psychometric?"));
  for (const std::string kind : {"adjustment", "paired"}) {
    EXPECT_THAT(refused("--only level=1 --kind " + kind),
                HasSubstr("is stated by a definition, for --definition"));
  }
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
