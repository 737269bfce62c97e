// Figures of a session's drillings while they run, held against the analysis of its file.

#include "experiments/studies/drilling/live_drilling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/session_reader.h"
#include "experiments/console/console_messages.h"
#include "experiments/control/session_controller.h"
#include "experiments/runner/session.h"
#include "experiments/studies/drilling/bone_study.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/analysis/bone_drilling/session_of_drillings.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace drilling = analysis::drilling;
using testing::HasSubstr;

/// The same figures by the analysis of a procedure.
drilling::LiveFigures figures_of(const drilling::Procedure& procedure) {
  drilling::StudyBones bones;
  const drilling::ProcedureSummary s = drilling::summarize(procedure, {}, bones);
  drilling::LiveFigures f;
  f.time = s.usage.time;
  f.drilling = s.usage.drilling;
  f.removed = s.usage.removed;
  f.voxels = s.visibility.visible.size();
  f.visible_share = s.visibility.share();
  f.injured_voxels = static_cast<std::uint64_t>(s.value("injured_voxels").value_or(0.0));
  f.injuries = s.injuries;
  f.mean_force = s.usage.mean_force;
  f.achieved = s.achieved;
  return f;
}

drilling::ProcedureSetup hand_made_setup() {
  drilling::ProcedureSetup setup;
  setup.scale = 2.0;
  setup.tools = {{"large", 2e-3}, {"small", 1e-3}};
  setup.pose_WB = [](const geometry::VoxelGrid&) { return Eigen::Isometry3d::Identity(); };
  return setup;
}

template <class Row>
std::span<const Row> piece(const std::vector<Row>& rows, std::uint64_t first, std::uint64_t end) {
  const auto before = [](const Row& row, std::uint64_t n) { return row.sequence < n; };
  const auto low = std::lower_bound(rows.begin(), rows.end(), first, before);
  return {low, std::lower_bound(low, rows.end(), end, before)};
}

/// Gives rows as the logs are emptied: other rows are up to some ticks ahead of the samples.
void give(LiveDrilling& live, const test::DrillingRows& rows, std::uint64_t slice,
          std::uint64_t ahead) {
  const std::uint64_t end = rows.samples.back().sequence + 1;
  std::uint64_t given = rows.samples.front().sequence;
  for (std::uint64_t at = given; at < end; at += slice) {
    const std::uint64_t to = std::min(at + slice + ahead, end);
    live.add(piece(rows.tool, given, to));
    live.add(piece(rows.removals, given, to));
    live.add(piece(rows.camera, given, to));
    live.add(piece(rows.splits, given, to));
    live.add(piece(rows.samples, at, at + slice));
    given = to;
  }
}

record::PassRow pass_of(int trial, int repetition, bool practice = false) {
  record::PassRow pass;
  pass.trial = trial;
  pass.repetition = repetition;
  pass.practice = practice;
  pass.phase = record::kDrillingPhase;
  return pass;
}

/// Ticks on which no bone is simulated; a file holds every tick.
test::DrillingRows idle_ticks(std::uint64_t first, std::uint64_t end) {
  test::DrillingRows rows;
  for (std::uint64_t n = first; n < end; ++n) {
    rows.samples.emplace_back().sequence = n;
    rows.tool.emplace_back().sequence = n;
  }
  return rows;
}

/// The procedure of these rows, without a file between.
drilling::Procedure procedure_of(const std::vector<const test::DrillingRows*>& passes,
                                 const std::shared_ptr<const bone::BoneModel>& bone) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "rows.h5";
  {
    record::SessionWriter writer(file, test::drilling_info(), record::drilling_tables(),
                                 record::rows_of(std::vector{test::block_record(0)}));
    record::PassRow pass = pass_of(1, 1);
    pass.condition = "drilling";
    for (const test::DrillingRows* rows : passes) {
      test::write_pass(writer, *rows, pass, 0);
    }
    writer.set_timing({}, {0, 0, 0});
    writer.close();
  }
  drilling::Procedure procedure =
      drilling::load_procedures(record::SessionReader(file), hand_made_setup()).front();
  procedure.bone = bone;
  return procedure;
}

