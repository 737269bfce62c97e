// Whole sessions of virtual participants without a runner: a hand goes to a place or presses the
// pedal, answers out of time come again, QUEST+ of two dimensions finds what is felt, contacts with
// an object are recorded.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "core/base/definition/table.h"
#include "core/psychometric/procedure/procedure.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/interface/session_file.h"
#include "protocols/interface/session_task.h"
#include "protocols/psychophysics/defined_trials.h"
#include "protocols/psychophysics/presentation/trial_page.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/support/felt_or_not.h"

namespace haptrial::protocols {
namespace {

using record::ResponseSource;

/// Place of the tip on each tick, and the force on it.
class Tips final : public stimulus::Observer {
 public:
  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double) noexcept override {
    at.push_back(shown.tool);
    felt.push_back(forces[0]);
  }
  std::vector<Eigen::Vector3d> at;
  std::vector<Eigen::Vector3d> felt;  // [N]
};

/// The forces on the first body that is seen, and the tool, on each tick on which any press it.
class Presses final : public stimulus::Observer {
 public:
  struct Press {
    std::int32_t body;
    Eigen::Vector3d on_body;  // in W [N]
    Eigen::Vector3d tool;
  };
  void observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept override {
    const auto* view = shown.as<TrialView>();
    if (view == nullptr || view->pressed.on(0).empty()) {
      return;
    }
    Press press{view->objects[0].body, Eigen::Vector3d::Zero(), shown.tool};
    for (const SeenForces::Force& force : view->pressed.on(0)) {
      press.on_body += Eigen::Vector3f(force.newtons.data()).cast<double>();
    }
    all.push_back(press);
  }
  std::vector<Press> all;
};

/// The last view that tells what was measured.
class Told final : public stimulus::Observer {
 public:
  explicit Told(TrialView& last) : last_(last) {}
  void observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept override {
    const auto* view = shown.as<TrialView>();
    if (view != nullptr && view->results) {
      last_ = *view;
    }
  }

 private:
  TrialView& last_;
};

/// Keeps rows in memory.
class Rows final : public SessionFile {
 public:
  std::vector<record::LevelRow> levels;
  std::vector<record::OutOfTimeRow> late;
  std::vector<record::StageRow> stages;
  std::vector<record::ContactRow> contacts;
  std::vector<record::TouchedBodyRow> touched;
  std::vector<record::MovingBodyRow> moving;
  std::map<std::string, std::string> events;

  void keep_stimulus(std::int32_t, std::span<const record::StimulusRow>) override {}
  bool holds_stimulus(std::int32_t) const override { return true; }
  void event(const std::string& kind, const std::string& text) override { events[kind] = text; }
  const std::vector<record::PassRow>& earlier_passes() const override { return none_; }
  bool was_cut_short(const PlannedTrial&) const override { return false; }

 protected:
  void put(const record::Rows& batch) override {
    const auto add = [&](auto& to) {
      using Row = typename std::decay_t<decltype(to)>::value_type;
      const auto rows = batch.as<Row>();
      to.insert(to.end(), rows.begin(), rows.end());
    };
    add(levels);
    add(late);
    add(stages);
    add(contacts);
    add(touched);
    add(moving);
  }

 private:
  std::vector<record::PassRow> none_;
};

/// A session of one virtual participant.
class SimulatedTrialsTest : public testing::Test {
 protected:
  void simulate_trials(const std::string& text) {
    Table root = Table::parse(text, "study.toml");
    definition_ = trials_protocol().read(root, "study.toml", nullptr);
    root.finish();
    DefinedTrials trials(studied(), place());
    const std::unique_ptr<Rig> rig = trials.virtual_rig();
    SessionTask::Log log(64, 64);  // nobody reads it
    SessionTask task({.devices = {{&rig->device(), definition_->envelope}},
                      .log = log,
                      .observers = {rig->subject(), &tips_, &presses_, &told_by_}},
                     SessionTask::Leave::kNever);
    std::uint64_t index = 0;
    for (auto trial = trials.next(nullptr); trial; trial = trials.next(&outcomes_.back())) {
      const auto row = static_cast<std::int32_t>(outcomes_.size());
      Pass& pass = trials.make_pass(*trial, trials.phases().front());
      task.start(pass, row);
      for (const std::uint64_t last = index + 30000; !task.idle(); ++index) {
        ASSERT_LT(index, last) << "half a minute and no answer";
        task.tick({index, static_cast<std::int64_t>(index) * 1'000'000, 1e-3});
      }
      ASSERT_EQ(task.result().state, PassState::kCompleted) << trials.why_aborted();
      trials.empty_logs(rows_);
      trials.close_pass(rows_, row);
      outcomes_.push_back({*trial, TrialEnd::kCompleted, trials.responses()});
      for (record::ResponseRow& response : outcomes_.back().responses) {
        response.pass = row;
        responses_.push_back(response);
      }
    }
    notices_ = trials.notices();
  }
  const StudiedDefinition& studied() const {
    return dynamic_cast<const StudiedDefinition&>(*definition_);
  }
  static SessionPlace place() {
    SessionPlace place;
    place.subject = "S01";
    place.seed = 7;
    give_seeds(place);
    return place;
  }

