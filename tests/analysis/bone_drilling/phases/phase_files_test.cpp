// Labels, models as files, spans and actions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "analysis/bone_drilling/phases/phase_file.h"
#include "analysis/bone_drilling/phases/phase_labels.h"
#include "tests/analysis/bone_drilling/hand_made.h"
#include "tests/analysis/bone_drilling/phases/made_actions.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::drilling::phase_files_test {
namespace {

using testing::HasSubstr;

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

std::string refusal_of(const std::string& rows) {
  const test::TemporaryFolder folder;
  write(folder / "labels.csv", "session,procedure,phase,start_s,end_s\n" + rows);
  return test::message_of([&] { read_phase_labels(folder / "labels.csv"); });
}

TEST(PhaseLabelsTest, AreReadAsTheyWereWritten) {
  const test::TemporaryFolder folder;
  const PhaseLabels labels{{{"S01.h5", 1}, {{"open, wide", 0.0, 2.5}, {"deepen", 2.5, 9.25}}},
                           {{"S01.h5", 2}, {{"deepen", 1.0, 3.0}}}};
  write(folder / "labels.csv", phase_labels_csv(labels));
  EXPECT_EQ(read_phase_labels(folder / "labels.csv"), labels);
  EXPECT_EQ(names_in(labels), std::vector<std::string>({"open, wide", "deepen"}));
}

TEST(PhaseLabelsTest, MistakesAreSaid) {
  EXPECT_THAT(refusal_of("S01.h5,1,open,0,0\n"), HasSubstr(":2: end_s is '0'; allowed: a time "));
  EXPECT_THAT(refusal_of("S01.h5,1,open,-1,2\n"), HasSubstr("start_s is '-1'"));
  EXPECT_THAT(refusal_of("S01.h5,1.5,open,0,2\n"), HasSubstr("procedure is '1.5'"));
  EXPECT_THAT(refusal_of("S01.h5,1,,0,2\n"), HasSubstr("the name of a phase"));
  EXPECT_THAT(refusal_of("S01.h5,1,deepen,1.9,3\nS01.h5,1,open,0,2\n"),
              HasSubstr(":2: start_s is '1.9'; allowed: a time at or after the end"));
}

TEST(PhaseLabelsTest, LabelsBeyondTheirProcedureAreRefused) {
  const ProcedureLengths lengths{{{"S01.h5", 1}, 30.25}};
  const auto refusal = [&](const char* session, double end) {
    return test::message_of([&] {
      check_phase_labels({{{session, 1}, {{"open", 0.0, 10.0}, {"deepen", 10.0, end}}}}, lengths,
                         "labels.csv", "out/study");
    });
  };
  EXPECT_THAT(refusal("S01.h5", 9000.0),
              HasSubstr("phase \"deepen\" of procedure 1 of S01.h5 ends at 9000 s, but the "
                        "procedure lasts 30.2 s"));
  EXPECT_THAT(refusal("S02.h5", 20.0), HasSubstr("which out/study does not have"));
  EXPECT_NO_THROW(check_phase_labels({{{"S01.h5", 1}, {{"open", 0.0, 31.0}}}}, lengths, "", ""))
      << "rounded to a whole second";
}

TEST(PhaseLabelsTest, ActionsHaveThePhaseOfTheirMiddle) {
  std::vector<Action> actions(3);
  for (std::size_t n = 0; n < 3; ++n) {
    actions[n].first = 1000 * n;
    actions[n].last = 1000 * n + 999;
  }
  const std::vector<PhaseSpan> spans{{"open", 0.0, 1.4}, {"deepen", 2.0, 2.6}};
  EXPECT_EQ(phases_at(actions, spans, {"open", "deepen"}, 1000.0), std::vector<int>({0, -1, 1}));
}

TEST(PhaseFileTest, AModelIsReadAsItWasWritten) {
  const test::TemporaryFolder folder;
  const auto cases = test::made_cases(1.0, 7);
  PhaseModel model = *learn_phases(cases, {"open", "deepen", "finish"});
  model.study = "a study";
  model.simulated = true;
  write(folder / "phases.json", phase_model_text(model));
  const PhaseModel read = read_phase_model(folder / "phases.json");
  EXPECT_EQ(phase_model_text(read), phase_model_text(model));
  EXPECT_EQ(read.mean, model.mean);
  EXPECT_EQ(phases_of(read, cases[0].actions), phases_of(model, cases[0].actions));
}

TEST(PhaseFileTest, AnythingElseIsRefused) {
  const test::TemporaryFolder folder;
  std::string text = phase_model_text(*learn_phases(test::made_cases(1.0, 7), {"a", "b", "c"}));
  const std::size_t at = text.find("\"depth\"");
  ASSERT_NE(at, std::string::npos);
  for (const std::string& wrong : {std::string("{}"), std::string("[1]"), std::string("{"),
                                   text.replace(at, 7, "\"width\"")}) {
    write(folder / "phases.json", wrong);
    EXPECT_THAT(test::message_of([&] { read_phase_model(folder / "phases.json"); }),
                HasSubstr("is not a file of phases; allowed: one that haptrial bone phases wrote"));
  }
}

TEST(PhaseSpanTest, TimesAndOrder) {
  const std::vector<PhaseSpan> spans{{"a", 0, 2}, {"b", 2, 5}, {"a", 5, 6}};
  const auto times = phase_times(spans);
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].time, 3.0);
  EXPECT_EQ(times[0].stretches, 2);
  EXPECT_EQ(times[1].first, 2.0);
  EXPECT_EQ(time_in(spans, "c"), 0.0);
  EXPECT_EQ(phase_changes(spans), 2);
  EXPECT_EQ(phases_in_order({spans, {{"b", 0, 1}, {"c", 1, 2}}}),
            std::vector<std::string>({"a", "b", "c"}));
}