TEST(LiveDrillingTest, PiecesOfRowsInAnyCutGiveTheFiguresOfTheWhole) {
  const auto bone = std::make_shared<const bone::BoneModel>(bone::bone_of(test::block_record(0)));
  RandomStream random(4, "pieces");
  std::vector<bool> gone;
  const auto practice = test::wander(0, 300, 0, random, gone);
  gone.clear();
  const auto first = test::wander(300, 700, 1, random, gone);
  const auto second = test::wander(1000, 900, 2, random, gone);
  const auto before = idle_ticks(0, 300);
  const drilling::LiveFigures expected = figures_of(procedure_of({&before, &first, &second}, bone));
  ASSERT_GT(expected.voxels, 20u);
  for (const auto& [slice, ahead] : {std::pair{1, 0}, {13, 5}, {400, 90}}) {
    LiveDrilling live(hand_made_setup(), 1000.0);
    EXPECT_FALSE(live.now());
    live.begin(pass_of(0, 1, true), bone);
    give(live, practice, slice, ahead);
    live.begin(pass_of(1, 1), bone);
    give(live, first, slice, ahead);
    live.begin(pass_of(1, 1), bone);  // was broken off and goes on
    give(live, second, slice, ahead);
    live.finish();
    ASSERT_TRUE(live.now());
    EXPECT_EQ(live.now()->figures, expected) << slice;
    ASSERT_EQ(live.procedures().size(), 1u) << "practice is none";
    EXPECT_EQ(live.procedures()[0].trial, 1);
    EXPECT_EQ(live.trouble(), "");
  }
}

TEST(LiveDrillingTest, WhatAnEarlierRunDidToTheBoneCounts) {
  const auto bone = std::make_shared<const bone::BoneModel>(bone::bone_of(test::block_record(0)));
  RandomStream random(7, "earlier");
  std::vector<bool> gone;
  const auto first = test::wander(0, 700, 0, random, gone);
  const auto second = test::wander(900, 500, 1, random, gone);
  const auto earlier = std::make_shared<const drilling::Procedure>(procedure_of({&first}, bone));
  LiveDrilling live(hand_made_setup(), 1000.0);
  live.begin(pass_of(1, 1), bone, earlier);
  give(live, second, 50, 7);
  live.finish();
  const auto between = idle_ticks(700, 900);
  EXPECT_EQ(live.now()->figures, figures_of(procedure_of({&first, &between, &second}, bone)));
}

TEST(LiveDrillingTest, OfATrialThatWasBegunAnewTheLastBoneCounts) {
  const auto bone = std::make_shared<const bone::BoneModel>(bone::bone_of(test::block_record(0)));
  RandomStream random(5, "anew");
  std::vector<bool> gone;
  const auto first = test::wander(0, 500, 0, random, gone);
  gone.clear();
  const auto anew = test::wander(500, 600, 1, random, gone);
  gone.clear();
  const auto next = test::wander(1100, 200, 2, random, gone);
  LiveDrilling live(hand_made_setup(), 1000.0);
  live.begin(pass_of(1, 1), bone);
  give(live, first, 100, 0);
  live.begin(pass_of(1, 2), bone);
  give(live, anew, 100, 0);
  live.begin(pass_of(2, 1), bone);
  give(live, next, 100, 0);
  live.finish();
  const auto procedures = live.procedures();
  ASSERT_EQ(procedures.size(), 2u);
  const auto idle = idle_ticks(0, 500);
  EXPECT_EQ(procedures[0].figures, figures_of(procedure_of({&idle, &anew}, bone)));
  EXPECT_EQ(procedures[1].trial, 2);
  EXPECT_DOUBLE_EQ(procedures[1].figures.time, 0.2);
}

TEST(LiveDrillingTest, TicksWhoseRowsWereLostArePassedOver) {
  const auto bone = std::make_shared<const bone::BoneModel>(bone::bone_of(test::block_record(0)));
  RandomStream random(6, "lost");
  std::vector<bool> gone;
  test::DrillingRows rows = test::wander(0, 1000, 0, random, gone);
  rows.tool.erase(rows.tool.begin() + 100, rows.tool.begin() + 150);
  rows.samples.erase(rows.samples.begin() + 500, rows.samples.begin() + 520);
  LiveDrilling live(hand_made_setup(), 1000.0);
  live.begin(pass_of(1, 1), bone);
  give(live, rows, 64, 3);
  live.finish();
  EXPECT_DOUBLE_EQ(live.now()->figures.time, 0.93);
  EXPECT_EQ(live.trouble(), "");
}