  std::unique_ptr<Definition> definition_;
  Tips tips_;
  Presses presses_;
  TrialView told_;  // in the last trial
  Told told_by_{told_};
  std::vector<std::string> notices_;
  Rows rows_;
  std::vector<Outcome> outcomes_;
  std::vector<record::ResponseRow> responses_;
};

TEST_F(SimulatedTrialsTest, AVirtualHandGoesToThePlaceOfItsAnswer) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(
      test::felt_or_not("choices = [{ value = \"yes\", touch = \"right\" }, { value = \"no\", "
                        "touch = \"left\" }]\n")));
  ASSERT_EQ(responses_.size(), 12u);
  std::map<std::int32_t, std::uint64_t> asked;  // the first tick after the last stage
  for (const record::StageRow& stage : rows_.stages) {
    asked[stage.pass] = stage.last_sample + 1;
  }
  std::map<std::string, int> given;
  for (const record::ResponseRow& row : responses_) {
    ++given[row.text];
    EXPECT_EQ(row.source, ResponseSource::kPlace);
    EXPECT_EQ(row.code, row.text == "yes" ? 1 : 0) << "left is the first region by name";
    const auto inside = [&](std::uint64_t tick) {
      const Eigen::Vector3d& p = tips_.at.at(tick);
      return row.text == "yes" ? (p - Eigen::Vector3d(0.03, 0.0, 0.0)).cwiseAbs().maxCoeff() <= 0.01
                               : (p - Eigen::Vector3d(-0.03, 0.0, 0.0)).norm() <= 0.01;
    };
    EXPECT_TRUE(inside(row.sequence)) << "the tick on which the tip came in";
    EXPECT_FALSE(inside(row.sequence - 1));
    for (std::uint64_t tick = row.sequence; tick <= row.sequence + 200; ++tick) {
      ASSERT_TRUE(inside(tick));
    }
    const auto ticks = static_cast<double>(row.sequence - asked.at(row.pass) + 1);
    EXPECT_NEAR(row.reaction_time, ticks / 1000.0, 1e-9);
  }
  EXPECT_EQ(given, (std::map<std::string, int>{{"yes", 6}, {"no", 6}}));
}

TEST_F(SimulatedTrialsTest, AHandThatIsInThePlaceAlreadyLeavesItFirst) {
  std::string text = test::felt_or_not(
      "choices = [{ value = \"yes\", touch = \"right\" }, { value = \"no\", touch = \"left\" }]\n");
  const std::string home = "to = [0.0, 0.0, 0.0]";
  text.replace(text.find(home), home.size(), "to = [0.03, 0.0, 0.0]");
  ASSERT_NO_FATAL_FAILURE(simulate_trials(text));
  for (const record::ResponseRow& row : responses_) {
    EXPECT_GT(row.reaction_time, row.text == "yes" ? 0.6 : 0.1);
  }
  EXPECT_EQ(responses_.size(), 12u);
}

TEST_F(SimulatedTrialsTest, AVirtualParticipantPressesThePedal) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(test::felt_or_not(
      "choices = [{ value = \"yes\", pedal = 0.5 }, { value = \"no\", buttons = [0] }]\n")));
  int pedal = 0;
  for (const record::ResponseRow& row : responses_) {
    EXPECT_EQ(row.source == ResponseSource::kPedal, row.text == "yes");
    pedal += row.source == ResponseSource::kPedal ? 1 : 0;
    EXPECT_GT(row.reaction_time, 0.1);
  }
  EXPECT_EQ(pedal, 6);
}

