#include "protocols/force_training/force_definition.h"

#include "experiments/studies/curve_analysis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/random.h"
#include "experiments/studies/experiment.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::HasSubstr;

std::string problem_of(const std::string& text) {
  try {
    parse_experiment(text, "study.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(DefinitionTest, TheShippedStudyIsTheSourcesStudy) {
  const protocols::ForceDefinition d = protocols::load_force_definition(test::shipped_definition());
  EXPECT_EQ(d.design.participants, 12);
  EXPECT_EQ(d.design.trials, 72);
  EXPECT_EQ(d.design.repetitions, 3);
  EXPECT_EQ(d.design.break_after, 36);
  EXPECT_EQ(d.design.conditions, (std::vector<std::string>{"haptic", "visual", "visuohaptic"}));
  EXPECT_EQ(d.trajectory.length_x, 0.10);
  EXPECT_EQ(d.trajectory.range_z, 0.06);
  EXPECT_EQ(d.trajectory.sinusoids, 20);
  EXPECT_EQ(d.trajectory.max_spatial_frequency, 30.0);
  EXPECT_EQ(d.trajectory.speed, 0.016);
  EXPECT_EQ(d.force_pattern.sinusoids, 4);
  EXPECT_EQ(d.force_pattern.max_frequency, 0.2);
  EXPECT_EQ(d.force_pattern.base_max, 10.0);
  EXPECT_EQ(d.force_pattern.bump_max, 12.0);
  EXPECT_EQ(d.force_pattern.ramp, 1.0);
  EXPECT_EQ(d.guidance.trajectory.stiffness, 900.0);
  EXPECT_EQ(d.guidance.trajectory.damping, 100.0);
  EXPECT_EQ(d.guidance.plane.stiffness, 2000.0);
  EXPECT_EQ(d.guidance.plane.damping, 300.0);
  const CurveAnalysis curves = curve_analysis_of(d);
  EXPECT_EQ(curves.scoring.samples, 1000);
  EXPECT_EQ(curves.scoring.filter_width, 0.1);
  ASSERT_EQ(curves.plan.tests.size(), 2u);  // §4.4
  EXPECT_EQ(analysis::text_of(curves.plan.tests[0]), "visual < haptic");
  EXPECT_EQ(analysis::text_of(curves.plan.tests[1]), "visuohaptic < visual");
  EXPECT_EQ(curves.plan.reference, "haptic");
}

TEST(DefinitionTest, PlannedTestsNameConditionsOfTheDesign) {
  const auto with = [](const std::string& key, const std::string& value) {
    std::string text = test::shipped_text();
    const auto at = text.find("\n" + key + " = ") + 1;
    return problem_of(text.replace(at, text.find('\n', at) - at, key + " = " + value));
  };
  EXPECT_EQ(with("planned", "[\"haptic != visuohaptic\"]"), "");
  EXPECT_THAT(with("planned", "[\"visula < haptic\"]"),
              HasSubstr("names 'visula', which design.conditions lacks; did you mean visual? "
                        "allowed: haptic, visual, "
                        "visuohaptic"));
  EXPECT_THAT(with("planned", "[\"visual is lower\"]"),
              HasSubstr("two conditions with <, > or != between them"));
  EXPECT_THAT(with("reference", "\"none\""),
              HasSubstr("names 'none', which design.conditions lacks"));
}

TEST(DefinitionTest, KeepsItsTextForTheSessionFile) {
  const protocols::ForceDefinition d = protocols::load_force_definition(test::shipped_definition());
  EXPECT_EQ(d.text, test::shipped_text());
  EXPECT_EQ(d.file_name, "force_training.toml");
}

struct Bad {
  const char* key;
  const char* line;
  const char* sentence;
};

class BadDefinitionTest : public testing::TestWithParam<Bad> {};

TEST_P(BadDefinitionTest, GetsASentenceWithFileLineKeyFoundAndAllowed) {
  const std::string problem = problem_of(test::shipped_with(GetParam().key, GetParam().line));
  EXPECT_THAT(problem, testing::MatchesRegex("study\\.toml:[0-9]+: .*"));
  EXPECT_THAT(problem, HasSubstr(GetParam().sentence));
  EXPECT_THAT(problem, testing::Not(HasSubstr("\n"))) << "one problem, one sentence";
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadDefinitionTest,
    testing::Values(
        Bad{"trials", "trials = 70",
            "design.trials is 70; allowed: a multiple of 9 (3 repetitions of 3 conditions)"},
        Bad{"trials", "trials = 0", "design.trials is 0; allowed: a whole number from 1"},
        Bad{"trials", "trials = 72.5", "design.trials is 72.5; allowed: a whole number"},
        Bad{"trials", "trials = \"many\"", "design.trials is 'many'; allowed: a whole number"},
        Bad{"break_after", "break_after = 35",
            "design.break_after is 35; allowed: a multiple of the 3 repetitions"},
        Bad{"break_after", "break_after = 72", "design.break_after is 72; allowed: a whole number"},
        Bad{"conditions", "conditions = [\"haptic\", \"smell\", \"visual\"]",
            "design.conditions is an array with 'smell'; allowed: haptic, visual, visuohaptic"},
        Bad{"conditions", "conditions = [\"haptic\", \"haptic\", \"visual\"]",
            "names a condition twice"},
        Bad{"speed", "speed = nan", "trajectory.speed is nan; allowed: a number above 0"},
        Bad{"speed", "speed = -1.6", "trajectory.speed is -1.6; allowed: a number above 0"},
        Bad{"length_x", "length_x = 0.5", "keep it within envelope.workspace_radius"},
        Bad{"trajectory", "trajectory = { stiffness = -900.0, damping = 100.0 }",
            "guidance.trajectory.stiffness is -900; allowed: a number of at least 0"},
        Bad{"plane", "plane = 5", "guidance.plane is 5; allowed: a table"},
        Bad{"force_limit", "force_limit = 13.0",
            "guidance.force_limit is 13; allowed: at most envelope.max_force, 12 [N]"},
        Bad{"ramp", "ramp = 9.0", "force_pattern.ramp is 9; allowed: at most half"},
        Bad{"bump_max", "bump_max = 8.0",
            "force_pattern.bump_max is 8; allowed: at least base_max, 10"},
        Bad{"integrator", "integrator = \"euler\"",
            "hand.integrator is 'euler'; allowed: exact, cvode"},
        Bad{"rate", "rate = 0.0", "experiment.rate is 0; allowed: a number of at least 100"},
        Bad{"haptic_weber", "haptic_weber = { median = -0.1, spread = 0.3 }",
            "subject.haptic_weber.median is -0.1"},
        Bad{"samples", "samples = 1", "analysis.samples is 1; allowed: a whole number from 2"}),
    [](const auto& bad) { return std::string("Case") + std::to_string(bad.index); });

TEST(DefinitionTest, ReportsEveryProblemAtOnceInOrderOfLine) {
  std::string text = test::shipped_with("speed", "speed = -1.0");
  text.replace(text.find("range_z"), 7, "range_y");
  text += "\n[surprise]\nkey = 1\n";
  const std::string problem = problem_of(text);
  const auto missing = problem.find("trajectory.range_z is missing");
  const auto unknown = problem.find("trajectory.range_y is not a known key");
  const auto speed = problem.find("trajectory.speed is -1");
  const auto surprise = problem.find("[surprise] is not a known table");
  EXPECT_LT(missing, unknown) << problem;
  EXPECT_LT(unknown, speed);
  EXPECT_LT(speed, surprise);
  EXPECT_NE(surprise, std::string::npos);
}

std::string problem_of_file(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml", text);
  try {
    load_experiment(folder / "study.toml");
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("study.toml"));
  }
  return "";
}

/// The line in which `what` first stands, from 1.
std::string line_of(const std::string& text, const std::string& what) {
  return std::to_string(1 + std::count(text.begin(), text.begin() + text.find(what), '\n'));
}

TEST(DefinitionTest, AMistakeInTheProtocolIsReportedAlone) {
  EXPECT_EQ(problem_of_file(test::shipped_text()), "");
  const std::string shipped = test::shipped_text();
  const std::string key = "[experiment]\n";
  ASSERT_NE(shipped.find(key), std::string::npos);
  const auto with = [&](const std::string& line) {
    std::string text = shipped;
    return text.insert(text.find(key) + key.size(), line + "\n");
  };
  const std::string line = line_of(with("protocol"), "protocol");
  EXPECT_EQ(problem_of_file(with("protocol = \"bone_driling\"")),
            "study.toml:" + line +
                ": experiment.protocol is 'bone_driling'; did you mean "
                "bone_drilling? allowed: force_training, bone_drilling, trials, psychophysics");
  EXPECT_EQ(problem_of_file(with("protocl = \"bone_drilling\"")),
            "study.toml:" + line +
                ": experiment.protocl is not a known key; did you mean experiment.protocol?");
  std::string mistyped = shipped;
  mistyped.replace(mistyped.find(key), key.size(), "[experimnt]\n");
  EXPECT_EQ(problem_of_file(mistyped), "study.toml:" + line_of(mistyped, "[experimnt]") +
                                           ": experimnt is not a known key; did you mean "
                                           "experiment?");
}

TEST(DefinitionTest, AMistypedConditionNamesTheNearestOne) {
  EXPECT_THAT(problem_of(test::shipped_with("conditions", "conditions = [\"hapitc\"]")),
              HasSubstr("did you mean haptic? allowed: haptic, visual, visuohaptic"));
}

TEST(DefinitionTest, FilesThatAreNone) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "empty.toml", "");
  test::write_text(folder / "comment.toml", "# nothing\n");
  test::write_text(folder / "noise.toml", std::string("\x00\xff\x13\n[[[", 7));
  for (const char* name : {"empty.toml", "comment.toml", "noise.toml", "absent.toml", "."}) {
    try {
      load_experiment(folder / name);
      FAIL() << name << " was accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(folder.path().string())) << name;
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n"))) << name;
    }
  }
}

TEST(DefinitionTest, DamagedTextNeverDoesMoreThanThrowInputError) {
  const std::string original = test::shipped_text();
  RandomStream random(1, "damage");
  int rejected = 0;
  constexpr int kRuns = 1500;
  for (int run = 0; run < kRuns; ++run) {
    std::string text = original;
    for (int edits = 1 + static_cast<int>(random.below(4)); edits > 0; --edits) {
      const std::size_t at = random.below(text.size());
      switch (random.below(4)) {
        case 0:
          text[at] = static_cast<char>(random.below(256));
          break;
        case 1:
          text.erase(at, 1 + random.below(40));
          break;
        case 2:
          text.insert(at, 1 + random.below(3), "0-.eE[]{}\"=\n"[random.below(12)]);
          break;
        default:
          text.resize(at);
      }
      if (text.empty()) {
        break;
      }
    }
    try {
      parse_experiment(text, "damaged.toml");
    } catch (const InputError&) {
      ++rejected;
    }
  }
  EXPECT_GT(rejected, kRuns / 2);
}

}  // namespace
}  // namespace haptrial::experiments
