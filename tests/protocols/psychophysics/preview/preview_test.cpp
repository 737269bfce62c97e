// A preview says of an experiment what a session does: stages in their order, forces to the
// bit, trials counted.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/record/rows/trial_rows.h"
#include "core/scene/scene.h"
#include "protocols/definition/lab_file.h"
#include "protocols/interface/session_file.h"
#include "protocols/interface/session_task.h"
#include "protocols/psychophysics/defined_trials.h"
#include "protocols/psychophysics/preview/felt_forces.h"
#include "protocols/psychophysics/preview/planned_trials.h"
#include "protocols/psychophysics/preview/previewed_trial.h"
#include "protocols/psychophysics/preview/seen_stages.h"
#include "protocols/psychophysics/subject/trials_rig.h"
#include "protocols/psychophysics/trials_protocol.h"

namespace haptrial::protocols {
namespace previews {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;

namespace fs = std::filesystem;

fs::path shipped(const std::string& name) {
  return fs::path(HAPTRIAL_SOURCE_DIR) / "experiments" / (name + ".toml");
}

/// A shipped definition, ready for sessions.
std::unique_ptr<Definition> load_shipped(const std::string& name) {
  const fs::path file = shipped(name);
  const fs::path folder = file.parent_path();
  Table root = load_with_lab(file, {});
  root.leave("analysis");
  auto definition = trials_protocol().read(root, file.string(), &folder);
  root.finish();
  trials_protocol().load(*definition, folder);
  return definition;
}

const StudiedDefinition& studied(const Definition& definition) {
  return dynamic_cast<const StudiedDefinition&>(definition);
}

SessionPlace first_session() {
  SessionPlace place;
  place.subject = "S01";
  place.seed = 1;
  give_seeds(place);
  return place;
}

/// Every shipped definition of this protocol.
std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments")) {
    const fs::path& file = entry.path();
    if (file.extension() == ".toml" && file.stem().extension().empty()) {
      Table root = Table::load(file);
      Table experiment = root.table("experiment");
      if (experiment.whole_text("protocol") == std::string("trials")) {
        names.push_back(file.stem().string());
      }
    }
  }
  std::ranges::sort(names);
  return names;
}

/// Keeps the stages that a session records.
class StageRows final : public SessionFile {
 public:
  std::vector<record::StageRow> rows;

  void keep_stimulus(std::int32_t, std::span<const record::StimulusRow>) override {}
  bool holds_stimulus(std::int32_t) const override { return true; }
  void event(const std::string&, const std::string&) override {}
  const std::vector<record::PassRow>& earlier_passes() const override { return none_; }
  bool was_cut_short(const PlannedTrial&) const override { return false; }

 protected:
  void put(const record::Rows& batch) override {
    const auto taken = batch.as<record::StageRow>();
    rows.insert(rows.end(), taken.begin(), taken.end());
  }

 private:
  std::vector<record::PassRow> none_;
};

/// The stages of the first trial of the first participant, as its session records them.
std::vector<record::StageRow> rehearsed_stages(const StudiedDefinition& d) {
  DefinedTrials trials(d, first_session());
  const std::unique_ptr<Rig> rig = trials.virtual_rig();
  SessionTask::Log log(64, 2);  // nobody reads it
  SessionTask::DeviceLog others(64, 2);
  SessionTask task({.devices = rig->arms(d.envelope),
                    .log = log,
                    .device_log = &others,
                    .observers = {rig->subject()}},
                   SessionTask::Leave::kNever);
  auto trial = trials.next(nullptr);
  task.start(trials.make_pass(*trial, trials.phases().front()), 0);
  const double dt = 1.0 / d.rate;
  for (std::uint64_t i = 0; !task.idle() && i < 120'000; ++i) {
    task.tick({i, std::llround(static_cast<double>(i) * 1e9 * dt), dt});
    rig->attend();
  }
  StageRows rows;
  trials.close_pass(rows, 0);
  return rows.rows;
}

class ShippedPreviewTest : public testing::TestWithParam<std::string> {};

