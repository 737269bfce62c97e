// Questions without choices in trials of a real window: words that are typed and a mark that is
// moved, while letters have no other function.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/felt_or_not.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace haptrial::experiments::live_questions_test {
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
}  // namespace haptrial::experiments::live_questions_test