/// Where the hand was on the tick of the answer says the number.
TEST_F(SimulatedTrialsTest, AVirtualHandAnswersOnALine) {
  std::string text = test::felt_or_not(
      "scale = [0, 2]\nstep = 0.05\nby = \"hand\"\nlength = 0.08\nbuttons = [2]\n");
  const std::string counts = "$answer == 1";
  text.replace(text.find(counts), counts.size(), "$answer > 0.5");
  ASSERT_NO_FATAL_FAILURE(simulate_trials(text));
  ASSERT_EQ(responses_.size(), 12u);
  int strong = 0;
  for (const record::ResponseRow& row : responses_) {
    EXPECT_EQ(row.source, ResponseSource::kButton);
    EXPECT_EQ(row.code, 2);
    const double x = tips_.at.at(row.sequence).x();
    EXPECT_NEAR(row.value, 1.0 + x / 0.04, 0.0251) << "the nearest step";
    EXPECT_GT(row.reaction_time, 0.9) << "a way of the hand and a rest";
    strong += row.value > 0.5 ? 1 : 0;
  }
  EXPECT_EQ(strong, 6) << "the strong pulls are called stronger";
}

/// A hand that holds still is asked about fields in stages.
std::string still(const std::string& fields_and_stages) {
  return R"([experiment]
protocol = "trials"
name = "still"
[design]
participants = 1
[observer]
decides = "yes"
criterion = 0.15
[response]
question = "Did you feel it?"
choices = [{ value = "yes" }, { value = "no" }]
[[blocks]]
name = "one"
trials = 3
[observer.actions]
feel = { do = "hold" }
)" + fields_and_stages;
}

/// With edges of 50 ms a pulse of 200 ms has the impulse of its force for 150 ms.
TEST_F(SimulatedTrialsTest, EveryIntervalHasItsPulse) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(still(R"(
[intervals]
first = { a = 2.0 }
second = { a = 4.0 }
[fields.pulse]
type = "pulse"
force = ["$a", 0.0, 0.0]
duration = 0.2
delay = 0.3
rise = 0.05
[[stages]]
name = "feel"
fields = ["pulse"]
until = { time = 1.0 }
)")));
  double impulse = 0.0;
  for (const Eigen::Vector3d& force : tips_.felt) {
    impulse += 1e-3 * force.x();
  }
  EXPECT_NEAR(impulse, 3 * (2.0 + 4.0) * 0.15, 0.01);
}

/// A pulse that would go on is cut off by a stage, by the next interval and by the question.
TEST_F(SimulatedTrialsTest, NoStepComesWhereAStageCutsAStimulusOff) {
  const std::string pulse =
      "type = \"pulse\"\nforce = [3.0, 0.0, 0.0]\nduration = 5.0\nrise = 0.5\n";
  const std::string wave =
      "type = \"vibration\"\ndirection = [1.0, 0.0, 0.0]\namplitude = 3.0\nfrequency = 5.0\n";
  const std::string between =
      "[[stages]]\nname = \"after\"\nuntil = { time = 0.3 }\n"
      "[observer.actions.after]\ndo = \"hold\"\n";
  const std::string intervals = "[intervals]\nfirst = { }\nsecond = { }\n";
  for (const std::string& field : {pulse, wave}) {
    for (const std::string& more : {between, std::string(), intervals}) {
      SCOPED_TRACE(field + more);
      tips_.felt.clear();
      outcomes_.clear();
      ASSERT_NO_FATAL_FAILURE(simulate_trials(
          still((more == intervals ? more : "") + "[fields.given]\n" + field +
                "[[stages]]\nname = \"feel\"\nfields = [\"given\"]\nuntil = { time = 0.95 }\n" +
                (more == between ? more : ""))));
      double most = 0.0, step = 0.0;
      for (std::size_t i = 1; i < tips_.felt.size(); ++i) {
        most = std::max(most, tips_.felt[i].norm());
        step = std::max(step, (tips_.felt[i] - tips_.felt[i - 1]).norm());
      }
      EXPECT_GT(most, 2.9);
      EXPECT_LT(step, 3.0 * (1.5e-3 / 0.05 + 2.0 * M_PI * 5.0 * 1e-3)) << "a fade and a slope";
    }
  }
}

/// A wall that is pressed, with measures of the press and nothing asked.
std::string pressing(const std::string& procedure, const std::string& measures) {
  return R"([experiment]
protocol = "trials"
name = "pressing"
[design]
participants = 1
[variables]
target = 1.5
[fields.floor]
type = "wall"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.0]
stiffness = 1000.0
damping = 2.0
[[stages]]
name = "rest"
fields = ["floor"]
until = { time = 0.3 }
[[stages]]
name = "press"
fields = ["floor"]
until = { time = 1.5 }
[observer]
[observer.actions]
press = { do = "press", force = 1.3, rise = 0.4 }
)" + procedure +
         measures;
}

