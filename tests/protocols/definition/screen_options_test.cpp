#include "protocols/definition/screen_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::experiments {
namespace {

using testing::HasSubstr;

protocols::ScreenOptions screen(const std::string& lines) {
  Table root = Table::parse("[screen]\n" + lines, "x.toml");
  Table table = root.table("screen");
  const protocols::ScreenOptions options = protocols::screen_schema().read(table);
  root.finish();
  return options;
}

std::string problem(const std::string& text, void (*read)(Table&), const char* name) {
  Table root = Table::parse(text, "x.toml");
  Table table = root.table(name);
  read(table);
  try {
    root.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string screen_problem(const std::string& lines) {
  return problem(
      "[screen]\n" + lines, [](Table& t) { protocols::screen_schema().read(t); }, "screen");
}

std::string text_problem(const std::string& lines) {
  return problem(
      "[texts]\n" + lines, [](Table& t) { protocols::text_schema().read(t); }, "texts");
}

TEST(ScreenOptionsTest, EveryKeyIsReadAndNoneIsNeeded) {
  EXPECT_TRUE(screen("").full_screen);
  EXPECT_EQ(screen("").photodiode, protocols::Photodiode::kOff);
  const protocols::ScreenOptions options = screen(
      "title = \"Study\"\nfull_screen = false\nmonitor = 2\nrefresh_lock = false\n"
      "photodiode = \"frames\"\n");
  EXPECT_EQ(options.title, "Study");
  EXPECT_FALSE(options.full_screen);
  EXPECT_EQ(options.monitor, 2);
  EXPECT_FALSE(options.refresh_lock);
  EXPECT_EQ(options.photodiode, protocols::Photodiode::kEveryFrame);
  EXPECT_EQ(screen("photodiode = \"run\"").photodiode, protocols::Photodiode::kRun);
  EXPECT_FALSE(screen("").participant_steers) << "only where the definition says so";
  EXPECT_TRUE(screen("participant_steers = true").participant_steers);
  EXPECT_EQ(screen("").mistake_key, 0);
  EXPECT_EQ(screen("mistake_key = \"X\"").mistake_key, 'X');
  EXPECT_EQ(screen("mistake_key = \"backspace\"").mistake_key, protocols::kBackspaceKey);
}

TEST(ScreenOptionsTest, BadValuesAndUnknownKeysAreNamedWithTheirLine) {
  EXPECT_THAT(screen_problem("full_screen = 1"), HasSubstr("x.toml:2: screen.full_screen is"));
  EXPECT_THAT(screen_problem("monitor = -1"), HasSubstr("screen.monitor is -1; allowed:"));
  EXPECT_THAT(screen_problem("photodiode = \"always\""),
              HasSubstr("allowed: off, frames, run, onset"));
  for (const std::string key : {"enter", "space", "oops"}) {
    EXPECT_THAT(screen_problem("mistake_key = \"" + key + "\""),
                HasSubstr("screen.mistake_key is '" + key + "'; allowed: backspace, A to Z"));
  }
  EXPECT_THAT(screen_problem("fullscreen = true"), HasSubstr("fullscreen"));
  EXPECT_THAT(screen_problem("title = 3"), HasSubstr("screen.title"));
  EXPECT_EQ(screen_problem("monitor = 0"), "");
}

TEST(SessionTextsTest, FourAreNeeded) {
  const std::string good = "instructions = \"a\"\npractice = \"b\"\nrest = \"c\"\nthanks = \"d\"\n";
  EXPECT_EQ(text_problem(good), "");
  Table table = Table::parse(good, "x.toml");
  const protocols::SessionTexts texts = protocols::text_schema().read(table);
  EXPECT_EQ(texts.instructions + texts.practice + texts.rest + texts.thanks, "abcd");
  EXPECT_THAT(text_problem("instructions = \"a\"\npractice = \"b\"\nrest = \"c\"\n"),
              HasSubstr("texts.thanks"));
  EXPECT_THAT(text_problem(good + "more = \"e\"\n"), HasSubstr("more"));
  const std::string long_text(4001, 'x');
  EXPECT_THAT(text_problem("instructions = \"" + long_text +
                           "\"\npractice = \"b\"\nrest = \"c\"\nthanks = \"d\"\n"),
              HasSubstr("texts.instructions is 4001 bytes long; allowed: at most 4000"));
}

TEST(SessionTextsTest, TheOthersHaveDefaultsThatADefinitionMayReplace) {
  const std::string four = "instructions = \"a\"\npractice = \"b\"\nrest = \"c\"\nthanks = \"d\"\n";
  Table plain = Table::parse(four, "x.toml");
  const protocols::SessionTexts defaults = protocols::text_schema().read(plain);
  for (const std::string* text : {&defaults.stopped, &defaults.paused, &defaults.recovering,
                                  &defaults.limit, &defaults.begin, &defaults.begin_alone}) {
    EXPECT_FALSE(text->empty());
  }
  EXPECT_THAT(defaults.limit, HasSubstr("square"));
  Table own = Table::parse(four +
                               "stopped = \"e\"\npaused = \"f\"\nrecovering = \"g\"\n"
                               "limit = \"h\"\nbegin = \"i\"\nbegin_alone = \"j\"\n",
                           "x.toml");
  const protocols::SessionTexts texts = protocols::text_schema().read(own);
  EXPECT_EQ(texts.stopped + texts.paused + texts.recovering + texts.limit + texts.begin +
                texts.begin_alone,
            "efghij");
}

TEST(PageOfTest, TheFirstLineIsTheTitle) {
  const render::TextPage page = protocols::page_of("Rest\n\nLet go.\nRelax.\n", "Wait");
  EXPECT_EQ(page.title, "Rest");
  EXPECT_EQ(page.body, "Let go.\nRelax.");
  EXPECT_EQ(page.hint, "Wait");
  EXPECT_FALSE(page.countdown.has_value());
  EXPECT_EQ(protocols::page_of("Thanks").title, "Thanks");
  EXPECT_EQ(protocols::page_of("Thanks").body, "");
  EXPECT_EQ(protocols::page_of("Thanks\n").body, "");
  EXPECT_EQ(protocols::page_of("").title, "");
}

}  // namespace
}  // namespace haptrial::experiments
