// Studies of the level of responses: what they share with full sessions, and what their reports
// find.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/psychophysics/data/read_trials.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "experiments/power/power_run.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/study_run.h"
#include "protocols/psychophysics/response_session.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::responses_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

const fs::path kSource = HAPTRIAL_SOURCE_DIR;

struct Agreement {
  double same{0.0};    // answers
  double levels{0.0};  // trials with the same level
};

/// One participant with a hand and without one.
Agreement agreement_of(const std::string& name, const std::string& met) {
  const TemporaryFolder folder;
  const Experiment experiment = load_experiment(kSource / "experiments" / (name + ".toml"));
  DryRun dry;
  dry.participants = 1;
  dry.seed = 5;
  dry.max_trials = 60;
  dry.folder = folder / "sessions";
  run_dry(experiment.study->protocol(), *experiment.definition, dry);
  const auto full = analysis::trials::read_trials(
      session_files(dry.folder), [](const std::string&) { return std::string(); }, 1);
  const auto& d = dynamic_cast<const protocols::StudiedDefinition&>(*experiment.definition);
  protocols::SessionPlace place;
  place.subject = participant_name(0);
  place.seed = 5;
  protocols::give_seeds(place);
  const auto alone = protocols::ResponseSession(d, met, {}).answered(place);
  Agreement agreement;
  for (std::size_t i = 0; i < full.trials.size(); ++i) {
    const auto& a = full.trials[i];
    const auto& b = alone[i];
    EXPECT_EQ(a.trial, b.plan.trial);
    EXPECT_EQ(a.condition, b.plan.condition);
    agreement.same += a.answers.front().text == b.answers.front().text ? 1.0 : 0.0;
    const double level = a.levels.empty() ? 0.0 : a.levels.front().applied;
    const double other = b.levels.empty() ? 0.0 : b.levels.front().applied;
    agreement.levels += level == other ? 1.0 : 0.0;
  }
  agreement.same /= static_cast<double>(full.trials.size());
  agreement.levels /= static_cast<double>(full.trials.size());
  return agreement;
}

TEST(ResponseSession, PresentsAndAnswersAlmostAsAFullSessionOfTheSameSeed) {
  const Agreement force = agreement_of("force_discrimination", "$force");
  EXPECT_EQ(force.levels, 1.0) << "constant stimuli do not depend on answers";
  EXPECT_GE(force.same, 0.9);
}

TEST(ResponseSession, RefusesAFormulaWithUnknownNames) {
  const Experiment experiment = load_experiment(kSource / "experiments/force_discrimination.toml");
  const auto& d = dynamic_cast<const protocols::StudiedDefinition&>(*experiment.definition);
  EXPECT_THROW(protocols::ResponseSession(d, "$weight", {}).check_met(), InputError);
}

PowerQuestion question_of(const TemporaryFolder& folder, const std::string& power) {
  write_text(folder / "power.toml", power);
  return load_question(folder / "power.toml");
}

std::string power_of(const std::string& name, const std::string& rest) {
  return "[power]\ndefinition = \"" + (kSource / "experiments" / (name + ".toml")).string() +
         "\"\n" + rest;
}

