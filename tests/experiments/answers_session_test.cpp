// Answers by hand through whole sessions: a virtual participant goes to a place or presses the
// pedal, answers out of time come again, QUEST+ of two dimensions finds what it feels.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "analysis/trials/data/read_trials.h"
#include "core/psychometric/procedure/procedure.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/trials/trial_rows.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "protocols/trials/definition/trials_definition.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using record::ResponseSource;

/// A pull to the right that is felt or not. @param choices  of the response, and what else it has
std::string felt_or_not(const std::string& response, const std::string& more = "") {
  return R"([experiment]
protocol = "trials"
name = "felt"
[design]
participants = 1
[fields.pull]
type = "constant"
force = ["$level", 0.0, 0.0]
[fields.home]
type = "minimum_jerk"
to = [0.0, 0.0, 0.0]
duration = 0.4
stiffness = 300.0
damping = 20.0
[regions.left]
type = "sphere"
centre = [-0.03, 0.0, 0.0]
radius = 0.01
[regions.right]
type = "box"
centre = [0.03, 0.0, 0.0]
size = [0.02, 0.02, 0.02]
[[stages]]
name = "home"
fields = ["home"]
until = { time = 0.6 }
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.4 }
[procedure]
kind = "constant"
variable = "level"
levels = [0.02, 1.0]
repetitions = 6
counts = "$answer == 1"
[observer]
decides = "yes"
in_stage = "feel"
criterion = 0.4
force_floor = 0.02
[observer.actions]
feel = { do = "hold" }
[response]
question = "Did it pull?"
)" + response +
         more;
}

class AnswersSessionTest : public testing::Test {
 protected:
  std::unique_ptr<record::SessionReader> run(const std::string& text) {
    test::write_text(folder_ / "study.toml", text);
    experiment_ = load_experiment(folder_ / "study.toml");
    SessionRequest request;
    request.protocol = &experiment_.study->protocol();
    request.definition = experiment_.definition.get();
    request.subject = "S01";
    request.seed = 7;
    request.file = file();
    const SessionSummary summary = run_session(request);
    EXPECT_EQ(summary.aborted_passes, 0);
    auto reader = std::make_unique<record::SessionReader>(file());
    EXPECT_TRUE(record::check_session(*reader, known_tables()).ok);
    return reader;
  }
  std::filesystem::path file() const { return folder_ / "S01.h5"; }
  test::TemporaryFolder folder_;
  Experiment experiment_;
};

TEST_F(AnswersSessionTest, AVirtualHandGoesToThePlaceOfItsAnswer) {
  const auto file =
      run(felt_or_not("choices = [{ value = \"yes\", touch = \"right\" }, { value = \"no\", touch "
                      "= \"left\" }]\n"));
  const auto responses = file->responses();
  ASSERT_EQ(responses.size(), 12u);
  std::map<std::string, int> given;
  for (const record::ResponseRow& row : responses) {
    ++given[row.text];
    EXPECT_EQ(row.source, ResponseSource::kPlace);
    EXPECT_EQ(row.code, row.text == "yes" ? 1 : 0) << "left is the first region by name";
    // The tick on which the tip came in, by the samples themselves.
    const auto inside = [&](std::uint64_t tick) {
      const Eigen::Vector3d p = file->samples(tick, 1).front().position;
      return row.text == "yes" ? (p - Eigen::Vector3d(0.03, 0.0, 0.0)).cwiseAbs().maxCoeff() <= 0.01
                               : (p - Eigen::Vector3d(-0.03, 0.0, 0.0)).norm() <= 0.01;
    };
    EXPECT_TRUE(inside(row.sequence));
    EXPECT_FALSE(inside(row.sequence - 1));
    EXPECT_TRUE(inside(row.sequence + 200));
  }
  EXPECT_EQ(given["yes"], 6);
  EXPECT_EQ(given["no"], 6);
  // The reaction counts from the end of the last stage, in ticks.
  std::map<std::int32_t, std::uint64_t> asked;
  for (const record::StageRow& stage : file->rows<record::StageRow>()) {
    asked[stage.pass] = stage.last_sample + 1;
  }
  for (const record::ResponseRow& row : responses) {
    const auto ticks = static_cast<double>(row.sequence - asked.at(row.pass) + 1);
    EXPECT_NEAR(row.reaction_time, ticks / 1000.0, 1e-9);
  }
}