TEST_P(ShippedPreviewTest, TheTimelineIsThatOfARehearsedTrial) {
  const auto definition = load_shipped(GetParam());
  const StudiedDefinition& d = studied(*definition);
  const PreviewedTrial trial = previewed_trial(d, first_session(), 1);
  const std::vector<record::StageRow> rows = rehearsed_stages(d);
  std::size_t row = 0;
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    for (const PreviewedStage& stage : trial.intervals[i].stages) {
      ASSERT_LT(row, rows.size()) << stage.name;
      EXPECT_EQ(stage.name, rows[row].stage);
      EXPECT_EQ(static_cast<std::int32_t>(i + 1), rows[row].interval);
      const double lasted =
          static_cast<double>(rows[row].last_sample - rows[row].first_sample + 1) / d.rate;
      if (stage.fixed) {
        EXPECT_NEAR(stage.shortest, lasted, 1.5 / d.rate) << stage.name;
        EXPECT_EQ(stage.shortest, stage.longest);
      } else {
        EXPECT_GE(lasted, stage.shortest - 1e-9) << stage.name;
        EXPECT_LE(lasted, stage.longest + 1.0 / d.rate) << stage.name;
      }
      ++row;
    }
  }
  EXPECT_EQ(row, rows.size());
}

TEST_P(ShippedPreviewTest, ForcesAreThoseOfASceneToTheBit) {
  const auto definition = load_shipped(GetParam());
  const StudiedDefinition& d = studied(*definition);
  const std::vector<FeltStage> stages = felt_stages(d, previewed_trial(d, first_session(), 1));
  ASSERT_FALSE(stages.empty());
  for (const FeltStage& stage : stages) {
    std::vector<scene::Field> fields = stage.felt.fields;
    for (scene::Field& field : fields) {
      field.fade_in = 0.0;
    }
    for (const ForceLine& line : stage.lines) {
      const auto start =
          static_cast<std::ptrdiff_t>(std::ranges::find(line.offsets, 0.0) - line.offsets.begin());
      const auto count = static_cast<std::ptrdiff_t>(line.offsets.size());
      ASSERT_LT(start, count);
      for (const std::ptrdiff_t way : {-1, 1}) {
        scene::Scene scene(fields, d.rate);
        scene.switch_to(stage.felt.mask);
        for (std::ptrdiff_t i = start; i >= 0 && i < count; i += way) {
          const auto at = static_cast<std::size_t>(i);
          const Vector3d p = stage.origin + line.offsets[at] * Vector3d::Unit(line.axis);
          ASSERT_EQ(scene.force({p, Vector3d::Zero()}), line.forces[at]);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, ShippedPreviewTest, testing::ValuesIn(shipped_names()),
                         [](const auto& each) { return each.param; });

TEST(PreviewTest, AWallPushesByItsLaw) {
  const auto definition = load_shipped("stiffness_discrimination");
  const StudiedDefinition& d = studied(*definition);
  const PreviewedTrial trial = previewed_trial(d, first_session(), 1);
  const std::vector<FeltStage> stages = felt_stages(d, trial);
  // Both intervals begin with the same guide; their floors differ.
  ASSERT_EQ(3u, stages.size());
  EXPECT_EQ(2u, stages[0].where.size());
  EXPECT_EQ(Vector3d(0.0, 0.02, 0.0), stages[0].origin);
  for (const FeltStage& stage : {stages[1], stages[2]}) {
    const bool reference = trial.intervals[stage.where[0].interval].name == "reference";
    const double k = reference ? 300.0 : 550.0;  // a trial of practice
    const ForceLine& along = stage.lines[1];
    for (std::size_t i = 0; i < along.offsets.size(); ++i) {
      const double depth = -(0.02 + along.offsets[i]);
      EXPECT_NEAR(std::min(8.0, k * std::max(0.0, depth)), along.forces[i].y(), 1e-9);
      EXPECT_EQ(0.0, along.forces[i].x());
    }
    EXPECT_GT(along.forces.front().y(), 7.9) << "the line reaches the limit of the force";
    ASSERT_EQ(1u, stage.fields.size());
    EXPECT_EQ("wall", stage.fields[0].type);
    EXPECT_EQ(k, stage.fields[0].stiffness);
  }
}

TEST(PreviewTest, LinesAndPlaneGoWhereTheyAreAskedFor) {
  const auto definition = load_shipped("stiffness_discrimination");
  const StudiedDefinition& d = studied(*definition);
  const PreviewedTrial trial = previewed_trial(d, first_session(), 1);
  const Vector3d through(0.01, -0.005, 0.0);
  const std::vector<FeltStage> stages = felt_stages(d, trial, {through, std::array<int, 2>{1, 2}});
  ASSERT_FALSE(stages.empty());
  for (const FeltStage& stage : stages) {
    EXPECT_EQ(through, stage.origin);
    EXPECT_EQ(1, stage.plane.across);
    EXPECT_EQ(2, stage.plane.up);
    for (const Vector3d& place : stage.plane.places) {
      ASSERT_EQ(through.x(), place.x());
    }
  }
}

TEST(PreviewTest, ACurlFieldPushesAcrossTheVelocity) {
  const auto definition = load_shipped("curl_field");
  const StudiedDefinition& d = studied(*definition);
  PreviewedTrial trial = previewed_trial(d, first_session(), 65);
  while (!trial.next.values.probe.empty()) {  // a catch trial has no field
    trial = previewed_trial(d, first_session(), trial.number + 1);
  }
  ASSERT_EQ("adaptation", trial.next.plan.block_name);
  double b = 0.0;
  for (const auto& [name, value] : trial.values) {
    b = name == "b" ? std::stod(value) : b;
  }
  ASSERT_EQ(13.0, std::abs(b));
  bool found = false;
  for (const FeltStage& stage : felt_stages(d, trial)) {
    if (trial.intervals[0].stages[stage.where[0].stage].name != "reach") {
      continue;
    }
    found = true;
    const SpeedCurve& along = stage.speeds[0];
    for (std::size_t i = 0; i < along.speeds.size(); ++i) {
      EXPECT_NEAR(-b * along.speeds[i], along.forces[i].z(), 1e-6);
    }
  }
  EXPECT_TRUE(found);
}

TEST(PreviewTest, ATrialBeyondTheSessionGetsASentence) {
  const auto definition = load_shipped("stiffness_discrimination");
  for (const int number : {0, 125, -3}) {
    try {
      previewed_trial(studied(*definition), first_session(), number);
      FAIL() << number;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("allowed: 1 to 124"));
    }
  }
}

TEST(PreviewTest, TrialsAreCountedAsTheDefinitionStatesThem) {
  const auto definition = load_shipped("curl_field");
  const PlannedTrials planned = planned_trials(studied(*definition), 1, 100);
  EXPECT_EQ(16, planned.participants);
  ASSERT_EQ(2u, planned.groups.size());
  EXPECT_EQ(8, planned.groups[0].count);
  int trials = 0, clamps = 0, catches = 0;
  for (const PlannedCount& count : planned.counts) {
    trials += count.all;
    clamps += count.probe == "clamp" ? count.all : 0;
    catches += count.probe == "catch" ? count.all : 0;
    EXPECT_TRUE(count.participants == 8 || !count.probe.empty()) << "of the group";
    EXPECT_EQ(count.participants < 8, count.fewest == 0);
  }
  EXPECT_EQ(16 * 320, trials);
  EXPECT_EQ(16 * 8, clamps);
  EXPECT_EQ(16 * 24, catches);
  ASSERT_EQ(1u, planned.block_orders.size());
  EXPECT_EQ("baseline, adaptation, washout", planned.block_orders[0].order);
}

TEST(PreviewTest, AProcedureIsCountedByItsMost) {
  const auto definition = load_shipped("stiffness_discrimination");
  const PlannedTrials planned = planned_trials(studied(*definition), 1, 100);
  int most = 0;
  for (const PlannedCount& count : planned.counts) {
    most += count.open ? count.most : 0;
    EXPECT_EQ(12, count.participants);
  }
  EXPECT_EQ(studied(*definition).most_trials(), most);
}

TEST(PreviewTest, WhatIsSeenDiffersWhereStagesShowSomethingElse) {
  const auto definition = load_shipped("stiffness_discrimination");
  const StudiedDefinition& d = studied(*definition);
  const auto seen = seen_stages(d, previewed_trial(d, first_session(), 1), 640);
  // The start; the numbers of both intervals; the gap; the question.
  ASSERT_EQ(5u, seen.size());
  EXPECT_EQ(2u, seen[0].where.size());
  EXPECT_EQ(0, seen.back().question);
  EXPECT_EQ(640, seen[0].picture.width);
  const std::vector<std::uint8_t>& gap = seen[2].picture.rgb;
  EXPECT_EQ(1u, std::set<std::uint8_t>(gap.begin(), gap.begin() + 1).size());
}

TEST(PreviewTest, AStageSaysHowItEnds) {
  const auto definition = load_shipped("stiffness_discrimination");
  const PreviewedTrial trial = previewed_trial(studied(*definition), first_session(), 1);
  const std::vector<PreviewedStage>& stages = trial.intervals[0].stages;
  ASSERT_EQ(3u, stages.size());
  EXPECT_EQ("when the hand is inside start for 0.3 s", stages[0].ends);
  EXPECT_EQ("after 5 s the trial is aborted", stages[0].late);
  EXPECT_EQ("after 2.5 s", stages[1].ends);
  EXPECT_EQ("depth of floor at least 0.003 m, else the interval begins again",
            stages[1].requirement);
  EXPECT_THAT(stages[0].fields, ElementsAre("guide"));
}

}  // namespace previews
}  // namespace haptrial::protocols
