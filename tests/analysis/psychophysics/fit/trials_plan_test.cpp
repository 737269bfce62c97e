#include "analysis/psychophysics/fit/trials_plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::analysis::trials {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

PlanDefaults defaults() {
  PlanDefaults d;
  d.kind = AnalysisKind::kPsychometric;
  d.factors = {"visual"};
  d.names = {"track", "condition"};
  d.procedures = {{"level", {psychometric::Scale::kLog10, 300.0, "N/m"}, std::nullopt}};
  d.questions = {{"answer", {"first", "second"}, false, true}};
  return d;
}

TrialsPlan read(const std::string& text, const PlanDefaults& d = defaults()) {
  Table root = Table::parse(text, "study.toml");
  const TrialsPlan plan = read_trials_plan(root, d);
  root.finish();
  return plan;
}

std::string problems_of(const std::string& text, const PlanDefaults& d = defaults()) {
  try {
    read(text, d);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TrialsPlanTest, EveryKeyMayBeLeftOut) {
  for (const char* text : {"[design]\n", "[analysis]\n"}) {
    Table root = Table::parse(text, "study.toml");
    const TrialsPlan plan = read_trials_plan(root, defaults());
    EXPECT_EQ(plan.kind, AnalysisKind::kPsychometric);
    EXPECT_THAT(plan.by, ElementsAre("visual"));
    EXPECT_EQ(plan.function.guess, 0.5);
    EXPECT_FALSE(plan.guess_free);
    EXPECT_EQ(plan.threshold_at, 0.75);
    EXPECT_EQ(plan.function.share, 0.5);
    EXPECT_EQ(plan.function.axis.origin, 300.0);
    EXPECT_EQ(plan.function.axis.scale, psychometric::Scale::kLog10);
    EXPECT_FALSE(plan.reference);
  }
}

TEST(TrialsPlanTest, WhatItStatesCounts) {
  const TrialsPlan plan = read(R"([analysis]
kind = "psychometric"
by = ["track"]
tests = ["near < far"]
function = "neg_logistic"
guess = "free"
lapse = { free = true, at_most = 0.1 }
scale = "linear"
origin = 0.0
threshold_at = 0.6
reference = 320.0
bayesian = false
hierarchical = true
resamples = 500
)");
  EXPECT_THAT(plan.by, ElementsAre("track"));
  EXPECT_TRUE(plan.guess_free);
  EXPECT_EQ(plan.task(), Task::kYesNo);
  EXPECT_TRUE(plan.function.falling);
  EXPECT_EQ(plan.function.sigmoid, psychometric::Sigmoid::kLogistic);
  EXPECT_EQ(plan.lapse.low, 0.0);
  EXPECT_EQ(plan.lapse.high, 0.1);
  EXPECT_EQ(plan.function.axis.scale, psychometric::Scale::kLinear);
  EXPECT_EQ(plan.function.share, 0.6);
  EXPECT_EQ(plan.reference, 320.0);
  EXPECT_FALSE(plan.bayesian);
  EXPECT_TRUE(plan.hierarchical);
  EXPECT_EQ(plan.resamples, 500u);
  ASSERT_EQ(plan.plan.tests.size(), 1u);
  EXPECT_EQ(plan.plan.tests[0].tail, Tail::kLess);
}

TEST(TrialsPlanTest, ALogarithmicFunctionHasALogarithmicAxis) {
  PlanDefaults d = defaults();
  d.procedures = {};
  EXPECT_EQ(read("[analysis]\nfunction = \"weibull\"\n", d).function.axis.scale,
            psychometric::Scale::kNaturalLog);
  EXPECT_EQ(read("[analysis]\nfunction = \"gumbel\"\n", d).function.axis.scale,
            psychometric::Scale::kLinear);
}

/// A comparison below the standard: right answers raise the level.
TEST(TrialsPlanTest, AFunctionFallsAsTheProcedureDoes) {
  PlanDefaults d = defaults();
  d.procedures.at(0).falls = true;
  EXPECT_TRUE(read("[analysis]\nbayesian = true\n", d).function.falling);
  EXPECT_EQ(read("[analysis]\nbayesian = true\n", d).function_name, "neg_norm");
  EXPECT_TRUE(read("[analysis]\nfunction = \"neg_logistic\"\n", d).function.falling);
  EXPECT_FALSE(read("[analysis]\nfunction = \"norm\"\nyes = \"first\"\n", d).function.falling);
  EXPECT_THAT(problems_of("[analysis]\nfunction = \"norm\"\n", d),
              HasSubstr("\"neg_norm\", which falls as the procedure's right answers do"));
}

/// Two procedures: one of a force, one of multiples of the threshold.
TEST(TrialsPlanTest, FunctionsAreOfOneVariableOfSeveral) {
  PlanDefaults d = defaults();
  d.procedures.push_back({"times", {}, std::nullopt});
  const TrialsPlan first = read("[analysis]\nbayesian = true\n", d);
  EXPECT_EQ(first.level, "level");
  EXPECT_TRUE(first.level_assumed);
  EXPECT_EQ(first.function.axis.scale, psychometric::Scale::kLog10);
  const TrialsPlan second = read("[analysis]\nlevel = \"times\"\n", d);
  EXPECT_TRUE(second.level_is_set);
  EXPECT_FALSE(second.level_assumed);
  EXPECT_EQ(second.function.axis.scale, psychometric::Scale::kLinear);
  const TrialsPlan derived = read("[analysis]\nlevel = \"strength\"\n", d);
  EXPECT_FALSE(derived.level_is_set);
  EXPECT_EQ(read("[analysis]\nbayesian = true\n").level, "");  // one procedure
}

TEST(TrialsPlanTest, LapsesAreFewerWhereTheyCountTwice) {
  EXPECT_EQ(read("[analysis]\nbayesian = true\n").lapse.high, 0.2);
  EXPECT_EQ(read("[analysis]\nguess = \"lapse\"\n").lapse.high, 0.06);
}

TEST(TrialsPlanTest, TheThresholdIsAShareOfAnswersApartFromLapses) {
  const TrialsPlan plan = read("[analysis]\nguess = 0.25\nthreshold_at = 0.7\n");
  EXPECT_NEAR(plan.function.guess + (1.0 - plan.function.guess) * plan.function.share, 0.7, 1e-12);
}

TEST(TrialsPlanTest, AMistakeGetsItsSentence) {
  EXPECT_THAT(
      problems_of("[analysis]\nkind = \"psychometrics\"\n"),
      HasSubstr("study.toml:2: analysis.kind is 'psychometrics'; did you mean psychometric?"));
  EXPECT_THAT(problems_of("[analysis]\nby = [\"colour\"]\n"),
              HasSubstr("visual, track, condition"));
  EXPECT_THAT(problems_of("[analysis]\ntests = [\"a and b\"]\n"), HasSubstr("analysis.tests"));
  EXPECT_THAT(problems_of("[analysis]\nfunction = \"weibul\"\n"), HasSubstr("weibull"));
  EXPECT_THAT(problems_of("[analysis]\nthreshold_at = 0.5\n"),
              HasSubstr("a number above 0.5 and below 1"));
  EXPECT_THAT(problems_of("[analysis]\nguess = \"none\"\n"), HasSubstr("analysis.guess"));
  EXPECT_THAT(problems_of("[analysis]\nlaps = 0.1\n"), HasSubstr("laps"));
  EXPECT_THAT(problems_of("[analysis]\nby = []\ntests = [\"a < b\"]\n"), HasSubstr("by"));
  EXPECT_THAT(problems_of("[analysis]\nkind = \"magnitude\"\nreference = 3.0\n"),
              HasSubstr("reference"));
}

TEST(TrialsPlanTest, PlannedTestsNameLevelsThatTheDefinitionStates) {
  PlanDefaults d = defaults();
  d.factors = {"grip", "mass"};
  d.levels = {{"grip", {"loose", "firm"}}, {"mass", {"0.3", "0.6"}}};
  EXPECT_EQ(read("[analysis]\ntests = [\"0.30 != 0.60\"]\n", d).plan.tests.at(0).a, "0.3");
  EXPECT_NO_THROW(read("[analysis]\ntests = [\"loose, 0.3 < firm, 0.3\"]\n", d));
  try {
    read("[analysis]\ntests = [\"loose < frim\"]\n", d);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("names 'frim', which is no level of the factors in `by`; "
                                        "did you mean firm?"));
    EXPECT_THAT(error.what(), HasSubstr("'loose', 'firm'"));
  }
  EXPECT_THROW(read("[analysis]\nkind = \"none\"\ntests = [\"loose < firm\"]\n", d), InputError);
}