void expect_refused(const std::string& power, const std::string& words) {
  const TemporaryFolder folder;
  try {
    check_watched(question_of(folder, power));
    ADD_FAILURE() << "not refused: " << words;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

constexpr const char* kVary = R"(
[[power.vary]]
key = "design.participants"
values = [4, 6]
)";

TEST(PowerQuestion, RefusesBadInputWithASentence) {
  const std::string met = "[power.responses]\nmet = \"$stiffness\"\n";
  const std::string name = "stiffness_discrimination";
  expect_refused(power_of(name, "watch = \"sign test\"\n" + met + kVary),
                 "power.watch is \"sign test\", which a first study could not make; made, and "
                 "allowed: \"drift over the trials\"");
  expect_refused(
      power_of(name, "watch = \"threshold: paired t\"\n" + met + kVary),
      "power.watch is \"threshold: paired t\", which a first study could not make; made, and "
      "allowed: \"drift over the trials\", "
      "\"repetition of the answer before\"");
  std::string huge = "watch = \"drift over the trials\"\n" + met;
  for (const char* key : {"observer.drift", "observer.repetition", "observer.lapse.median"}) {
    huge += "[[power.vary]]\nkey = \"" + std::string(key) + "\"\nvalues = [";
    for (int i = 0; i < 1000; ++i) {
      huge += std::to_string(0.001 * i) + ", ";
    }
    huge += "]\n";
  }
  expect_refused(power_of(name, huge), "power.vary has 1e+09 cells; allowed: at most 10000");
  expect_refused(power_of(name, "watch = \"drift over the trials\"\n" + std::string(kVary)),
                 "power.responses.met is missing");
  expect_refused(
      power_of(name, "watch = \"drift over the trials\"\n" + met +
                         "[[power.vary]]\nkey = \"design.participants\"\nvalues = [-3]\n"),
      "design.participants is -3");
  expect_refused(power_of(name, "watch = \"drift over the trials\"\n" + met +
                                    "[[power.vary]]\nkey = \"observer.wit\"\nvalues = [1]\n"),
                 "observer.wit");
  expect_refused(power_of(name, "watch = \"drift over the trials\"\n" + met +
                                    "[[power.vary]]\nkey = \"observer.force_weber.spread\"\n"
                                    "values = [0.0]\n[[power.vary]]\n"
                                    "key = \"observer.lapse.spread\"\nvalues = [0.0]\n"),
                 "do not differ from each other");
  expect_refused(power_of(name, "watch = \"t\"\n" + met +
                                    "[[power.vary]]\nkey = \"design.participants\"\nvalues = []\n"),
                 "power.toml:8: power.vary[1].values is an empty array");
  expect_refused(power_of("bone_drilling", "watch = \"t\"\n" + std::string(kVary)),
                 "does not know the report of protocol 'bone_drilling'");
}

/// Four trials of force matching by people who differ, and a question about them.
std::string produced_power(const std::string& rest) {
  std::string text = file_text(kSource / "docs/worked/everyday/force_matching.toml");
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("trials = 40", "trials = 4");
  replace("trials = 4\n", "trials = 1\n");  // of practice
  replace("[observer]\n", "[observer]\nforce_weber = { median = 0.07, spread = 0.3 }\n");
  return text + "\n[power]\nwatch = \"no such test\"\n" + rest +
         "[[power.vary]]\nkey = \"design.participants\"\nvalues = [3]\n";
}

TEST(PowerQuestion, WhatHandsProduceIsWatchedInFullSessionsAlone) {
  expect_refused(produced_power(""), "power.depth = \"sessions\"");
  expect_refused(produced_power("depth = \"sessions\"\n"), "\"constant error: target\"");
}

/// The study of retention with six trials a session and two people a group.
std::string retention_power(const std::string& rest) {
  std::string text = file_text(kSource / "docs/worked/teaching/force_retention.toml");
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("participants = 12", "participants = 6");
  replace("trials = 12 ", "trials = 4 ");
  replace("repetitions = 3 ", "repetitions = 1 ");
  replace("seen = 4\nseen-and-felt = 4\ncontrol = 4", "seen = 2\nseen-and-felt = 2\ncontrol = 2");
  replace("speed = 0.016 ", "speed = 0.032 ");
  return text + "\n[power]\nwatch = \"no such test\"\n" + rest +
         "[[power.vary]]\nkey = \"subject.forgetting.median\"\nvalues = [0.3]\n";
}

TEST(PowerQuestion, ForceTrainingsOfSeveralSessionsAreWatchedByTheirChanges) {
  expect_refused(retention_power(""),
                 "do not simulate force trainings of several sessions; give power.depth = "
                 "\"sessions\"");
  expect_refused(
      retention_power("depth = \"sessions\"\n"),
      "\"change of recall error, planned: seen-and-felt, retention < seen, retention, Welch's t\"");
}

TEST(PowerQuestion, VariesKeysAndPutsNullCellsFirst) {
  const TemporaryFolder folder;
  const PowerQuestion q = question_of(
      folder, power_of("wall_detection",
                       "watch = \"drift over the trials\"\n[power.responses]\n"
                       "met = \"0.0175 * $level\"\n" +
                           std::string(kVary) +
                           "[[power.vary]]\nkey = \"observer.drift\"\nvalues = [0.0, 0.01]\n"
                           "none = 0.0\n"));
  ASSERT_EQ(q.cells.size(), 4u);  // cells at none are the null cells, once
  EXPECT_TRUE(q.cells[0].null && q.cells[1].null);
  EXPECT_EQ(q.cells[3].name, "design.participants 6, observer.drift 0.01");
  EXPECT_THAT(q.text_of(q.cells[3]), HasSubstr("participants = 6\n"));
  check_watched(q);
}

constexpr const char* kGroupsOfTwo = R"([experiment]
protocol = "trials"
name = "two_groups"
[design]
participants = 24
[groups]
trained = 9
control = 15
[variables]
extra = { from = "group", trained = "0.0", control = "0.0" }
[fields.pull]
type = "constant"
force = [0.0, "-$level", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 1.0 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "constant"
variable = "level"
unit = "N"
levels = [0.05, 0.1, 0.15, 0.2, 0.3, 0.4]
repetitions = 20
counts = "$answer == 1"
[observer]
senses = "force"
decides = "yes"
criterion = { median = 0.17, spread = 0.3 }
force_floor = 0.08
[observer.actions]
feel = { do = "hold" }
[analysis]
by = ["group"]
tests = ["trained < control"]
)";

TEST(PowerQuestion, GroupsFollowTheParticipantsAndParticipantsTheGroups) {
  const TemporaryFolder folder;
  write_text(folder / "study.toml", kGroupsOfTwo);
  const auto sizes_of = [&](const std::string& key, const std::string& values) {
    const PowerQuestion q = question_of(
        folder,
        "[power]\ndefinition = \"study.toml\"\nwatch = \"threshold: planned trained < control, "
        "Welch's t\"\n[power.responses]\nmet = \"$level\"\n[[power.vary]]\nkey = \"" +
            key + "\"\nvalues = " + values + "\n");
    std::vector<std::vector<int>> sizes;
    for (const QuestionCell& cell : q.cells) {
      const Experiment experiment = parse_experiment(q.parts_of(cell));
      const protocols::Definition& d = *experiment.definition;
      sizes.push_back({d.design.participants, d.groups[0].participants, d.groups[1].participants});
    }
    return sizes;
  };
  // 9 to 15 of 12: 4.5 and 7.5, whose remainders are equal; of 10: 3.75 and 6.25.
  EXPECT_EQ(sizes_of("design.participants", "[24, 16, 12, 10]"),
            (std::vector<std::vector<int>>{{24, 9, 15}, {16, 6, 10}, {12, 5, 7}, {10, 4, 6}}));
  EXPECT_EQ(sizes_of("groups.trained", "[6, 12]"),
            (std::vector<std::vector<int>>{{21, 6, 15}, {27, 12, 15}}));
}

TEST(PowerQuestion, AFullStudyIsAPartOfItsOwnUnlessABlockIsStated) {
  const TemporaryFolder folder;
  const std::string plan = "watch = \"drift over the trials\"\nreplications = 10\n";
  const auto counts_of = [&](const std::string& more) {
    const std::string vary = "[[power.vary]]\nkey = \"design.participants\"\nvalues = [4]\n";
    const std::string power = power_of("stiffness_discrimination", plan + more + vary);
    std::vector<int> counts;
    for (const PowerUnit& unit : units_of(question_of(folder, power))) {
      counts.push_back(unit.count);
    }
    return counts;
  };
  EXPECT_EQ(counts_of("depth = \"sessions\"\n"), std::vector<int>(10, 1));
  EXPECT_EQ(counts_of("depth = \"sessions\"\nblock = 4\n"), (std::vector<int>{4, 4, 2}));
  EXPECT_EQ(counts_of(""), std::vector<int>{10});
}

TEST(PowerQuestion, TheSourcesPooledTestExceedsItsLevelAndThePairedOneDoesNot) {
  const TemporaryFolder folder;
  PowerQuestion q = load_question(kSource / "docs/worked/power/pooled.toml");
  q.plan.null_replications = 100;
  q.plan.replications = 1;
  q.cells.resize(1);  // without an effect
  const PowerFolder parts(folder / "power", q);
  fill(parts, q, {2});
  const auto result = parts.merged();
  for (const analysis::PowerCell& cell : result.nulls) {
    const auto pooled = cell.counts.of(q.plan.watch);
    EXPECT_GT(pooled.rejected, analysis::binomial_band(100, 0.05, 0.999).high);
    const std::string paired = "planned: visuohaptic < visual, paired t";
    const auto unadjusted = cell.counts.of(paired + ", unadjusted");
    EXPECT_TRUE(analysis::binomial_band(100, 0.05, 0.999).holds(unadjusted.rejected))
        << unadjusted.rejected;
    EXPECT_LE(cell.counts.of(paired).rejected, unadjusted.rejected);
  }
  EXPECT_FALSE(analysis::is_power(result));
}

}  // namespace
}  // namespace haptrial::experiments::responses_test
