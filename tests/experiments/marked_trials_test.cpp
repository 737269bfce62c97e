// Trials that the experimenter marks as bad: what the analysis of each protocol does with them, and
// what the report says. Marks are put into rehearsed sessions by another program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/bone_drilling/metrics/study_bones.h"
#include "analysis/files/csv.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::marked_trials_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// Adds marks at the end of a session. @param marks  Python's list of texts
void mark(const fs::path& session, const std::string& marks) {
  const auto done = test::run_command(
      "/usr/bin/python3 -c 'import h5py, sys\nwith h5py.File(sys.argv[1], \"r+\") as f:\n"
      "    events = f[\"events\"]\n    last = f[\"samples\"][-1][\"time_ns\"]\n"
      "    for text in " +
      marks +
      ":\n        events.resize(len(events) + 1, axis=0)\n"
      "        events[-1] = (last, b\"bad_trial\", text.encode(), 0)\n' '" +
      session.string() + "'");
  ASSERT_EQ(done.status, 0) << done.errors;
}

class MarkedTrialsReportTest : public testing::Test {
 protected:
  /// Rehearses and analyses. @returns what analyze prints
  std::string analysed(const std::string& text, const std::string& marks,
                       const std::string& options) {
    test::write_text(folder_ / "study.toml", text);
    fs::remove_all(out_);
    const auto dry = test::run_command("haptrial dry-run '" + (folder_ / "study.toml").string() +
                                       "' " + options + " --out '" + out_.string() + "'");
    EXPECT_EQ(dry.status, 0) << dry.errors;
    if (!marks.empty()) {
      mark(out_ / "S01.h5", marks);
    }
    const auto done = test::run_command("haptrial analyze '" + out_.string() + "'");
    EXPECT_EQ(done.status, 0) << done.errors;
    return done.output;
  }
  nlohmann::json statistics() const {
    return nlohmann::json::parse(test::read_text(out_ / "statistics.json"));
  }

  test::TemporaryFolder folder_;
  fs::path out_{folder_ / "out"};
};

const std::string kMarks = "[\"trial 2: hand slipped\", \"trial 3: phone\"]";

TEST_F(MarkedTrialsReportTest, ForceTrainingFollowsTheRule) {
  const std::string text = test::shipped_text();
  const std::string at = "[analysis]";
  const auto with = [&](const std::string& rule) {
    std::string changed = text;
    return changed.insert(changed.find(at) + at.size(), rule);
  };
  ASSERT_NE(text.find("\n" + at), std::string::npos);
  const std::string kept = analysed(text, kMarks, "--subjects 1 --trials 6");
  EXPECT_THAT(kept, HasSubstr("analysed all the same: 2 trials: S01, 2 marks (trial 2: hand "
                              "slipped; trial 3: phone)"));
  EXPECT_TRUE(statistics()["exclusions"].empty());
  const std::string rows = test::read_text(out_ / "scores.csv");

  const std::string left =
      analysed(with("\nexclude_marked = true"), kMarks, "--subjects 1 --trials 6");
  EXPECT_THAT(left,
              HasSubstr("left out of the analysis as the definition's analysis.exclude_marked "
                        "says: 2 trials: S01, 2 marks"));
  EXPECT_EQ(statistics()["exclusions"].size(), 2u);
  EXPECT_EQ(statistics()["exclusions"][0]["trial"], 2);
  EXPECT_THAT(statistics()["exclusions"][0]["reason"].get<std::string>(),
              HasSubstr("marked as bad: hand slipped"));
  // The other trials have the scores that they had.
  const std::string fewer = test::read_text(out_ / "scores.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n') - 2,
            std::count(fewer.begin(), fewer.end(), '\n'));

  const std::string words = analysed(with("\nexclude_marked = true\nexclude_words = [\"phone\"]"),
                                     kMarks, "--subjects 1 --trials 6");
  EXPECT_THAT(words, HasSubstr("says: 1 trial: S01, 1 mark (trial 3: phone)"));
  EXPECT_THAT(words, HasSubstr("analysed all the same: 1 trial: S01, 1 mark (trial 2"));
  EXPECT_EQ(statistics()["exclusions"].size(), 1u);
}

