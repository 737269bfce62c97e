// Practice trials, from the definition to the scores: done, marked, and not counted.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::practice_test {
namespace {

using record::PassRow;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

using Table = std::vector<std::vector<std::string>>;

Table table_in(const std::filesystem::path& file) {
  std::istringstream text(test::read_text(file));
  Table rows;
  for (std::string line; std::getline(text, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      rows.back().push_back(field);
    }
  }
  return rows;
}

std::size_t column(const Table& table, const std::string& name) {
  const auto& head = table.at(0);
  const auto at = std::find(head.begin(), head.end(), name);
  EXPECT_NE(at, head.end()) << name;
  return static_cast<std::size_t>(at - head.begin());
}

class PracticeTest : public testing::Test {
 protected:
  /// A study of two people and six trials each.
  void study(const std::string& name, const std::string& practice) const {
    const std::string text = (folder_ / (name + ".toml")).string();
    test::write_text(text, test::shipped_with("practice", practice));
    const CommandResult result =
        run_command("haptrial dry-run '" + text + "' --subjects 2 --trials 6 --out '" +
                    (folder_ / name).string() + "'");
    ASSERT_EQ(result.status, 0) << result.errors;
    const CommandResult analysis =
        run_command("haptrial analyze '" + (folder_ / name).string() + "'");
    ASSERT_EQ(analysis.status, 0) << analysis.errors;
  }
  std::vector<PassRow> passes(const std::string& name) const {
    return record::SessionReader(folder_ / name / "S01.h5").passes();
  }
  test::TemporaryFolder folder_;
};

TEST_F(PracticeTest, ComesFirstIsMarkedAndIsNotScored) {
  ASSERT_NO_FATAL_FAILURE(study("without", "practice = 0"));
  ASSERT_NO_FATAL_FAILURE(study("with", "practice = 1"));

  // One trial of each of the three conditions, a training pass and a test pass each.
  const std::vector<PassRow> all = passes("with");
  const std::vector<PassRow> study_alone = passes("without");
  ASSERT_EQ(study_alone.size(), 12u);
  ASSERT_EQ(all.size(), 6u + 12u);
  std::vector<std::string> practised;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].practice, i < 6) << i;
    if (i < 6) {
      EXPECT_EQ(all[i].block, -static_cast<int>(i / 2) - 1) << "no block of the study";
      practised.push_back(all[i].condition);
      for (const PassRow& pass : study_alone) {
        EXPECT_NE(all[i].stimulus_seed, pass.stimulus_seed) << "a stimulus of the study is new";
      }
    }
  }
  EXPECT_THAT(practised, testing::ElementsAre("haptic", "haptic", "visual", "visual", "visuohaptic",
                                              "visuohaptic"));
  // Each practice trial has a stimulus of its own, and it is in the file.
  std::set<std::int32_t> blocks;
  for (const record::StimulusRow& row : record::SessionReader(folder_ / "with/S01.h5").stimuli()) {
    blocks.insert(row.block);
  }
  EXPECT_THAT(blocks, testing::ElementsAre(-3, -2, -1, 1, 2));
  // The study itself is the one that it would be without practice: same order, same stimuli.
  for (std::size_t i = 0; i < study_alone.size(); ++i) {
    const PassRow& pass = all[6 + i];
    EXPECT_EQ(pass.trial, study_alone[i].trial);
    EXPECT_EQ(pass.block, study_alone[i].block);
    EXPECT_EQ(pass.condition, study_alone[i].condition);
    EXPECT_EQ(pass.phase, study_alone[i].phase);
    EXPECT_EQ(pass.stimulus_seed, study_alone[i].stimulus_seed);
  }

  // The scored trials are the same. The scores differ: the virtual subjects' own noise has gone on
  // through the practice, as people's has.
  const Table scores = table_in(folder_ / "with/scores.csv");
  const Table plain = table_in(folder_ / "without/scores.csv");
  ASSERT_EQ(scores.size(), 1u + 2 * 6);
  ASSERT_EQ(plain.size(), scores.size());
  for (const char* name : {"subject", "trial", "block", "condition"}) {
    const std::size_t at = column(scores, name);
    ASSERT_EQ(column(plain, name), at);
    for (std::size_t i = 1; i < scores.size(); ++i) {
      EXPECT_EQ(scores[i].at(at), plain[i].at(at)) << name << " in row " << i;
    }
  }
  EXPECT_THAT(run_command("haptrial info '" + (folder_ / "with/S01.h5").string() + "'").output,
              HasSubstr("passes      18, 0 aborted, 6 for practice"));
}

}  // namespace
}  // namespace haptrial::practice_test