const char* const kFourTrials = "[[blocks]]\nname = \"all\"\ntrials = 4\n";

TEST_F(SimulatedTrialsTest, WhatIsProducedIsAnAnswerOfItsTrial) {
  ASSERT_NO_FATAL_FAILURE(
      simulate_trials(pressing(kFourTrials,
                               "[measures.pressed]\nfield = \"floor\"\nlast = 0.5\n"
                               "within = [\"$target - 0.4\", \"$target\"]\n"
                               "[measures.took]\nquantity = \"time\"\n"
                               "[measures.hard]\nfield = \"floor\"\nwithin = [2.0, 3.0]\n")));
  ASSERT_EQ(responses_.size(), 12u) << "three of each trial";
  for (const record::ResponseRow& row : responses_) {
    EXPECT_EQ(row.source, ResponseSource::kMeasured);
    EXPECT_TRUE(std::isnan(row.reaction_time));
    if (row.question == "took") {
      EXPECT_NEAR(row.value, 1.5, 0.0011);
      EXPECT_EQ(row.correct, -1);
    } else if (row.question == "pressed") {
      EXPECT_NEAR(row.value, 1.3, 0.1) << "the hand presses with 1.3 N";
      EXPECT_EQ(row.correct, 1);
    } else {
      EXPECT_EQ(row.question, "hard");
      EXPECT_EQ(row.correct, 0);
    }
  }
}

/// 1.3 N are within the tolerance while the target is less than 1.6 N.
TEST_F(SimulatedTrialsTest, AProcedureLearnsFromAMeasure) {
  const std::string staircase =
      "[procedure]\nkind = \"staircase\"\nvariable = \"target\"\nrange = [0.5, 3.0]\n"
      "start = 1.3\nsteps = [0.1]\ndown = 1\nright_raises = true\n"
      "stop = { reversals = 4, trials = 30 }\n";
  ASSERT_NO_FATAL_FAILURE(
      simulate_trials(pressing(staircase,
                               "[measures.pressed]\nfield = \"floor\"\nlast = 0.5\n"
                               "within = [\"$target - 0.3\", 9.0]\n")));
  ASSERT_EQ(responses_.size(), rows_.levels.size());
  double highest = 0.0;
  for (std::size_t i = 0; i < responses_.size(); ++i) {
    const record::LevelRow& level = rows_.levels[i];
    EXPECT_EQ(level.outcome, responses_[i].value >= level.applied - 0.3 ? 1.0 : 0.0);
    highest = std::max(highest, level.applied);
  }
  EXPECT_NEAR(highest, 1.65, 0.16) << "the highest target whose tolerance holds 1.3 N, and a step";
}

/// A formula may take the value itself, and a session that goes on learns the same again.
TEST_F(SimulatedTrialsTest, AResumedSessionLearnsFromRecordedMeasures) {
  const std::string staircase =
      "[procedure]\nkind = \"staircase\"\nvariable = \"target\"\nrange = [0.5, 3.0]\n"
      "start = 1.0\nsteps = [0.1]\ndown = 1\nright_raises = true\n"
      "counts = \"$pressed > $target\"\nstop = { reversals = 4, trials = 30 }\n";
  ASSERT_NO_FATAL_FAILURE(
      simulate_trials(pressing(staircase, "[measures.pressed]\nfield = \"floor\"\n")));
  DefinedTrials again(studied(), place());
  std::size_t done = 0;
  for (auto trial = again.next(nullptr); trial; trial = again.next(&outcomes_[done - 1])) {
    again.make_pass(*trial, again.phases().front());
    Rows rows;
    again.close_pass(rows, 0);
    ASSERT_LT(done, rows_.levels.size());
    EXPECT_EQ(rows.levels.at(0).applied, rows_.levels[done].applied);
    ++done;
  }
  EXPECT_EQ(done, outcomes_.size());
}

/// What the stage requires of a measure is its value, which /stages has, too.
TEST_F(SimulatedTrialsTest, AStageRequiresAMeasureWithinBounds) {
  std::string text = pressing(kFourTrials, "[measures.pressed]\nfield = \"floor\"\n");
  const std::string until = "until = { time = 1.5 }";
  text.replace(text.find(until), until.size(),
               until +
                   "\nrequire = { measure = \"pressed\", at_least = 0.5, at_most = 1.2, "
                   "else = \"go on\" }");
  ASSERT_NO_FATAL_FAILURE(simulate_trials(text));
  int presses = 0;
  for (const record::StageRow& row : rows_.stages) {
    if (row.stage == "press") {
      const bool holds = row.most >= 0.5 && row.most <= 1.2;
      EXPECT_EQ(row.ending,
                holds ? record::StageEnding::kReached : record::StageEnding::kTooLittle);
      EXPECT_NEAR(row.most, responses_.at(static_cast<std::size_t>(row.pass)).value, 1e-12);
      ++presses;
    }
  }
  EXPECT_EQ(presses, 4);
}