const char* const kCues = R"([analysis]
guess = 0.0
by = ["modality", "noise", "conflict"]
[analysis.cue_combination]
first = { modality = "eye" }
second = { modality = "hand" }
both = { modality = "both" }
at = "noise"
conflict = "conflict"
standard = "standard"
first_shows = "seen"
second_shows = "felt"
)";

PlanDefaults defaults_of_cues() {
  PlanDefaults d = defaults();
  d.factors = {"noise", "conflict"};
  d.names = {"modality"};
  d.questions.clear();
  d.cues.levels = {{"modality", {"hand", "eye", "both"}}, {"noise", {"0", "0.67"}}};
  d.cues.intervals = {"standard", "comparison"};
  d.cues.variables = {"felt", "seen"};
  return d;
}

/// Sentences about the table with one thing written otherwise.
std::string problems_with(const std::string& what, const std::string& by) {
  std::string text = kCues;
  text.replace(text.find(what), what.size(), by);
  try {
    read(text, defaults_of_cues());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TrialsPlanTest, CuesAreReadWithTheirConditions) {
  const TrialsPlan plan = read(kCues, defaults_of_cues());
  ASSERT_TRUE(plan.cues);
  EXPECT_EQ(plan.cues->first.at("modality"), "eye");
  EXPECT_EQ(plan.cues->second.at("modality"), "hand");
  EXPECT_EQ(plan.cues->at, "noise");
  EXPECT_EQ(plan.cues->second_shows, "felt");
  EXPECT_EQ(name_of_cue(plan.cues->both), "both");
  EXPECT_EQ(problems_with("{ modality = \"eye\" }", "{ modality = \"eye\", noise = 0.67 }"), "");
  EXPECT_FALSE(read("[analysis]\n").cues);
}

TEST(TrialsPlanTest, AMistakeInCuesGetsItsSentence) {
  EXPECT_THAT(problems_with("\"eye\"", "\"eyes\""),
              HasSubstr("analysis.cue_combination.first.modality is \"eyes\"; allowed: a level of "
                        "modality: hand, eye, both"));
  EXPECT_THAT(problems_with("first = { modality", "first = { mode"),
              HasSubstr("state a factor of analysis.by: modality, noise, conflict"));
  EXPECT_THAT(problems_with("{ modality = \"eye\" }", "{ modality = \"eye\", noise = 0.5 }"),
              HasSubstr("a level of noise: 0, 0.67"));
  EXPECT_THAT(problems_with("\"hand\"", "\"eye\""),
              HasSubstr("analysis.cue_combination.second does not differ from `first`"));
  EXPECT_THAT(problems_with("\"both\"", "\"eye\""), HasSubstr("does not differ from `first`"));
  EXPECT_THAT(
      problems_with("at = \"noise\"", "at = \"nois\""),
      HasSubstr("analysis.cue_combination.at is \"nois\"; allowed: a factor of analysis.by"));
  EXPECT_THAT(problems_with("at = \"noise\"", "at = \"conflict\""),
              HasSubstr("another factor than that of `conflict`"));
  EXPECT_THAT(problems_with("at = \"noise\"\n", ""),
              HasSubstr("analysis.by names \"noise\", of which cue_combination says nothing"));
  EXPECT_THAT(problems_with("\"standard\"", "\"first\""), HasSubstr("standard, comparison"));
  EXPECT_THAT(problems_with("\"seen\"", "\"looked\""), HasSubstr("felt, seen"));
  EXPECT_THAT(problems_with("conflict = \"conflict\"\n", ""),
              HasSubstr("analysis.cue_combination.conflict"));
  EXPECT_THAT(problems_with("guess = 0.0", "guess = 0.5"),
              HasSubstr("set guess = 0.0 or \"free\""));
  EXPECT_THAT(problems_with("both =", "all ="), HasSubstr("all"));
}

TEST(TrialsPlanTest, KeysOfMovementsAreLeftToTheirAnalysis) {
  EXPECT_EQ(read("[analysis]\nkind = \"reaching\"\nstage = \"reach\"\n").kind,
            AnalysisKind::kReaching);
}

TEST(TrialsPlanTest, DiffusionIsForTwoChoices) {
  PlanDefaults d = defaults();
  d.questions = {{"answer", {"left", "right"}}};
  const std::string text =
      "[analysis]\nkind = \"times\"\ndiffusion = true\nstart_point = 0.4\n"
      "contaminants = 0.05\n";
  const TrialsPlan plan = read(text, d);
  EXPECT_TRUE(plan.diffusion);
  EXPECT_EQ(plan.diffusion_options.start, 0.4);
  EXPECT_EQ(plan.diffusion_options.contaminants, 0.05);
  d.questions[0].choices.emplace_back("neither");
  EXPECT_THAT(problems_of(text, d), HasSubstr("two choices"));
  EXPECT_THAT(problems_of("[analysis]\nkind = \"none\"\ndiffusion = true\n"),
              HasSubstr("diffusion"));
}

TEST(TrialsPlanTest, MetacognitionNeedsAQuestionOfConfidenceAndTwoStimuli) {
  PlanDefaults d = defaults();
  d.questions = {{"answer", {"yes", "no"}}};
  const std::string detection = "[analysis]\nkind = \"detection\"\nmetacognition = true\n";
  const std::string identification =
      "[analysis]\nkind = \"identification\"\nmetacognition = true\n";
  EXPECT_THAT(problems_of(detection, d), HasSubstr("confidence"));
  d.questions.push_back({"sure", {}});
  EXPECT_TRUE(read(detection, d).metacognition);
  EXPECT_TRUE(read(identification, d).metacognition);
  d.questions[0].choices.emplace_back("neither");
  EXPECT_THAT(problems_of(identification, d), HasSubstr("two choices"));
}

TEST(TrialsPlanTest, TheGuessRateIsThatOfTheQuestionThatCounts) {
  PlanDefaults d = defaults();
  d.questions = {{"sure", {}}, {"what", {"a", "b", "c", "d"}, false, true}};
  d.produced.variables = {"level", "visual"};
  EXPECT_TRUE(read("[analysis]\n", d).guess_free) << "no answer of the first is right";
  EXPECT_EQ(read("[analysis]\nquestion = \"what\"\n", d).function.guess, 0.25);
  EXPECT_TRUE(read("[analysis]\nquestion = \"what\"\nyes = \"a\"\n", d).guess_free);
  d.questions = {{"answer", {"first", "second", "missed"}, true, true}};
  EXPECT_EQ(read("[analysis]\n", d).function.guess, 0.5) << "nobody guesses silence";
  EXPECT_TRUE(read("[analysis]\nyes = \"missed\"\n", d).guess_free);
  d.counts_formula = true;
  EXPECT_TRUE(read("[analysis]\n", d).guess_free);
  EXPECT_EQ(read("[analysis]\nquestion = \"answer\"\n", d).function.guess, 0.5)
      << "then it counts whether the answer is right";
}

TEST(TrialsPlanTest, AnIdentificationTakesTheChoicesOfItsQuestion) {
  PlanDefaults d = defaults();
  d.questions = {{"sure", {}}, {"what", {"soft", "stiff", "missed"}, true, true}};
  const TrialsPlan plan = read("[analysis]\nkind = \"identification\"\nquestion = \"what\"\n", d);
  EXPECT_THAT(plan.choices, ElementsAre("soft", "stiff", "missed"));
  EXPECT_EQ(plan.alternatives(), 2);
  EXPECT_EQ(plan.rating, "sure");
}

TEST(TrialsPlanTest, NamesOfAnswersAreThoseOfTheDefinition) {
  PlanDefaults d = defaults();
  d.questions = {{"present", {"felt", "nothing"}}, {"sure", {}}};
  d.produced.variables = {"level", "visual"};
  const std::string detection = "[analysis]\nkind = \"detection\"\n";
  EXPECT_THAT(problems_of(detection, d),
              HasSubstr("analysis.yes is missing, and no answer is \"yes\"; add the one that says "
                        "that there was a signal: felt, nothing"));
  EXPECT_EQ(read(detection + "yes = \"felt\"\n", d).yes, "felt");
  EXPECT_THAT(problems_of(detection + "yes = \"Felt\"\n", d),
              HasSubstr("analysis.yes is \"Felt\"; allowed: an answer: felt, nothing"));
  EXPECT_THAT(problems_of(detection + "yes = \"felt\"\nrating = \"sur\"\n", d),
              HasSubstr("analysis.rating is \"sur\"; allowed: a question: present, sure"));
  EXPECT_THAT(problems_of("[analysis]\nquestion = \"presnt\"\n", d),
              HasSubstr("analysis.question is \"presnt\""));
  EXPECT_THAT(problems_of("[analysis]\nlevel = \"levl\"\n", d),
              HasSubstr("analysis.level is \"levl\"; allowed: a variable of the trials: level"));
}

TEST(TrialsPlanTest, TheFactorThatIsTheLevelMakesNoConditions) {
  PlanDefaults d = defaults();
  d.factors = {"size", "visual"};
  d.produced.variables = {"size", "visual"};
  for (const char* kind : {"psychometric", "magnitude", "times"}) {
    const std::string text = fmt::format("[analysis]\nkind = \"{}\"\nlevel = \"size\"\n", kind);
    const TrialsPlan plan = read(text, d);
    EXPECT_EQ(plan.level, "size") << kind;
    EXPECT_FALSE(std::ranges::count(plan.by, "size")) << kind;
    EXPECT_THAT(problems_of(text + "by = [\"size\"]\n", d), HasSubstr("which `by` names, too"))
        << kind;
  }
  EXPECT_THAT(read("[analysis]\nlevel = \"size\"\n", d).by, ElementsAre("visual"));
}

TEST(TrialsPlanTest, FactorsThatVaryWhileALevelIsAdjustedMakeNoConditions) {
  PlanDefaults d = defaults();
  d.kind = AnalysisKind::kAdjustment;
  d.factors = {"ref", "visual"};
  d.within_settings = {"ref"};
  EXPECT_THAT(read("[analysis]\n", d).by, ElementsAre("visual"));
  EXPECT_THAT(problems_of("[analysis]\nby = [\"ref\"]\n", d),
              HasSubstr("varies while a level is adjusted; add by = [\"ref\"] to the procedure"));
}

TEST(TrialsPlanTest, TheStimulusIsTheFactorWhoseLevelsAreChoices) {
  PlanDefaults d = defaults();
  d.factors = {"cond", "stim"};
  d.levels = {{"cond", {"a", "b"}}, {"stim", {"weak", "strong"}}};
  d.questions = {{"answer", {"weak", "strong"}}};
  const std::string identification = "[analysis]\nkind = \"identification\"\n";
  EXPECT_EQ(read(identification, d).stimulus, "stim");
  EXPECT_EQ(read(identification + "stimulus = \"cond\"\n", d).stimulus, "cond");
  d.questions = {{"answer", {"left", "right"}}};
  EXPECT_EQ(read(identification, d).stimulus, "cond");
}

TEST(TrialsPlanTest, OneOfTwoStimuliInATrialIsATaskOfOneInterval) {
  PlanDefaults d = defaults();
  const std::string identification = "[analysis]\nkind = \"identification\"\n";
  const std::string one = identification + "task = \"one interval\"\n";
  d.questions = {{"answer", {"left", "right"}}};
  d.cues.intervals = {"only"};
  EXPECT_EQ(read(identification, d).discrimination, DiscriminationTask::kOneInterval);
  d.cues.intervals = {"first", "second"};
  EXPECT_EQ(read(identification, d).discrimination, DiscriminationTask::kForcedChoice);
  EXPECT_EQ(read(one, d).discrimination, DiscriminationTask::kOneInterval);
  d.cues.intervals = {"only"};
  d.questions[0].choices.emplace_back("neither");
  EXPECT_EQ(read(identification, d).discrimination, DiscriminationTask::kForcedChoice);
  EXPECT_THAT(problems_of(one, d), HasSubstr("two choices"));
}

TEST(TrialsPlanTest, TheRuleThatEndsAStudyLooksAtThePlannedQuantity) {
  const std::string text =
      "[analysis]\ntests = [\"a < b\"]\ntests_of = \"width\"\n[analysis.sequential]\n"
      "rule = \"bayes factor\"\n";
  EXPECT_EQ(read(text).plan.sequential->of, "width");
  EXPECT_EQ(read(text + "of = \"threshold\"\n").plan.sequential->of, "threshold");
}

TEST(TrialsPlanTest, TheFirstTargetIsPursuedByItsNumber) {
  PlanDefaults d = defaults();
  d.pursuit = {{"pursue"}, {{"preview", {}}, {"tracked", {0.1}}}, "tracked"};
  const PursuitPlan plan = read("[analysis]\nkind = \"pursuit\"\n", d).pursuit;
  EXPECT_EQ(plan.target, "tracked");
  EXPECT_EQ(plan.number, 1U);
}

TEST(TrialsPlanTest, ACovariateIsAScoreOfAPage) {
  PlanDefaults d = defaults();
  d.pages = {"hands"};
  EXPECT_EQ(read("[analysis]\ncovariate = \"hands.age\"\n", d).plan.covariate.name, "hands.age");
  EXPECT_THAT(problems_of("[analysis]\ncovariate = \"feet.age\"\n", d), HasSubstr("hands"));
  EXPECT_THAT(problems_of("[analysis]\ncovariate = \"hands\"\n", d), HasSubstr("PAGE.SCORE"));
}

TEST(TrialsPlanTest, GainAndLagAreAtFrequenciesOfTheTarget) {
  PlanDefaults d = defaults();
  d.pursuit = {{"pursue"}, {{"circle", {0.1, 0.25, 0.55}}}, "circle"};
  const std::string pursuit = "[analysis]\nkind = \"pursuit\"\n";
  EXPECT_THAT(read(pursuit, d).pursuit.swing, ElementsAre(0.1, 0.25, 0.55));
  const PursuitPlan some = read(pursuit + "frequencies = [0.55, 0.1]\n", d).pursuit;
  EXPECT_THAT(some.frequencies, ElementsAre(0.55, 0.1));
  EXPECT_THAT(some.swing, ElementsAre(0.55, 0.1, 0.25));
  EXPECT_THAT(problems_of(pursuit + "frequencies = [0.1, 0.4]\n", d), HasSubstr("0.1, 0.25, 0.55"));
}

}  // namespace
}  // namespace haptrial::analysis::trials
