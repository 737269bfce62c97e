// Answers: every field comes back, a kill right after one loses nothing, recovery finds them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>

#include "core/base/error.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/recover.h"
#include "core/record/recovery/session_resume.h"
#include "core/record/rows/answer_rows.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

ResponseRow answer(int number) {
  ResponseRow row;
  row.trial = number;
  row.pass = number - 1;
  row.interval = 1 + number % 2;
  row.question = "which_is_stiffer";
  row.value = 0.25 * number;
  row.text = "zweite Größe";
  row.correct = number % 3 - 1;
  row.source = number % 2 == 0 ? ResponseSource::kKey : ResponseSource::kButton;
  row.code = 40 + number;
  row.reaction_time = 0.5 + 0.001 * number;
  row.sequence = 1000u * static_cast<std::uint64_t>(number);
  row.time_ns = 1000000000ll * number;
  return row;
}

void expect_same(const ResponseRow& given, const ResponseRow& found) {
  EXPECT_EQ(found.trial, given.trial);
  EXPECT_EQ(found.pass, given.pass);
  EXPECT_EQ(found.interval, given.interval);
  EXPECT_EQ(found.question, given.question);
  EXPECT_EQ(found.value, given.value);
  EXPECT_EQ(found.text, given.text);
  EXPECT_EQ(found.correct, given.correct);
  EXPECT_EQ(found.source, given.source);
  EXPECT_EQ(found.code, given.code);
  EXPECT_EQ(found.reaction_time, given.reaction_time);
  EXPECT_EQ(found.sequence, given.sequence);
  EXPECT_EQ(found.time_ns, given.time_ns);
}

SessionInfo info_with(const std::string& clock) {
  SessionInfo info = test::example_info();
  info.clock = clock;
  return info;
}

TEST(ResponseTest, EveryFieldComesBackAndDefaultsAreUnknown) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", info_with("simulated"), {&responses_table()});
    for (int i = 1; i <= 100; ++i) {
      writer.add_response(answer(i));
    }
    writer.add_response(ResponseRow{});
    writer.close();
  }
  const std::vector<ResponseRow> found = SessionReader(folder / "a.h5").responses();
  ASSERT_EQ(found.size(), 101u);
  for (int i = 1; i <= 100; ++i) {
    expect_same(answer(i), found[static_cast<std::size_t>(i) - 1]);
  }
  EXPECT_TRUE(std::isnan(found.back().value));
  EXPECT_TRUE(std::isnan(found.back().reaction_time));
  EXPECT_EQ(found.back().correct, -1);
  EXPECT_EQ(found.back().pass, -1);
  EXPECT_EQ(found.back().source, ResponseSource::kNone);
}

TEST(ResponseTest, ASessionThatAsksNothingHasNoTable) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", info_with("simulated"));
  EXPECT_THROW(writer.add_response(answer(1)), std::invalid_argument);
  writer.close();
  const SessionReader reader(folder / "a.h5");
  EXPECT_FALSE(reader.has(responses_table()));
  EXPECT_TRUE(reader.responses().empty());
}

TEST(ResponseTest, AnAnswerSurvivesAKillRightAfterIt) {
  for (const std::string clock : {"real", "simulated"}) {  // there with the next flush
    for (const int answers : {1, 3, 64, 65}) {
      const TemporaryFolder folder;
      const fs::path file = folder / "a.h5";
      const pid_t child = fork();
      if (child == 0) {
        SessionWriter writer(file, info_with(clock), {&responses_table()});
        for (int i = 1; i <= answers; ++i) {
          writer.add_response(answer(i));
        }
        if (clock == "simulated") {
          writer.flush();
        }
        kill(getpid(), SIGKILL);
      }
      int status = 0;
      waitpid(child, &status, 0);
      ASSERT_TRUE(WIFSIGNALED(status));
      const auto found = SessionReader(folder / "a.h5.partial").responses();
      ASSERT_EQ(found.size(), static_cast<std::size_t>(answers)) << clock;
      expect_same(answer(answers), found.back());

      Resumed resumed;
      SessionWriter writer = SessionWriter::resume(file, resumed);
      EXPECT_EQ(resumed.repaired, "");
      writer.add_response(answer(answers + 1));
      writer.close();
      const auto after = SessionReader(file).responses();
      ASSERT_EQ(after.size(), static_cast<std::size_t>(answers) + 1);
      expect_same(answer(answers + 1), after.back());
    }
  }
}

TEST(ResponseTest, RecoveryFindsAnswersWithoutTheStructure) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", info_with("simulated"), {&responses_table()});
    for (int i = 1; i <= 70; ++i) {
      writer.add_response(answer(i));
    }
    writer.append(test::hand_motion(5000, 1));
    writer.close();
  }
  {
    std::fstream file(folder / "a.h5", std::ios::in | std::ios::out | std::ios::binary);
    file.write(std::string(1024, '\0').data(), 1024);  // the superblock and what follows it
  }
  EXPECT_THROW(SessionReader(folder / "a.h5"), InputError);
  recover_session(folder / "a.h5", folder / "b.h5");
  const auto found = SessionReader(folder / "b.h5").responses();
  ASSERT_EQ(found.size(), 70u);
  for (int i = 1; i <= 70; ++i) {
    expect_same(answer(i), found[static_cast<std::size_t>(i) - 1]);
  }
}

}  // namespace
}  // namespace haptrial::record