TEST_F(SimulatedTrialsTest, AMeasureIsToldWithItsUnit) {
  ASSERT_NO_FATAL_FAILURE(
      simulate_trials(pressing(kFourTrials,
                               "[measures.pressed]\nfield = \"floor\"\nwithin = [1.0, 2.0]\n"
                               "feedback = \"always\"\ntext = \"You pressed with {}.\"\n")));
  ASSERT_TRUE(told_.results);
  const render::TextPage page = text_of(studied(), told_).page;
  EXPECT_EQ(page.title, studied().feedback_right);
  const double last = responses_.back().value;
  EXPECT_EQ(page.body, fmt::format("You pressed with {:.3g} N.", static_cast<float>(last)));
}

const char* const kTwoKeys =
    "choices = [{ value = \"yes\" }, { value = \"no\" }]\ntoo_fast = 0.5\ntoo_slow = 0.7\n";

TEST_F(SimulatedTrialsTest, AnswersOutOfTimeAreToldAndCount) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(test::felt_or_not(kTwoKeys)));
  std::size_t beyond = 0;
  for (const record::ResponseRow& row : responses_) {
    beyond += row.reaction_time < 0.5 || row.reaction_time > 0.7 ? 1 : 0;
  }
  EXPECT_EQ(responses_.size(), 12u);
  EXPECT_EQ(rows_.late.size(), beyond);
  EXPECT_GT(beyond, 0u) << "the median is 0.6 s and the spread 0.3";
  for (const record::OutOfTimeRow& row : rows_.late) {
    EXPECT_FALSE(row.again);
    EXPECT_EQ(row.limit, row.how == record::OutOfTime::kTooFast ? 0.5 : 0.7);
  }
  for (const record::LevelRow& row : rows_.levels) {
    EXPECT_TRUE(std::isfinite(row.outcome));
  }
}

TEST_F(SimulatedTrialsTest, TrialsOfAnswersOutOfTimeComeAgainUntilAllAreInTime) {
  ASSERT_NO_FATAL_FAILURE(
      simulate_trials(test::felt_or_not(std::string(kTwoKeys) + "out_of_time = \"repeat\"\n")));
  std::map<std::int32_t, bool> again;
  for (const record::OutOfTimeRow& row : rows_.late) {
    EXPECT_TRUE(row.again);
    again[row.pass] = true;
  }
  ASSERT_GT(again.size(), 0u);
  std::map<double, int> learnt;
  for (const record::LevelRow& row : rows_.levels) {
    EXPECT_EQ(std::isnan(row.outcome), again.contains(row.pass));
    learnt[row.applied] += std::isnan(row.outcome) ? 0 : 1;
  }
  EXPECT_EQ(learnt, (std::map<double, int>{{0.02, 6}, {1.0, 6}}));
  EXPECT_EQ(outcomes_.size(), 12u + again.size());
  // A resumed session goes the same way from what is recorded.
  DefinedTrials resumed(studied(), place());
  std::optional<PlannedTrial> trial = resumed.next(nullptr);
  for (const Outcome& outcome : outcomes_) {
    ASSERT_TRUE(trial);
    EXPECT_EQ(trial->stimulus_seed, outcome.trial.stimulus_seed);
    EXPECT_EQ(trial->trial, outcome.trial.trial);
    trial = resumed.next(&outcome);
  }
  EXPECT_FALSE(trial);
}

TEST_F(SimulatedTrialsTest, AnOutcomeThatIsTakenBackLeavesNoTrace) {
  ASSERT_NO_FATAL_FAILURE(
      simulate_trials(test::felt_or_not(std::string(kTwoKeys) + "out_of_time = \"repeat\"\n")));
  DefinedTrials trials(studied(), place());
  EXPECT_FALSE(trials.take_back()) << "there is nothing yet";
  std::optional<PlannedTrial> trial = trials.next(nullptr);
  for (const Outcome& outcome : outcomes_) {
    Outcome other = outcome;
    for (record::ResponseRow& response : other.responses) {
      response.correct = 1 - response.correct;
      response.value = 3.0 - response.value;
      response.reaction_time = 0.5;
    }
    trials.next(&other);
    trial = trials.take_back();
    ASSERT_TRUE(trial);
    EXPECT_EQ(trial->trial, outcome.trial.trial);
    EXPECT_EQ(trial->stimulus_seed, outcome.trial.stimulus_seed);
    trial = trials.next(&outcome);
  }
  EXPECT_FALSE(trial);
}

