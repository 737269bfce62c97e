// Tables of other programs become trials, or one sentence says why not.
#include "analysis/psychophysics/exchange/imported_trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "analysis/files/csv.h"
#include "analysis/files/sha256.h"
#include "analysis/psychophysics/exchange/imported_definition.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::trials {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// As PsychoPy 2023 writes it: a comma at the end of each line, a row for the instructions.
constexpr const char* kPsychoPy =
    "trials.thisTrialN,welcome.keys,welcome.rt,resp.keys,resp.corr,resp.rt,speed,trials.intensity,"
    "participant,session,expName,psychopyVersion,\n"
    ",space,1.5,,,,,,ann,001,weights,2023.2.3,\n"
    "0,,,left,1,0.482,slow,2.5,ann,001,weights,2023.2.3,\n"
    "1,,,None,0,,fast,3.5,ann,001,weights,2023.2.3,\n"
    "2,,,right,0,0.75,fast,4.5,ann,001,weights,2023.2.3,\n";

// As jsPsych 7 writes it: everything quoted, times in milliseconds.
constexpr const char* kJsPsych =
    "\"rt\",\"response\",\"trial_type\",\"trial_index\",\"time_elapsed\",\"subject\",\"task\","
    "\"correct\",\"level\"\n"
    "\"1543.2\",\"\",\"instructions\",\"0\",\"1550\",\"bob\",\"\",\"\",\"\"\n"
    "\"612\",\"f\",\"html-keyboard-response\",\"1\",\"2300\",\"bob\",\"judge\",\"true\",\"0.4\"\n"
    "\"null\",\"null\",\"html-keyboard-response\",\"2\",\"4300\",\"bob\",\"judge\",\"false\",\"0."
    "8\"\n";

class ImportedTrialsTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  static TrialColumns guessed(const std::string& text) {
    return guess_columns(CsvTable::parse(text, "t.csv"));
  }

  ImportedStudy read(const std::string& text, TrialColumns columns) {
    return read_trial_tables({file("t.csv", text)}, columns);
  }

  std::string refusal(const std::string& text, TrialColumns columns) {
    try {
      read(text, std::move(columns));
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImportedTrialsTest, ReadsATableOfPsychoPy) {
  TrialColumns columns = guessed(kPsychoPy);
  EXPECT_EQ(columns.origin, TableOrigin::kPsychoPy);
  EXPECT_EQ(columns.answer, "resp.keys");
  EXPECT_EQ(columns.level, "trials.intensity");
  add_factor("speed", columns);
  const ImportedStudy study = read(kPsychoPy, columns);
  ASSERT_EQ(study.trials.size(), 3u);
  EXPECT_EQ(study.left_out, 1u);
  EXPECT_EQ(study.unanswered, 1u);
  const ImportedTrial& first = study.trials[0];
  EXPECT_EQ(first.participant, "ann");
  EXPECT_EQ(first.session, 1);
  EXPECT_EQ(first.answer, "left");
  EXPECT_EQ(first.correct, 1);
  EXPECT_EQ(first.time, 0.482);
  EXPECT_EQ(first.level, 2.5);
  EXPECT_EQ(first.factors[0].word, "slow");
  EXPECT_EQ(first.line, 3u);
  EXPECT_EQ(study.trials[1].answer, "");
  EXPECT_EQ(study.trials[1].correct, -1) << "nobody answered, whatever the program says";
  EXPECT_TRUE(std::isnan(study.trials[1].time));
}

TEST_F(ImportedTrialsTest, ReadsATableOfJsPsych) {
  TrialColumns columns = guessed(kJsPsych);
  EXPECT_EQ(columns.origin, TableOrigin::kJsPsych);
  EXPECT_THAT(refusal(kJsPsych, columns), HasSubstr("t.csv:2: level is ''; allowed: a finite "));
  add_filter("task=judge", columns);
  const ImportedStudy study = read(kJsPsych, columns);
  ASSERT_EQ(study.trials.size(), 2u);
  EXPECT_DOUBLE_EQ(study.trials[0].time, 0.612);
  EXPECT_EQ(study.trials[0].correct, 1);
  EXPECT_EQ(study.unanswered, 1u);
}

TEST_F(ImportedTrialsTest, EachMistakeIsOneSentenceWithItsLine) {
  const std::string head = "subject,level,correct,rt_ms\n";
  TrialColumns columns = guessed(head + "a,1,1,3\n");
  EXPECT_EQ(columns.time_unit, 1e-3);
  const auto found = [&](const char* row) { return refusal(head + "a,1,1,500\n" + row, columns); };
  EXPECT_THAT(found("a,high,1,500\n"), HasSubstr("t.csv:3: level is 'high'; allowed: a finite"));
  EXPECT_THAT(found("a,2,maybe,500\n"), HasSubstr("t.csv:3: correct is 'maybe'; allowed: 1 or 0"));
  EXPECT_THAT(found("a,2,1,-4\n"), HasSubstr("t.csv:3: rt_ms is '-4'; allowed: a number of at"));
  EXPECT_THAT(found("a b,2,1,4\n"), HasSubstr("t.csv:3: subject is 'a b'; allowed: 1 to 32 let"));
  EXPECT_THAT(found("a,2,1\n"), HasSubstr("t.csv:3: the row has 3 fields; allowed: 4"));
  columns.level = "levle";
  EXPECT_THAT(found(""), HasSubstr("there is no column 'levle'; did you mean level?"));
}

TEST_F(ImportedTrialsTest, NeedsToKnowWhatTimesAndAnswersMean) {
  const std::string text = "subject,level,response,rt\na,1,left,500\na,2,right,400\n";
  TrialColumns columns = guessed(text);
  EXPECT_THAT(refusal(text, columns), HasSubstr("add --time-unit s or --time-unit ms"));
  columns.time_unit = 1.0;
  const ImportedStudy study = read(text, columns);
  try {
    imported_definition(study, {"study", "", "", {}});
    ADD_FAILURE() << "no answer was called right";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--yes ANSWER"));
    EXPECT_THAT(error.what(), EndsWith("allowed: left, right"));
  }
  EXPECT_THAT(imported_definition(study, {"study", "", "right", {}}), HasSubstr("yes = \"right\""));
}

TEST_F(ImportedTrialsTest, ASessionIsInOneTable) {
  const auto a = file("a.csv", "subject,session,correct\nP1,1,1\n");
  const auto b = file("b.csv", "subject,session,correct\nP1,2,1\n");
  const TrialColumns columns = guess_columns(CsvTable::load(a));
  EXPECT_EQ(read_trial_tables({a, b}, columns).trials.size(), 2u);
  file("b.csv", "subject,session,correct\nP1,1,1\n");
  EXPECT_THROW(read_trial_tables({a, b}, columns), InputError);
}

TEST_F(ImportedTrialsTest, AFileIsItsParticipantWithoutAColumn) {
  const auto a = file("P07.csv", "level,correct\n1,1\n2,0\n");
  EXPECT_EQ(read_trial_tables({a}, guess_columns(CsvTable::load(a))).trials[1].participant, "P07");
}

TEST_F(ImportedTrialsTest, FactorsWithAWordAreWords) {
  const std::string text = "subject,correct,mass\na,1,2\na,0,2\na,1,full\n";
  TrialColumns columns = guessed(text);
  add_factor("mass", columns);
  const ImportedStudy study = read(text, columns);
  EXPECT_EQ(study.trials[0].factors[0].word, "2");
  EXPECT_THAT(imported_definition(study, {"study", "none", "", {}}),
              HasSubstr("mass = [\"2\", \"full\"]"));
}

TEST_F(ImportedTrialsTest, WordsKeepTheSpellingOfTheirFields) {
  const std::string text = "subject,correct,code\na,1,1\na,0,01\na,1,1.0\na,1,x\n";
  TrialColumns columns = guessed(text);
  add_factor("code", columns);
  const ImportedStudy study = read(text, columns);
  std::vector<std::string> words;
  for (const ImportedTrial& trial : study.trials) {
    words.push_back(trial.factors[0].word);
  }
  EXPECT_THAT(words, ElementsAre("1", "01", "1.0", "x"));
  EXPECT_TRUE(std::isnan(study.trials[0].factors[0].number));
  EXPECT_THAT(study.warnings, ElementsAre(HasSubstr("different levels of code: \"01\", \"1\"")));
}

TEST_F(ImportedTrialsTest, ParticipantsWithAlikeNamesAreSaid) {
  const std::string text = "subject,correct\nP1,1\nP2,0\np1,1\nP01,1\n";
  EXPECT_THAT(read(text, guessed(text)).warnings,
              ElementsAre(HasSubstr("different participants: \"P01\", \"P1\", \"p1\"")));
}

TEST_F(ImportedTrialsTest, TimesThatNobodyHasAreSaid) {
  const auto warnings_of = [&](const std::string& times, double unit) {
    const std::string text = "subject,correct,rt\n" + times;
    TrialColumns columns = guessed(text);
    columns.time_unit = unit;
    return read(text, columns).warnings;
  };
  const std::string milliseconds = "a,1,301\na,1,501\na,0,699\na,0,\n";
  const std::string seconds = "a,1,0.301\na,1,0.501\na,0,0.699\n";
  EXPECT_THAT(warnings_of(milliseconds, 1.0),
              ElementsAre("WARNING: half of the reaction times in rt are at least 501 s; are these "
                          "milliseconds? --time-unit says the unit."));
  EXPECT_THAT(warnings_of(seconds, 1e-3),
              ElementsAre(HasSubstr("are at most 0.000501 s; are these seconds?")));
  EXPECT_THAT(warnings_of(milliseconds, 1e-3), IsEmpty());
  EXPECT_THAT(warnings_of(seconds, 1.0), IsEmpty());
}

TEST_F(ImportedTrialsTest, AMistypedAnswerIsSaidWithTheGuessRate) {
  const std::string text =
      "subject,level,correct,answer,side\na,1,1,left,Up\na,2,0,right,up\na,3,1,Right,up\n";
  TrialColumns columns = guessed(text);
  add_factor("side", columns);
  const ImportedStudy study = read(text, columns);
  EXPECT_THAT(study.warnings, ElementsAre(HasSubstr("different answers: \"Right\", \"right\""),
                                          HasSubstr("different levels of side: \"Up\", \"up\"")));
  EXPECT_THAT(guess_note(study, {"s", "", "", {}}),
              HasSubstr("guess rate 0.333, one in the 3 answers Right (1), left (1), right (1)"));
  EXPECT_EQ(guess_note(study, {"s", "", "", 0.5}), "");
  EXPECT_EQ(guess_note(study, {"s", "", "left", {}}), "");
}

TEST_F(ImportedTrialsTest, HowManyStimuliATrialHadIsSaidWithTheTask) {
  const std::string two = "subject,answer,side\na,first,first\na,second,second\n";
  TrialColumns columns = guessed(two);
  add_factor("side", columns);
  const ImportedAnalysis identification{"s", "identification", "", {}};
  const ImportedStudy pair = read(two, columns);
  EXPECT_THAT(task_note(pair, identification), HasSubstr("task = \"forced choice\""));
  EXPECT_THAT(imported_definition(pair, identification), HasSubstr("task = \"one interval\""));
  EXPECT_EQ(task_note(pair, {"s", "none", "", {}}), "");
  const ImportedStudy three = read(two + "a,third,first\n", columns);
  EXPECT_EQ(task_note(three, identification), "");
  EXPECT_THAT(imported_definition(three, identification), Not(HasSubstr("task")));
}

TEST_F(ImportedTrialsTest, TheWordNoneIsAnAnswerAndALevel) {
  const std::string text =
      "subject,level,answer,load\na,1,some,none\na,2,none,heavy\na,2,None,none\n";
  TrialColumns columns = guessed(text);
  add_factor("load", columns);
  const ImportedStudy study = read(text, columns);
  EXPECT_EQ(study.trials[1].answer, "none");
  EXPECT_EQ(study.trials[0].factors[0].word, "none");
  EXPECT_EQ(study.unanswered, 1u);
  EXPECT_THAT(study.warnings, Contains(HasSubstr("'None' is read as no answer, in 1 trial")));
  const std::string points = "subject,level,answer,load\na,1,yes,x\na,2,.,x\na,2,NULL,x\n";
  EXPECT_EQ(read(points, columns).unanswered, 2u) << "as SAS, SPSS and SQL write it";
  EXPECT_THAT(refusal("subject,level,answer,load\na,1,some,None\n", columns),
              HasSubstr("load is 'None'; allowed: a level"));
}

TEST_F(ImportedTrialsTest, SpellingsOfOneNumberAreSaid) {
  const std::string text = "subject,correct,code\na,1,1\na,0,01\na,1,2\na,1,2\n";
  TrialColumns columns = guessed(text);
  add_factor("code", columns);
  const ImportedStudy study = read(text, columns);
  EXPECT_EQ(study.trials[1].factors[0].number, 1.0);
  EXPECT_EQ(study.trials[1].factors[0].word, "");
  EXPECT_THAT(study.warnings,
              ElementsAre("WARNING: 01, 1 in code are the same number and are taken for one "
                          "level."));
}

TEST_F(ImportedTrialsTest, AnswersThatAreOneNumberAreOneAnswer) {
  const std::string text = "subject,level,answer,part\na,1,1.0,1\na,2,0.0,1.0\nb,1,1,1\nb,2,0,2\n";
  TrialColumns columns = guessed(text);
  const ImportedStudy study = read(text, columns);
  EXPECT_EQ(study.trials[0].answer, "1");
  EXPECT_EQ(study.trials[1].answer, "0");
  EXPECT_THAT(study.warnings,
              ElementsAre("WARNING: 0, 0.0 are the same number and are taken for one answer.",
                          "WARNING: 1, 1.0 are the same number and are taken for one answer."));
  add_filter("part=1", columns);
  EXPECT_EQ(read(text, columns).trials.size(), 3u);
}

TEST_F(ImportedTrialsTest, LoopsThatArePutTogetherAreSaidAndToldApart) {
  const std::string text =
      "practice.thisN,blocks.thisN,trials.thisN,resp.keys,resp.rt,participant,expName\n"
      "0,,,a,1.5,ann,e\n1,,,b,1.5,ann,e\n"
      ",0,0,a,0.5,ann,e\n,0,1,b,0.5,ann,e\n,1,0,a,0.5,ann,e\n";
  TrialColumns columns = guessed(text);
  const ImportedStudy all = read(text, columns);
  EXPECT_EQ(all.trials.size(), 5u);
  EXPECT_THAT(all.warnings,
              ElementsAre(HasSubstr("several loops are put together: blocks and trials (3 trials), "
                                    "practice (2 trials); if one is practice, --only LOOP.thisN")));
  add_filter("trials.thisN", columns);
  const ImportedStudy main = read(text, columns);
  EXPECT_EQ(main.trials.size(), 3u);
  EXPECT_THAT(main.warnings, IsEmpty());
}

TEST_F(ImportedTrialsTest, NamesThatTheAnalysisHasAreNoFactors) {
  TrialColumns columns;
  EXPECT_THROW(add_factor("group", columns), InputError);
  EXPECT_THROW(add_factor("two words", columns), InputError);
  EXPECT_THROW(set_column("anwser=x", columns), InputError);
  EXPECT_THROW(set_column("answer", columns), InputError);
  add_factor("hand=which hand", columns);
  EXPECT_EQ(columns.factors[0].column, "which hand");
}

// FIPS 180-2, appendix B.1.

}  // namespace
}  // namespace haptrial::analysis::trials
