// The force study under a curve constraint, and paths that were recorded.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "analysis/force_training/study/session_recalls.h"
#include "analysis/force_training/study/study.h"
#include "core/base/error.h"
#include "core/control/sampled_curve.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "experiments/studies/curve_analysis.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "protocols/force_training/force_replay.h"
#include "protocols/force_training/recorded_path.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::curve_study_test {
namespace {

using record::Phase;
using record::Sample;
using record::Stage;
using testing::HasSubstr;
namespace fs = std::filesystem;

fs::path curve_definition() {
  return fs::path(HAPTRIAL_SOURCE_DIR) / "experiments" / "force_training_curve.toml";
}

std::string without_noise(std::string text) {
  const std::regex median(
      "(\n(visual_weber|haptic_weber|visual_memory_noise|haptic_memory_noise|"
      "haptic_bias|bar_misjudgement|calibration_loss|forgetting|"
      "production_bias|timing_error|force_noise|tremor) *= \\{ median = )"
      "[0-9.]+");
  return std::regex_replace(text, median, "$010.0");
}

record::SessionReader record_session(const protocols::ForceDefinition& definition,
                                     const fs::path& file, int trials,
                                     const std::string& subject = "S01") {
  SessionRequest request =
      test::session_request(protocols::force_training(), definition, file, 1, subject);
  request.max_trials = trials;
  run_session(request);
  return record::SessionReader(file);
}

std::vector<Sample> run_of(const record::SessionReader& reader, const record::PassRow& row) {
  return *analysis::run_samples(reader, row);
}

class CurveStudyTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(CurveStudyTest, ShippedDefinitionDiffersInTheGuidanceAlone) {
  // Line by line: what the curve study has in place of the other's.
  std::vector<std::string> lines[2];
  for (const int which : {0, 1}) {
    std::istringstream text(which == 0 ? test::shipped_text()
                                       : test::read_text(curve_definition()));
    for (std::string line; std::getline(text, line);) {
      line = line.substr(0, line.find(" #"));
      line.erase(line.find_last_not_of(' ') + 1);
      if (!line.empty() && line[0] != '#') {
        lines[which].push_back(line);
      }
    }
  }
  std::vector<std::string> missing;
  for (const std::string& line : lines[0]) {
    if (std::find(lines[1].begin(), lines[1].end(), line) == lines[1].end()) {
      missing.push_back(line);
    }
  }
  ASSERT_EQ(missing.size(), 2u) << testing::PrintToString(missing);
  EXPECT_EQ(missing[0], "name = \"force_training\"");
  EXPECT_THAT(missing[1], HasSubstr("Your hand will be led")) << "what participants are told";
}

TEST_F(CurveStudyTest, EverybodyComesToTheEndAtAPaceOfTheirOwn) {
  const protocols::ForceDefinition definition =
      protocols::load_force_definition(curve_definition());
  std::vector<double> paces;
  for (const std::string subject : {"S01", "S02", "S03"}) {
    const auto reader = record_session(definition, folder_ / (subject + ".h5"), 3, subject);
    EXPECT_TRUE(record::check_session(reader).ok);
    ASSERT_EQ(reader.passes().size(), 6u);
    double seconds = 0.0;
    for (const record::PassRow& row : reader.passes()) {
      ASSERT_EQ(row.status, record::PassStatus::kCompleted);
      seconds += static_cast<double>(run_of(reader, row).size()) / definition.rate;
    }
    paces.push_back(seconds / (6.0 * reader.stimuli().back().time));  // of the guided duration
    // Over the three trials of a block the path is one and the durations are not.
    const auto first = run_of(reader, reader.passes()[0]).size();
    const auto second = run_of(reader, reader.passes()[2]).size();
    EXPECT_NE(first, second);
    EXPECT_NEAR(static_cast<double>(first), static_cast<double>(second),
                0.5 * static_cast<double>(first));
  }
  const auto [fastest, slowest] = std::minmax_element(paces.begin(), paces.end());
  EXPECT_GT(*slowest, 1.01 * *fastest);
  EXPECT_GT(*fastest, 0.3);
  EXPECT_LT(*slowest, 3.0);
}

TEST_F(CurveStudyTest, TheTargetForceIsThatOfThePlace) {
  const protocols::ForceDefinition definition =
      protocols::load_force_definition(curve_definition());
  const auto reader = record_session(definition, folder_ / "S01.h5", 1);
  const record::PassRow row = reader.passes().back();
  const auto stimulus =
      stimulus::make_stimulus(definition.trajectory, definition.force_pattern, row.stimulus_seed);
  const control::SampledCurve path(stimulus.path.points());
  double before = 0.0;
  for (const Sample& s : run_of(reader, row)) {
    // The path is open to both sides of the place before; this stimulus does not cross itself.
    const control::CurvePlace place = path.nearest(s.position);
    ASSERT_NEAR(s.target_force, stimulus.force.at(place.arc / stimulus.path.speed()), 0.05);
    ASSERT_LT(std::abs(place.arc - before), 0.003);
    before = place.arc;
  }
  EXPECT_GT(before, path.length() - 0.001);
}

TEST_F(CurveStudyTest, WithoutNoiseRecallIsNearPerfectInEveryCondition) {
  const protocols::ForceDefinition definition = protocols::parse_force_definition(
      without_noise(test::read_text(curve_definition())), "quiet.toml");
  record_session(definition, folder_ / "S01.h5", 9);
  const auto study =
      analysis::analyze_study({folder_ / "S01.h5"}, curve_analysis_of(definition).scoring, 1);
  ASSERT_EQ(study.scores.size(), 9u);
  for (const auto& score : study.scores) {
    EXPECT_LT(score.rms_unaligned, 0.5) << score.condition << ", of a pattern up to 12 N";
  }
  EXPECT_TRUE(study.over_path);
  EXPECT_FALSE(study.tracking.lag) << "there is nothing to lag behind";
  EXPECT_LT(*study.tracking.rms_error_in_plane, 3e-4) << "held on the path";
  EXPECT_GT(*study.tracking.run, 5.0);
}

TEST_F(CurveStudyTest, AReplayShowsTheProgressThatWasMade) {
  const protocols::ForceDefinition definition =
      protocols::load_force_definition(curve_definition());
  record_session(definition, folder_ / "S01.h5", 1);
  protocols::ForceReplay replay(folder_ / "S01.h5", 1, Phase::kTest);
  const auto& seen = replay.seen(0);
  double furthest = 0.0;
  int paced = 0;
  for (const stimulus::Presentation& p : seen) {
    furthest = std::max(furthest, p.self_paced ? p.progress : 0.0);
    paced += p.self_paced;
  }
  EXPECT_GT(furthest, 0.99);
  EXPECT_GT(paced, 3000);
}

TEST_F(CurveStudyTest, APathThatWasRecordedGuidesOthersAlongIt) {
  // Somebody is led along a random path; another then moves along what that hand did.
  const protocols::ForceDefinition teacher =
      protocols::load_force_definition(test::shipped_definition());
  const auto lesson = record_session(teacher, folder_ / "teacher.h5", 1);
  for (const bool own_pace : {true, false}) {
    std::string text = own_pace ? test::read_text(curve_definition())
                                : test::read_text(test::shipped_definition());
    const auto from = text.find("length_x");
    const auto to = text.find("speed = 0.016");
    text.replace(from, to - from, "from = \"teacher.h5:1\"\n");
    test::write_text(folder_ / "follow.toml", text);
    const protocols::ForceDefinition definition =
        protocols::load_force_definition(folder_ / "follow.toml");
    const std::string name = own_pace ? "own.h5" : "led.h5";
    const auto reader = record_session(definition, folder_ / name, 1);

    std::vector<Eigen::Vector3d> taught;
    for (const Sample& s : run_of(lesson, lesson.passes().back())) {
      taught.push_back({s.position.x(), 0.0, s.position.z()});
    }
    const control::SampledCurve path(taught);
    ASSERT_EQ(reader.passes().size(), 2u);
    for (const record::PassRow& row : reader.passes()) {
      ASSERT_EQ(row.status, record::PassStatus::kCompleted);
      double furthest = 0.0;
      for (const Sample& s : run_of(reader, row)) {
        const Eigen::Vector3d hand(s.position.x(), 0.0, s.position.z());
        ASSERT_LT(path.nearest(hand).distance, own_pace ? 5e-4 : 1.5e-3);
        furthest = std::max(furthest, (hand - taught.front()).norm());
      }
      EXPECT_GT(furthest, 0.09) << "all of the 10 cm";
    }
    for (const record::StimulusRow& row : reader.stimuli()) {
      ASSERT_LT(path.nearest(row.position).distance, 1e-4) << "the file holds the path itself";
    }
    // The file alone is enough to see it again and to score it, without the teacher's.
    fs::rename(folder_ / "teacher.h5", folder_ / "away.h5");
    protocols::ForceReplay replay(folder_ / name, 1, std::nullopt);
    EXPECT_EQ(replay.notice(), "");
    const protocols::ForceDefinition kept =
        protocols::parse_force_definition(reader.info().definition, "kept.toml");
    EXPECT_EQ(
        analysis::analyze_study({folder_ / name}, curve_analysis_of(kept).scoring, 1).scores.size(),
        1u);
    fs::rename(folder_ / "away.h5", folder_ / "teacher.h5");
  }
}

TEST_F(CurveStudyTest, RecordedPathsThatAreNoneGetASentence) {
  const protocols::ForceDefinition teacher =
      protocols::load_force_definition(test::shipped_definition());
  record_session(teacher, folder_ / "teacher.h5", 1);
  const auto problem = [&](const std::string& from) -> std::string {
    try {
      protocols::recorded_path(from, folder_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem("teacher.h5:1"), "");
  for (const std::string bad : {"teacher.h5", "teacher.h5:", "teacher.h5:0", "teacher.h5:1x", ":1",
                                "teacher.h5:-1", "teacher.h5:99999999999"}) {
    EXPECT_THAT(problem(bad),
                HasSubstr("trajectory.from is '" + bad + "'; allowed: FILE.h5:TRIAL"));
  }
  EXPECT_THAT(problem("teacher.h5:7"), HasSubstr("holds no completed pass of trial 7"));
  EXPECT_THAT(problem("nobody.h5:1"), HasSubstr("nobody.h5"));
  // The definition says so too, before anything runs.
  std::string text = test::shipped_text();
  const auto from = text.find("length_x");
  text.replace(from, text.find("speed = 0.016") - from, "from = \"teacher.h5:1\"\n");
  test::write_text(folder_ / "small.toml",
                   test::replaced(text, "workspace_radius = 0.075  # [m]\nmax_speed",
                                  "workspace_radius = 0.02\nmax_speed"));
  try {
    protocols::load_force_definition(folder_ / "small.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("trajectory.from names a path that reaches 0.0"));
    EXPECT_THAT(error.what(), HasSubstr("within envelope.workspace_radius, 0.02 [m]"));
  }
}

TEST_F(CurveStudyTest, DefinitionsThatMixTheKindsAreRefused) {
  const auto problem = [](const std::string& text) -> std::string {
    try {
      protocols::parse_force_definition(text, "study.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string curve = test::read_text(curve_definition());
  EXPECT_EQ(problem(curve), "");
  EXPECT_THAT(problem(test::replaced(curve, "kind = \"curve\"", "kind = \"trajectory\"")),
              HasSubstr("[pace] is not a known table"));
  EXPECT_THAT(problem(test::replaced(curve, "[pace]", "[pase]")),
              HasSubstr("the table [pace] is missing"));
  EXPECT_THAT(problem(test::replaced(curve, "median = 0.011", "median = 0.0")),
              HasSubstr("pace.pace.median is 0; allowed: a number of at least 0.001"));
}

}  // namespace
}  // namespace haptrial::experiments::curve_study_test