/// The size of the pull decides: yes where it is felt above the criterion.
TEST_F(SimulatedTrialsTest, QuestOfTwoDimensionsFindsTheCriterionOfTheParticipant) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(R"toml([experiment]
protocol = "trials"
name = "plane"
[design]
participants = 1
[fields.pull]
type = "constant"
force = ["$x", "-$y", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.4 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "quest_plus"
probability = "normcdf((sqrt($x ^ 2 + $y ^ 2) - $threshold) / $spread)"
counts = "$answer == 1"
stop = { trials = 60 }
[procedure.stimulus]
x = { from = 0.0, to = 2.0, count = 9, resolution = 0.1 }
y = { from = 0.0, to = 2.0, count = 9 }
[procedure.parameters]
threshold = { from = 0.2, to = 1.8, count = 33 }
spread = [0.05, 0.1, 0.2, 0.4]
[observer]
decides = "yes"
criterion = 0.8
force_floor = 0.1
force_weber = 0.05
lapse = 0.0
[observer.actions]
feel = { do = "hold" }
)toml"));
  const auto procedure = studied().tracks.front().begin(1, "track 1");
  const std::vector<record::LevelRow>& levels = rows_.levels;
  ASSERT_EQ(levels.size(), 120u) << "a row for each dimension";
  for (std::size_t i = 0; i < levels.size(); i += 2) {
    EXPECT_EQ(levels[i].variable, "x");
    EXPECT_EQ(levels[i + 1].variable, "y");
    EXPECT_EQ(procedure->next(), (psychometric::Level{levels[i].asked, levels[i + 1].asked}));
    procedure->report(levels[i].outcome, {levels[i].applied, levels[i + 1].applied});
  }
  const auto found = procedure->estimates();
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found.front().value, 0.8, 3.0 * *found.front().deviation);
  EXPECT_LT(*found.front().deviation, 0.1);
}

constexpr const char* kRoundACube = R"(
[experiment]
protocol = "trials"
name = "round_a_cube"
[design]
participants = 1
[objects.cube]
shape = "box"
size = [0.04, 0.04, 0.04]
centre = [0.0, -0.03, 0.0]
stiffness = 600.0
damping = 0.0
friction = { static = 0.3, dynamic = 0.2 }
fade_in = 0.0
record = true
[[stages]]
name = "explore"
fields = ["cube"]
until = { time = 6.0 }
[[blocks]]
name = "only"
trials = 1
[observer]
[observer.actions]
explore = { do = "follow", turn_after = 10.0 }
[texts]
instructions = "Go round it."
)";

TEST_F(SimulatedTrialsTest, ContactsWithAnObjectAreRecorded) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(kRoundACube));
  ASSERT_GT(rows_.contacts.size(), 3000u);
  bool left = false, under = false;
  for (const record::ContactRow& row : rows_.contacts) {
    // The proxy lies on the cube, the spring pulls the tool to it within the cone of friction.
    const Eigen::Vector3d p = row.proxy - Eigen::Vector3d(0.0, -0.03, 0.0);
    ASSERT_NEAR(p.cwiseAbs().maxCoeff(), 0.02, 1e-9);
    const double size = row.force.norm(), normal = 600.0 * row.depth;
    ASSERT_GE(size, normal * (1.0 - 1e-9) - 1e-12);
    ASSERT_LE(size, normal * std::hypot(1.0, 0.3) * (1.0 + 1e-9) + 1e-9);
    ASSERT_LT(row.work, 1e-4);
    left = left || p.x() < -0.0199;
    under = under || p.y() < -0.0199;
  }
  EXPECT_TRUE(left && under) << "it went round anticlockwise";
  EXPECT_LT(rows_.contacts.back().work, -1e-3) << "friction takes energy";
}

const std::string kElements = "young = 10000.0\npoisson = 0.45\n";
const std::string kSprings =
    "model = \"springs\"\nconstants = [6e-4, 2.4e-4, 1.2e-3]\ndensity = 1000.0\ndecay = 20.0\n";