const char* const kTrials = R"([experiment]
protocol = "trials"
name = "marked"
[design]
participants = 2
[fields.pull]
type = "constant"
force = [0.0, "-$level", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.4 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "constant"
variable = "level"
unit = "N"
levels = { from = 0.2, to = 2.0, count = 6, spacing = "log" }
repetitions = 4
counts = "$answer == 1"
[observer]
decides = "yes"
criterion = 1.0
force_weber = 0.1
force_floor = 0.0
reaction = 0.05
[observer.actions]
feel = { do = "hold" }
)";

/// Trials that the table of trials counts, by their number.
std::vector<std::string> counted_in(const fs::path& table) {
  std::vector<std::string> trials;
  const std::string text = test::read_text(table);
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const auto column = [&](const std::string& name, const std::string& row) {
    std::istringstream heading(line), cells(row);
    std::string head, cell;
    while (std::getline(heading, head, ',') && std::getline(cells, cell, ',')) {
      if (head == name) {
        return cell;
      }
    }
    return std::string("no column " + name);
  };
  for (std::string row; std::getline(lines, row);) {
    if (column("counted", row) == "1") {
      trials.push_back(column("trial", row));
    }
  }
  return trials;
}

TEST_F(MarkedTrialsReportTest, TrialsFollowTheRule) {
  const std::string kept = analysed(kTrials, kMarks, "--subjects 1");
  EXPECT_THAT(kept, HasSubstr("analysed all the same: 2 trials: S01"));
  EXPECT_EQ(counted_in(out_ / "trials.csv").size(), 24u);
  const std::string left = analysed(std::string(kTrials) + "[analysis]\nexclude_marked = true\n",
                                    kMarks, "--subjects 1");
  EXPECT_THAT(left, HasSubstr("left out of the analysis"));
  const auto counted = counted_in(out_ / "trials.csv");
  EXPECT_EQ(counted.size(), 22u);
  EXPECT_THAT(counted, Not(testing::Contains("2")));
  EXPECT_THAT(counted, Not(testing::Contains("3")));
}

TEST_F(MarkedTrialsReportTest, DrillingsFollowTheRule) {
  const fs::path study = test::write_small_drilling(folder_.path(), 3.0);
  const std::string text = test::read_text(study);
  const std::string marks = "[\"trial 1: table bumped\"]";
  const auto rows = [&](const std::string& definition) {
    const std::string printed = analysed(definition, marks, "--subjects 2");
    const std::string table = test::read_text(out_ / "metrics.csv");
    return std::pair(printed, std::count(table.begin(), table.end(), '\n'));
  };
  const auto kept = rows(text);
  const auto left = rows(text + "\n[analysis]\nexclude_marked = true\n");
  EXPECT_THAT(kept.first, HasSubstr("analysed all the same: 1 trial"));
  EXPECT_THAT(left.first, HasSubstr("left out of the analysis"));
  EXPECT_EQ(left.second, kept.second - 1);
  analysis::drilling::StudyBones bones;
  ExpertSessions experts({}, bones);
  experts.add(out_ / "S01.h5");
  experts.add(out_ / "S02.h5");
  EXPECT_EQ(experts.procedures().size(), 2u);
  EXPECT_EQ(experts.for_feedback().size(), 1u) << "nobody learns from the one that is marked";
}

TEST_F(MarkedTrialsReportTest, WordsAloneAreRefused) {
  test::write_text(folder_ / "study.toml",
                   std::string(kTrials) + "[analysis]\nexclude_words = [\"phone\"]\n");
  const auto refused =
      test::run_command("haptrial validate '" + (folder_ / "study.toml").string() + "'");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("exclude_words is given without exclude_marked = true"));
}

}  // namespace
}  // namespace haptrial::experiments::marked_trials_test