TEST_F(AnswersSessionTest, AVirtualParticipantPressesThePedal) {
  const auto file = run(felt_or_not(
      "choices = [{ value = \"yes\", pedal = 0.5 }, { value = \"no\", buttons = [0] }]\n"));
  int pedal = 0;
  for (const record::ResponseRow& row : file->responses()) {
    EXPECT_EQ(row.source == ResponseSource::kPedal, row.text == "yes");
    pedal += row.source == ResponseSource::kPedal ? 1 : 0;
    EXPECT_GT(row.reaction_time, 0.1);
  }
  EXPECT_EQ(pedal, 6);
}

const char* const kTwoKeys =
    "choices = [{ value = \"yes\" }, { value = \"no\" }]\ntoo_fast = 0.4\ntoo_slow = 0.8\n";

TEST_F(AnswersSessionTest, AnswersOutOfTimeAreToldAndCount) {
  const auto file = run(felt_or_not(kTwoKeys));
  const auto late = file->rows<record::OutOfTimeRow>();
  ASSERT_GT(late.size(), 0u) << "the median is 0.6 s and the spread 0.3";
  std::size_t beyond = 0;
  for (const record::ResponseRow& row : file->responses()) {
    beyond += row.reaction_time < 0.4 || row.reaction_time > 0.8 ? 1 : 0;
  }
  EXPECT_EQ(file->responses().size(), 12u);
  EXPECT_EQ(late.size(), beyond);
  for (const record::OutOfTimeRow& row : late) {
    EXPECT_FALSE(row.again);
    EXPECT_EQ(row.limit, row.how == record::OutOfTime::kTooFast ? 0.4 : 0.8);
  }
  for (const record::LevelRow& row : file->rows<record::LevelRow>()) {
    EXPECT_TRUE(std::isfinite(row.outcome));
  }
}

TEST_F(AnswersSessionTest, TrialsOfAnswersOutOfTimeComeAgainUntilAllAreInTime) {
  const auto file = run(felt_or_not(kTwoKeys, "out_of_time = \"repeat\"\n"));
  std::map<std::int32_t, bool> again;
  for (const record::OutOfTimeRow& row : file->rows<record::OutOfTimeRow>()) {
    EXPECT_TRUE(row.again);
    again[row.pass] = true;
  }
  ASSERT_GT(again.size(), 0u);
  std::map<double, int> learnt;
  for (const record::LevelRow& row : file->rows<record::LevelRow>()) {
    EXPECT_EQ(std::isnan(row.outcome), again.contains(row.pass));
    learnt[row.applied] += std::isnan(row.outcome) ? 0 : 1;
  }
  EXPECT_EQ(learnt, (std::map<double, int>{{0.02, 6}, {1.0, 6}}));
  EXPECT_EQ(file->passes().size(), 12u + again.size());
  int counted = 0;
  for (const auto& trial : analysis::trials::read_trials({this->file()}, nullptr, 1).trials) {
    counted += trial.counts() ? 1 : 0;
  }
  EXPECT_EQ(counted, 12) << "the analysis takes each level as often as it was planned";
  // A replay goes the way from recorded answers to the last trial; other values would be refused.
  protocols::ReplayRequest request;
  request.file = this->file();
  request.trial = static_cast<int>(file->passes().size());
  request.fps = 5;
  request.pictures = true;
  request.picture = [](const render::Image&) {};
  request.progress = [](double, double, const std::string&, double) {};
  request.tell = [](const std::string&) {};
  EXPECT_NO_THROW(experiment_.study->protocol().replay(request));
}

/// What is pulled by is felt as a whole: yes where its size is above the criterion.
TEST_F(AnswersSessionTest, QuestOfTwoDimensionsFindsTheCriterionOfTheParticipant) {
  const auto file = run(R"toml([experiment]
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
)toml");
  const auto& d = dynamic_cast<const protocols::TrialsDefinition&>(*experiment_.definition);
  const auto procedure = d.tracks.front().begin(1, "track 1");
  const auto levels = file->rows<record::LevelRow>();
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

}  // namespace
}  // namespace haptrial::experiments