/// A soft block that a hand presses in its middle with 1 N.
std::string soft_block(const std::string& ball, const std::string& tissue = kElements) {
  return R"([experiment]
protocol = "trials"
name = "press"
[design]
participants = 1
[objects.tissue]
kind = "deformable"
shape = "box"
size = [0.04, 0.02, 0.04]
cells = 8
felt = ["top"]
)" + tissue +
         R"(centre = [0.0, -0.01, 0.0]
turn = [0.0, 0.7, 0.0]
fade_in = 0.0
record = true
tool_radius = )" +
         ball + R"(
[[stages]]
name = "palpate"
fields = ["tissue"]
show = ["hand", "tissue"]
until = { time = 2.0 }
[[blocks]]
name = "only"
trials = 1
[observer]
[observer.actions]
palpate = { do = "palpate", at = [[0.0, 0.005, 0.0]], force = 1.0, move = 0.2, press = 1.5 }
[display]
seen_from = "front"
[texts]
instructions = "Press."
)";
}

/// A replay has the hands and the stages, and finds what pressed the body on each tick.
class ReplayedBodyTest : public SimulatedTrialsTest,
                         public testing::WithParamInterface<std::string> {};
INSTANTIATE_TEST_SUITE_P(Models, ReplayedBodyTest,
                         testing::Values(kElements, kSprings, kSprings + "rate = 250.0\n"));

TEST_P(ReplayedBodyTest, WhatPressedABodyFollowsFromTheHandsAndTheStages) {
  Table root = Table::parse(soft_block("0.006", GetParam()), "study.toml");
  definition_ = trials_protocol().read(root, "study.toml", nullptr);
  DefinedTrials live(studied(), place());
  DefinedTrials recorded(studied(), place());
  for (DefinedTrials* trials : {&live, &recorded}) {
    auto trial = trials->next(nullptr);
    trials->make_pass(*trial, trials->phases().front());
  }
  live.pass().begin(100);
  int pressed = 0;
  for (int tick = 0; live.pass().state() == PassState::kRunning; ++tick) {
    device::DeviceReading reading;
    const double time = 1e-3 * tick;
    reading.tool.position = {0.004 * std::sin(3.0 * time), 0.008 - 0.006 * std::sin(2.0 * time),
                             0.0};
    reading.tool.velocity = {0.012 * std::cos(3.0 * time), -0.012 * std::cos(2.0 * time), 0.0};
    const PassOutput out = live.pass().tick(Readings(reading), 1e-3);
    const auto* view = out.shown.as<TrialView>();
    ASSERT_NE(view, nullptr);
    if (view->interval == 0) {
      break;
    }
    if (tick == 0) {
      recorded.pass().enter_again(0, 0);
    }
    const SeenForces& again = recorded.pass().feel_again(std::array{reading.tool});
    const auto then = view->pressed.on(0);
    const auto now = again.on(0);
    ASSERT_EQ(now.size(), then.size()) << tick;
    for (std::size_t i = 0; i < then.size(); ++i) {
      ASSERT_EQ(now[i].vertex, then[i].vertex) << tick;
      ASSERT_EQ(now[i].newtons, then[i].newtons) << tick;
    }
    pressed += !then.empty();
  }
  EXPECT_GT(pressed, 500);
}

/// The force that the screen shows on the body is the one on the hand, turned around.
TEST_F(SimulatedTrialsTest, WhatIsSeenToPressABodyIsWhatIsFelt) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(soft_block("0.006")));
  ASSERT_GT(presses_.all.size(), 500u);
  ASSERT_GE(presses_.all.size() + 1, rows_.contacts.size()) << "nothing is seen on the last tick";
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()));
  for (std::size_t i = 0; i < presses_.all.size(); ++i) {
    const Eigen::Vector3d felt = rows_.contacts[i].force;
    ASSERT_LT((turn * presses_.all[i].on_body + felt).norm(), 1e-5 * felt.norm() + 1e-9) << i;
    ASSERT_GE(presses_.all[i].body, 0);
  }
  ASSERT_EQ(rows_.touched.size(), 1u);
  EXPECT_EQ(rows_.touched[0].object, "tissue");
  EXPECT_EQ(rows_.touched[0].contact, rows_.contacts.size());
  EXPECT_EQ(rows_.touched[0].inverted, 0u);
  EXPECT_EQ(rows_.events.count("inside_out"), 0u);
  EXPECT_THAT(notices_,
              testing::Not(testing::Contains(testing::HasSubstr("deeper than its elements"))));
}

