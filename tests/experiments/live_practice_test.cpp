// Practice before the first procedure, with and without an experimenter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/felt_or_not.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial::experiments::live_practice_test {
namespace {

namespace fs = std::filesystem;
using record::PassRow;
using record::PassStatus;
using testing::HasSubstr;

class LivePracticeTest : public testing::Test {
 protected:
  void write(double practice, double procedure) {
    const fs::path file = test::write_small_drilling(folder_.path(), procedure);
    test::write_text(file, test::read_text(file) + fmt_of(practice));
  }
  static std::string fmt_of(double seconds) {
    return "\n[practice]\nduration = " + std::to_string(seconds) + "\n";
  }
  std::string run(const std::string& more = "") const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / "out").string() + "' " + more;
  }
  fs::path file() const { return folder_ / "out" / "S01.h5"; }
  fs::path partial() const { return folder_ / "out" / "S01.h5.partial"; }
  std::vector<PassRow> passes() const {
    const record::SessionReader reader(file());
    EXPECT_TRUE(record::check_session(reader).ok);
    return reader.passes();
  }
  static std::uint64_t ticks(const PassRow& pass) {
    return pass.last_sample - pass.first_sample + 1;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LivePracticeTest, ComesOnceIsMarkedAndIsNotAnalysedAlsoAfterAKill) {
  write(1.5, 3600.0);
  {
    test::LiveCommand session(run());
    ASSERT_TRUE(session.reaches([&] {
      std::error_code ignored;
      return fs::exists(partial(), ignored) &&
             record::SessionReader(partial()).passes().size() == 1 &&
             record::SessionReader(partial()).sample_count() > 3000;
    })) << session.errors();
    session.signal(SIGKILL);
    session.wait();
  }
  // Whoever reads the file while it is opened for writing keeps the session from going on: its size
  // tells that a pass is recorded.
  constexpr std::uintmax_t kSomeTicks = 20'000;  // [bytes]
  const std::uintmax_t before = fs::file_size(partial());
  test::LiveCommand session(run("--resume"));
  ASSERT_TRUE(session.reaches([&] {
    return session.errors().find("resumed after") != std::string::npos &&
           fs::file_size(partial()) > before + kSomeTicks;
  })) << session.errors();
  session.signal(SIGINT);
  session.wait();
  const record::SessionReader reader(partial());
  const std::vector<PassRow> all = reader.passes();
  ASSERT_GE(all.size(), 2u);
  EXPECT_TRUE(all[0].practice);
  EXPECT_EQ(all[0].condition, "practice");
  EXPECT_EQ(all[0].status, PassStatus::kCompleted);
  EXPECT_EQ(ticks(all[0]), 1500u);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_FALSE(all[i].practice) << "it is not practised again";
    EXPECT_EQ(all[i].trial, 1);
  }
}

TEST_F(LivePracticeTest, ProceduresThatAreAnalysedDoNotHaveItAmongThem) {
  write(1.0, 2.0);
  test::LiveCommand session(run());
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const std::vector<PassRow> all = passes();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_TRUE(all[0].practice);
  EXPECT_EQ(ticks(all[0]), 1000u);
  EXPECT_FALSE(all[1].practice);
  EXPECT_EQ(ticks(all[1]), 2000u);
  const auto analysed = analysis::drilling::load_procedures(record::SessionReader(file()), {});
  ASSERT_EQ(analysed.size(), 1u);
  EXPECT_EQ(analysed[0].number, 1);
  EXPECT_EQ(analysed[0].ticks.size(), 2000u);
  const test::CommandResult info = test::run_command("haptrial info '" + file().string() + "'");
  EXPECT_THAT(info.output, HasSubstr("1 for practice"));
  const test::CommandResult replay = test::run_command("haptrial replay '" + file().string() + "'");
  EXPECT_EQ(replay.status, 0) << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("trial 1: the same bone, 2000 ticks"));
}

