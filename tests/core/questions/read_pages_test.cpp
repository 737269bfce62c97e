#include "core/questions/read_pages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/questions/question_kind.h"

namespace haptrial::questions {
namespace {

using testing::HasSubstr;

PagePlan plan_of(const std::string& text) {
  Table root = Table::parse(text, "study.toml");
  PagePlan plan = read_pages(root);
  root.finish();
  return plan;
}

std::string problem_of(const std::string& text) {
  try {
    plan_of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(PagesTest, ReadsEveryKindOfPage) {
  const PagePlan plan = plan_of(R"(
[pages]
before = ["welcome", "agree", "hand"]
after = ["load", "you"]
after_block = { first = ["load"] }
[pages.welcome]
title = "Welcome"
text = "A text"
picture = "hand.png"
[pages.agree]
kind = "consent"
text = "Do you agree?"
[pages.hand]
kind = "edinburgh"
[pages.load]
kind = "nasa_tlx"
weighted = true
[pages.you]
kind = "questions"
[[pages.you.items]]
name = "age"
question = "How old are you?"
number = [18, 99]
[[pages.you.items]]
name = "often"
question = "How often?"
choices = [{ value = "never", number = 0 }, { value = "daily", label = "Every day" }]
[[pages.you.items]]
name = "tired"
question = "How tired?"
scale = [1, 7]
ends = { low = "not at all", high = "very" }
[[pages.you.items]]
name = "else"
question = "Anything else?"
words = true
)");
  EXPECT_THAT(plan.before, testing::ElementsAre("welcome", "agree", "hand"));
  EXPECT_EQ(plan.page("welcome").items.front().picture, "hand.png");
  EXPECT_EQ(plan.page("agree").items.front().kind->word(), "consent");
  EXPECT_EQ(plan.page("hand").items.size(), 10u);
  EXPECT_EQ(plan.page("load").items.size(), 21u);
  EXPECT_EQ(plan.after_block.at("first").front(), "load");
  const Page& you = plan.page("you");
  ASSERT_EQ(you.items.size(), 4u);
  EXPECT_EQ(you.items[0].kind->word(), "number");
  EXPECT_EQ(you.items[0].high, 99.0);
  EXPECT_EQ(you.items[1].choices[0].label, "never");
  EXPECT_EQ(you.items[1].choices[0].number, 0.0);
  EXPECT_EQ(you.items[1].choices[1].label, "Every day");
  EXPECT_EQ(you.items[2].low_end, "not at all");
  EXPECT_EQ(you.items[3].kind->word(), "words");
}

TEST(PagesTest, MistakesGetTheirSentence) {
  const std::string text = "[pages.a]\ntext = \"b\"\n";
  EXPECT_THAT(problem_of("[pages]\nbefore = [\"b\"]\n" + text),
              HasSubstr("pages.before is a list with \"b\"; allowed: names of pages"));
  EXPECT_THAT(problem_of(text), HasSubstr("pages.a is never shown"));
  EXPECT_THAT(problem_of("[pages]\nafter = [\"a\"]\n[pages.a]\nkind = \"consent\"\ntext = \"b\"\n"),
              HasSubstr("pages.a asks for consent when the session is under way"));
  EXPECT_THAT(problem_of("[pages]\nafter = [\"a\"]\n[pages.a]\nkind = \"nasa\"\n"),
              HasSubstr("pages.a.kind"));
  const std::string item =
      "[pages]\nafter = [\"a\"]\n[pages.a]\nkind = \"questions\"\n"
      "[[pages.a.items]]\nname = \"n\"\nquestion = \"q\"\n";
  EXPECT_THAT(problem_of(item), HasSubstr("has no one way to be answered"));
  EXPECT_THAT(problem_of(item + "scale = [0, 10]\nstep = 3\n"),
              HasSubstr("a whole number of steps"));
  EXPECT_THAT(problem_of(item + "number = [3, 1]\n"), HasSubstr("[lowest, highest]"));
}

}  // namespace
}  // namespace haptrial::questions