/// A hand that holds still while a path draws it through a plate lets the force rise and hardly
/// moves: that is no frozen reading.
TEST_F(SimulatedTrialsTest, AHandThatIsDrawnThroughAPlateIsNoFrozenReading) {
  for (const char* stiffness : {"800.0", "3000.0"}) {
    outcomes_.clear();
    ASSERT_NO_FATAL_FAILURE(simulate_trials(std::string(R"([experiment]
protocol = "trials"
name = "through_a_plate"
[design]
participants = 1
[fields.plate]
type = "box"
centre = [0.0, 0.0, 0.0]
size = [0.06, 0.004, 0.06]
damping = 1.0
limit = 6.0
stiffness = )") + stiffness + R"(
[fields.lead]
type = "path"
points = [[0.0, 0.02, 0.0], [0.0, -0.02, 0.0]]
duration = 4.0
stiffness = 400.0
damping = 10.0
limit = 6.0
[[stages]]
name = "press"
fields = ["plate", "lead"]
until = { time = 5.0 }
[[blocks]]
name = "all"
trials = 2
[observer]
[observer.actions]
press = { do = "hold" }
)")) << stiffness;
    EXPECT_EQ(outcomes_.size(), 2u);
  }
}

TEST_F(SimulatedTrialsTest, ABodyOfSpringsIsPressedAndSaysHowItMoved) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(soft_block("0.006", kSprings)));
  ASSERT_GT(presses_.all.size(), 500u);
  double most = 0.0;
  for (const record::ContactRow& row : rows_.contacts) {
    most = std::max(most, row.force.norm());
  }
  EXPECT_NEAR(most, 1.0, 0.3) << "the hand presses with 1 N";
  ASSERT_EQ(rows_.touched.size(), 1u);
  EXPECT_EQ(rows_.touched[0].contact, rows_.contacts.size());
  ASSERT_EQ(rows_.moving.size(), 1u);
  EXPECT_EQ(rows_.moving[0].object, "tissue");
  EXPECT_GT(rows_.moving[0].steps, 1);
  EXPECT_EQ(rows_.moving[0].flown_apart, 0u);
  EXPECT_EQ(rows_.events.count("flown_apart"), 0u);
  EXPECT_EQ(rows_.events.count("energy_limit"), rows_.moving[0].limited > 0 ? 1u : 0u);
}

/// A hand that goes deeper than a soft body of elements can follow.
TEST_F(SimulatedTrialsTest, ABodyThatFliesApartEndsThePassAndTheForceStaysForItsEnd) {
  const std::string soft =
      "model = \"implicit\"\nyoung = 20000.0\npoisson = 0.4\ndensity = 1000.0\n";
  Table root = Table::parse(soft_block("0.005", soft), "study.toml");
  definition_ = trials_protocol().read(root, "study.toml", nullptr);
  DefinedTrials trials(studied(), place());
  auto trial = trials.next(nullptr);
  Pass& pass = trials.make_pass(*trial, trials.phases().front());
  pass.begin(0);
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int tick = 0; pass.state() == PassState::kRunning; ++tick) {
    device::DeviceReading reading;
    reading.tool.position = {0.001, 0.006 - 1e-4 * tick, 0.0};
    reading.tool.velocity = {0.0, -0.1, 0.0};
    const PassOutput out = pass.tick(Readings(reading), 1e-3);
    ASSERT_LT((out.force - before).norm(), 5000.0 * 1e-4 + 0.5 + 1e-9) << tick;
    before = out.force;
    ASSERT_LT(tick, 500);
  }
  EXPECT_EQ(pass.state(), PassState::kAborted);
  EXPECT_GT(before.norm(), 0.5) << "what the end of the pass takes off";
  EXPECT_THAT(trials.why_aborted(), testing::HasSubstr("flew apart"));
}

TEST_F(SimulatedTrialsTest, WhatWouldTurnATetrahedronInsideOutIsTold) {
  ASSERT_NO_FATAL_FAILURE(simulate_trials(soft_block("0.0025")));
  ASSERT_EQ(rows_.touched.size(), 1u);
  EXPECT_GT(rows_.touched[0].inverted, 0u);
  EXPECT_LE(rows_.touched[0].inverted, rows_.touched[0].contact);
  EXPECT_THAT(
      rows_.events["inside_out"],
      testing::HasSubstr("trial 1: tissue: on " + std::to_string(rows_.touched[0].inverted) +
                         " ticks the hand pressed"));
  EXPECT_THAT(notices_, testing::Contains(testing::HasSubstr("in 1 pass of /touched_bodies: on ")));
}

}  // namespace
}  // namespace haptrial::protocols