TEST(LiveDrillingTest, ASessionEndsWithTheFiguresOfItsFile) {
  const test::TemporaryFolder folder;
  const protocols::BoneDefinition definition =
      protocols::load_bone_definition(test::write_small_drilling(folder.path(), 4.0));
  SessionControl control;
  SessionRequest request;
  request.protocol = &protocols::bone_drilling();
  request.definition = &definition;
  request.subject = "S01";
  request.clock = realtime::ClockKind::kSimulated;  // loses no tick on a busy machine
  request.file = folder.path() / "S01.h5";
  request.control = &control;
  request.live = [&](const auto& resumed) {
    return bone_study().live_figures(definition, resumed);
  };
  std::vector<SessionStatus> seen;
  std::thread experimenter([&] {
    for (;;) {
      const SessionStatus status = control.status();
      if (status.state == "instructions") {
        control.ask(Request::kStart);
      }
      if (status.state == "running" && status.figures) {
        seen.push_back(status);
      }
      if (status.state == "ended") {
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  });
  const SessionSummary summary = run_session(request);
  experimenter.join();

  const record::SessionReader file(request.file);
  const auto procedures = drilling::load_procedures(file, procedure_setup(definition));
  ASSERT_EQ(procedures.size(), 1u);
  const drilling::LiveFigures expected = figures_of(procedures[0]);
  EXPECT_NEAR(expected.time, 4.0, 0.01);
  EXPECT_GT(expected.voxels, 10u);
  const SessionStatus last = control.status();
  const record::LiveState state = state_of({1, false, expected});
  ASSERT_TRUE(last.figures);
  EXPECT_EQ(*last.figures, state);
  EXPECT_TRUE(last.simulated);
  ASSERT_EQ(summary.figures.size(), 1u);
  EXPECT_EQ(summary.figures[0], state);
  EXPECT_TRUE(summary.simulated);

  ASSERT_GT(seen.size(), 1u);
  std::string earlier;  // "0:01 (0:00)"
  EXPECT_LT(seen.front().figures->figures[0].value, state.figures[0].value)
      << "not only at the end";
  for (const SessionStatus& status : seen) {
    EXPECT_GE(status.figures->figures[0].value, earlier);
    earlier = status.figures->figures[0].value;
  }
}

TEST(LiveDrillingTest, TheConsoleGetsTheFigures) {
  SessionStatus status;
  EXPECT_TRUE(nlohmann::json::parse(status_json(status, 0))["figures"].is_null());
  DrilledProcedure procedure;
  procedure.trial = 2;
  procedure.figures.time = 65.0;
  procedure.figures.drilling = 9.5;
  procedure.figures.removed = 12.34e-9;
  procedure.figures.voxels = 40;
  procedure.figures.injuries = {{"dura", 3, 0, 1, {}, {}}, {"nerve", 4, 12, 0, 1.5, 1.6}};
  status.figures = state_of(procedure);
  const auto json = nlohmann::json::parse(status_json(status, 0))["figures"];
  EXPECT_EQ(json["trial"], 2);
  EXPECT_EQ(json["title"], "Procedure 2");
  EXPECT_EQ(json["figures"][2]["value"], "40") << "not a share of 0";
  EXPECT_EQ(json["figures"][7]["name"], "Nerve");
  EXPECT_EQ(json["figures"][7]["value"], "12 voxels");
  EXPECT_EQ(json["figures"][7]["alarm"], true);

  EXPECT_EQ(state_of(procedure).line,
            "procedure 2: 1:05, drilling 0:09, 12.3 mm3 of bone, 40 voxels, INJURED: "
            "dura 1, nerve 12");
  procedure.figures.visible_share = 0.876;
  procedure.figures.mean_force = 2.345;
  procedure.figures.injuries = {{"nerve", 4, 0, 0, 1.5, {}}};
  EXPECT_THAT(state_of(procedure).line,
              HasSubstr("procedure 2: 1:05, drilling 0:09, 12.3 mm3 of bone, 40 voxels, 88 % in "
                        "sight, 2.3"));
  EXPECT_THAT(state_of(procedure).line, HasSubstr("nothing vital injured"));
  procedure.figures.injuries = {};
  EXPECT_THAT(state_of(procedure).line, HasSubstr("vital structures unknown"));
  EXPECT_TRUE(state_of(procedure).figures.back().alarm);
  procedure.practice = true;
  EXPECT_THAT(state_of(procedure).line, testing::StartsWith("practice: "));
}

TEST(TickRateTest, IsThatOfTheLastSecond) {
  const TickRate::Time start{};
  const auto at = [&](int ms) { return start + std::chrono::milliseconds(ms); };
  TickRate rate;
  EXPECT_EQ(rate.rate(), 0.0);
  for (int ms = 0; ms < 500; ms += 50) {
    rate.add(at(ms), static_cast<std::uint64_t>(ms));
    EXPECT_EQ(rate.rate(), 0.0) << "too short to say";
  }
  for (int ms = 500; ms <= 3000; ms += 50) {
    rate.add(at(ms), static_cast<std::uint64_t>(ms));
    EXPECT_DOUBLE_EQ(rate.rate(), 1000.0);
  }
  // A loop that slows down to 600 Hz, and one that stands.
  for (int ms = 3050; ms <= 4000; ms += 50) {
    rate.add(at(ms), static_cast<std::uint64_t>(3000 + (ms - 3000) * 6 / 10));
  }
  EXPECT_DOUBLE_EQ(rate.rate(), 600.0);
  for (int ms = 4050; ms <= 5000; ms += 50) {
    rate.add(at(ms), 3600);
  }
  EXPECT_EQ(rate.rate(), 0.0);
}

}  // namespace
}  // namespace haptrial::experiments