TEST_F(LivePracticeTest, AnExperimenterStartsRepeatsAndSkipsIt) {
  write(3600.0, 2.0);
  test::LiveCommand session(run("--console"));
  test::ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  ASSERT_TRUE(person.ask("start"));
  test::wait_until([&] {
    const auto now = person.status();
    return !now.is_null() && now["screen"].get<std::string>().starts_with("Practice");
  });  // its own page
  ASSERT_TRUE(person.sees("instructions"));
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(person.sees("practice"));
  ASSERT_TRUE(person.ask("repeat"));
  test::wait_until([&] { return person.status()["aborted_passes"] == 1; });
  ASSERT_TRUE(person.sees("practice"));
  ASSERT_TRUE(person.ask("skip"));
  test::wait_until([&] {
    const auto now = person.status();
    return !now.is_null() && now["screen"].get<std::string>().starts_with("Now it counts");
  });
  ASSERT_TRUE(person.ask("start"));
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const std::vector<PassRow> all = passes();
  ASSERT_EQ(all.size(), 3u);
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_TRUE(all[i].practice);
    EXPECT_EQ(all[i].status, PassStatus::kAborted);
    EXPECT_EQ(all[i].attempt, static_cast<std::int32_t>(i) + 1);
    EXPECT_EQ(all[i].repetition, static_cast<std::int32_t>(i) + 1) << "a new bone each";
  }
  EXPECT_FALSE(all[2].practice);
  EXPECT_EQ(all[2].status, PassStatus::kCompleted);
}

}  // namespace

// Questions without choices in trials of a real window: words that are typed and a mark that is
// moved, while letters have no other function.

namespace {

std::string definition() {
  std::string text = test::felt_or_not(
      "name = \"like\"\nwords = true\n"
      "[[responses]]\nname = \"answer\"\nquestion = \"How strong was it?\"\n"
      "scale = [0, 100]\nstep = 5\n");
  const auto put = [&text](const std::string& what, const std::string& instead) {
    text.replace(text.find(what), what.size(), instead);
  };
  put("[response]", "[[responses]]");
  put("counts = \"$answer == 1\"", "counts = \"$answer > 50\"");
  put("decides = \"yes\"", "decides = \"magnitude\"\nreaction = 60.0");  // it waits: keys answer
  put("criterion = 0.4\n", "");
  return text +
         "[display]\nwidth = 600\nheight = 440\n"
         "[screen]\nfull_screen = false\nparticipant_steers = true\n";
}

// The person types the same keys round and round, whatever is asked. The letter p would pause a
// session whose window steers, if it were not typed.
TEST(LiveQuestionsTest, WordsAndAMarkAreAnsweredByKeysOfTheWindow) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml", definition());
  test::VirtualDisplay display(640, 480);
  test::LiveCommand session("run '" + (folder / "study.toml").string() +
                            "' --subject S01 --trials 2 --out '" + (folder / "out").string() +
                            "' --window");
  std::atomic<bool> over{false};
  std::thread person([&] {
    constexpr unsigned long kRight = 0xff53;
    constexpr std::array<unsigned long, 5> keys{' ', 'o', 'p', kRight,
                                                test::VirtualDisplay::kEnter};
    while (!over) {
      for (const unsigned long key : keys) {
        try {
          display.press_key("haptrial", key);
        } catch (const std::runtime_error&) {  // not open yet, or closed
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
      }
    }
  });
  const test::CommandResult ended = session.wait();
  over = true;
  person.join();
  EXPECT_EQ(ended.status, 0) << ended.output << ended.errors;
  const record::SessionReader file(folder / "out/S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  const auto responses = file.responses();
  ASSERT_EQ(responses.size(), 4u);
  std::string typed;
  for (const record::ResponseRow& row : responses) {
    EXPECT_EQ(row.source, record::ResponseSource::kKey);
    EXPECT_GT(row.reaction_time, 0.0);
    if (row.question == "like") {
      EXPECT_EQ(row.text.find_first_not_of(" op"), std::string::npos) << row.text;
      typed += row.text;
    } else {
      EXPECT_EQ(row.value, 55.0);
    }
  }
  EXPECT_THAT(typed, testing::HasSubstr("p"));
}

}  // namespace
}  // namespace haptrial::experiments::live_practice_test
