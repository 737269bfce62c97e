// Questions of a definition of trials: the kinds that pages have, too.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/questions/question_kind.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"

namespace haptrial::protocols::questions_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string asking(const std::string& response) {
  std::string text = small_trials(kSmallStaircase);
  const std::size_t from = text.find("[response]");
  const std::size_t to = text.find("\n[", from + 1);
  text.replace(from, to - from,
               "[[responses]]\nname = \"answer\"\nquestion = \"Which?\"\n"
               "choices = [{ value = \"first\" }, { value = \"second\" }]\n"
               "correct = \"$interval.comparison\"\n"
               "[[responses]]\nname = \"more\"\nquestion = \"And?\"\n" +
                   response);
  return text;
}

TrialsDefinition read(const std::string& response) {
  TrialsDefinition definition;
  read_small(asking(response), definition);
  return definition;
}

TEST(QuestionsTest, AScaleWithStepsIsMovedAndOneOfDigitsIsChosen) {
  const TrialsDefinition moved = read("scale = [0, 100]\nstep = 5\n");
  EXPECT_EQ(moved.questions[1].kind->word(), "scale");
  EXPECT_EQ(moved.questions[1].step, 5.0);
  EXPECT_FALSE(moved.questions[1].has_choices());
  const TrialsDefinition ends =
      read("scale = [1, 7]\nends = { low = \"smooth\", high = \"rough\" }\n");
  EXPECT_EQ(ends.questions[1].kind->word(), "scale");
  EXPECT_EQ(ends.questions[1].high_end, "rough");
  const TrialsDefinition digits = read("scale = [1, 7]\n");
  ASSERT_EQ(digits.questions[1].choices.size(), 7u);
  EXPECT_EQ(given_answer(digits.questions[1], 6, {}).value, 7.0);
  EXPECT_EQ(given_answer(digits.questions[1], 6, {}).text, "7");
  EXPECT_THAT(
      problems_of_trials(asking("scale = [0, 100]\n")),
      Contains(HasSubstr("whole numbers from 0 to 9; on another scale a mark is moved: add step")));
  EXPECT_THAT(problems_of_trials(asking("scale = [0, 100]\nstep = 7\n")),
              Contains(HasSubstr("a whole number of steps")));
}

TEST(QuestionsTest, MarkersHaveOneCodeForAnAnswerThatIsNoChoice) {
  std::vector<std::string> names;
  for (const auto& meaning : read("words = true\n").marker_meanings()) {
    names.push_back(meaning.name);
  }
  EXPECT_THAT(names, Contains("more words"));
}

// A key with another function would end what is typed.
TEST(QuestionsTest, EveryCharacterBelongsToATrialThatAsksForWords) {
  const TrialsDefinition words = read("words = true\n");
  EXPECT_NE(words.functions_of({'P'}), 0u);
  EXPECT_EQ(words.functions_of({'P'}), words.functions_of({'Q'}));
  EXPECT_NE(words.functions_of({'1'}), words.functions_of({'P'})) << "the first choice";
  EXPECT_EQ(read("number = [0, 1]\n").functions_of({'P'}), 0u);
}

TEST(QuestionsTest, ANumberBelowZeroHasItsSign) {
  EXPECT_NE(read("number = [-1, 1]\n").functions_of({'-'}), 0u);
  EXPECT_EQ(read("number = [0, 1]\n").functions_of({'-'}), 0u);
}

TEST(QuestionsTest, FormulasKnowTheAnswersThatAreNumbers) {
  const auto problems = [](const std::string& response) {
    return problems_of_trials(asking(response + "[variables]\nlast = \"2 * $more\"\n"));
  };
  EXPECT_THAT(problems("words = true\n"), Contains(HasSubstr("there is no variable more")));
  EXPECT_THAT(problems("scale = [0, 1]\nstep = 0.1\n"),
              testing::Not(Contains(HasSubstr("no variable more"))));
}

TEST(QuestionsTest, OneWayToAnswer) {
  EXPECT_THAT(problems_of_trials(asking("scale = [0, 1]\nwords = true\n")),
              Contains(HasSubstr("state one of choices, scale, number, words")));
  EXPECT_THAT(problems_of_trials(asking("words = true\n")), IsEmpty());
}

}  // namespace
}  // namespace haptrial::protocols::questions_test