/// Three strokes of 4 mm along x at a depth of `deep` voxels in a block, then two seconds at rest.
Procedure three_strokes(int deep) {
  bone::BoneModel block = test::block(12, 10, 9);
  block.structures.push_back({"nerve", {}, 1.0, true});
  for (int i = 0; i < 12; ++i) {
    test::mark(block, {i, 9, 0}, 2);
    for (int j = 0; j < 10; ++j) {
      test::mark(block, {i, j, 8}, 0);  // air over it
    }
  }
  Procedure p = test::procedure_on(std::move(block));
  for (int n = 0; n < 3600; ++n) {
    const double along =
        4e-3 * 0.5 * (1.0 - std::cos(std::numbers::pi * std::min(n, 1200) / 400.0));
    ToolTick tick = test::drilling_tick(static_cast<std::uint64_t>(n),
                                        {3e-3 + along, 4e-3, 7e-3 - 1e-3 * deep});
    tick.velocity.x() = 0.02;
    tick.in_bone = tick.power = n < 1200;
    p.ticks.push_back(tick);
  }
  p.views.push_back({0, {0, 0, 0.1}, {0, 0, 0}, 0.5});
  p.views.push_back({2000, {0, 0, 0.2}, {0, 0, 0}, 0.5});
  return p;
}

TEST(ActionTest, StrokesAndRestFillTheProcedure) {
  StudyBones bones;
  const Procedure p = three_strokes(3);
  const std::vector<Action> actions = actions_of(p, bones);
  ASSERT_EQ(actions.size(), 5u) << "three strokes and 2.4 s without one";
  std::size_t next = 0;
  for (const Action& action : actions) {
    EXPECT_EQ(action.first, next);
    next = action.last + 1;
  }
  EXPECT_EQ(next, p.ticks.size());
  EXPECT_EQ(actions[1].words[0], "burr at work");
  EXPECT_EQ(actions[3].words[0], "burr");
  EXPECT_EQ(actions[1].words[1], "nerve");
  EXPECT_EQ(actions[1].words[2], "still");
  EXPECT_EQ(actions[3].words[2], "moved");
}

TEST(ActionTest, NumbersAreThoseOfTheGeometry) {
  StudyBones bones;
  for (const int deep : {1, 3}) {
    auto action = actions_of(three_strokes(deep), bones)[1];
    // Voxel 7 - deep lies deep + 1 voxels below the air over the block.
    EXPECT_NEAR(action.number(ActionNumber::kDepth), deep == 1 ? 2.0 : 4.0, 1e-9);
    EXPECT_NEAR(action.number(ActionNumber::kClearance), std::hypot(5.0, 7.0 - deep), 1e-5);
    EXPECT_NEAR(action.number(ActionNumber::kForce), std::log(0.52), 1e-9);
    EXPECT_NEAR(action.number(ActionNumber::kSpeed), std::log(21.0), 1e-9);
    EXPECT_NEAR(action.number(ActionNumber::kSeen), std::log(200.0 * std::tan(0.25)), 1e-9);
  }
}

TEST(ActionTest, AProcedureWithoutTicksHasNone) {
  StudyBones bones;
  EXPECT_TRUE(actions_of(test::procedure_on(test::block(4, 4, 4)), bones).empty());
}

}  // namespace
}  // namespace haptrial::analysis::drilling::phase_files_test
