// A trial under a pointer gives the forces of the mouse device with the scene or the pass, to the
// bit; its lines say the same.

#include "experiments/preview/tried_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/error.h"
#include "core/device/mouse.h"
#include "core/scene/scene.h"
#include "experiments/studies/experiment.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/force_training/guided_passes.h"
#include "protocols/force_training/recorded_pass.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::experiments::tried_trial_test {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Experiment shipped(const std::string& name) {
  return load_experiment(std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / name);
}

const protocols::StudiedDefinition& studied(const Experiment& experiment) {
  return dynamic_cast<const protocols::StudiedDefinition&>(*experiment.definition);
}

std::vector<std::string> lines_in(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(TriedTrialTest, ForcesAreThoseOfMouseAndSceneToTheBit) {
  const Experiment experiment = shipped("stiffness_discrimination.toml");
  const auto& d = studied(experiment);
  const auto tried = experiment.study->tried_trial(d, {});
  ASSERT_NE(nullptr, tried);
  const protocols::PreviewedTrial trial = previewed_trial(d, previewed_session(1), 1);
  const protocols::Presented& presented = trial.intervals[0].presented;
  device::MouseParameters parameters = d.mouse;
  parameters.in_space = true;
  parameters.start = trial.intervals[0].start;
  device::MouseDevice mouse(parameters, d.rate);
  scene::Scene scene(presented.fields, d.rate);
  scene.switch_to(presented.stages[0].stage.fields & presented.felt.front());
  const std::size_t last = presented.stages.size() - 1;
  double most = 0.0;
  for (int i = 0; i < 3000; ++i) {
    if (i == 500) {
      tried->choose(last);
      scene.switch_to(presented.stages[last].stage.fields & presented.felt.front());
    }
    const Vector3d pointer(0.0, 0.02 - 2e-5 * i, 0.001);
    const TriedTrial::Moment moment = tried->tick(pointer);
    mouse.reach({pointer, Eigen::Quaterniond::Identity()});
    device::DeviceReading reading;
    mouse.read(reading);
    const Vector3d force = scene.force(reading.tool);
    mouse.write({force});
    ASSERT_EQ(reading.tool.position, moment.hand.position) << i;
    ASSERT_EQ(force, moment.force) << i;
    most = std::max(most, force.norm());
  }
  EXPECT_GT(most, 1.0);
}

TEST(TriedTrialTest, LinesSayWhatTicksDo) {
  const Experiment experiment = shipped("stiffness_discrimination.toml");
  const auto by_lines = experiment.study->tried_trial(*experiment.definition, {});
  const auto by_ticks = experiment.study->tried_trial(*experiment.definition, {});
  std::istringstream in("stage 2\nto 0.2 0 0.01 0\nto 0.3 0 -0.02 0\n");
  std::ostringstream out;
  try_lines(*by_lines, in, out);
  const std::vector<std::string> lines = lines_in(out.str());
  ASSERT_EQ(4u, lines.size());
  const auto head = nlohmann::json::parse(lines[0]);
  EXPECT_EQ(by_ticks->stages(), head["stages"].get<std::vector<std::string>>());
  EXPECT_FALSE(head["objects"].empty());
  EXPECT_EQ("stage 2", lines[1]);
  by_ticks->choose(1);
  TriedTrial::Moment moment;
  for (int i = 0; i < 300; ++i) {
    moment = by_ticks->tick({0.0, i < 200 ? 0.01 : -0.02, 0.0});
  }
  EXPECT_THAT(lines[3], HasSubstr(by_ticks->stages()[1]));
  std::istringstream numbers(lines[3]);
  std::array<double, 7> said{};
  for (double& number : said) {
    ASSERT_TRUE(numbers >> number);
  }
  EXPECT_EQ(0.3, said[0]);
  EXPECT_EQ(moment.hand.position, Vector3d(said[1], said[2], said[3]));
  EXPECT_EQ(moment.force, Vector3d(said[4], said[5], said[6]));
}

TEST(TriedTrialTest, ALineThatIsNoneGetsASentence) {
  const Experiment experiment = shipped("stiffness_discrimination.toml");
  const auto tried = experiment.study->tried_trial(*experiment.definition, {});
  std::istringstream in("stage 99\nstage x\nto 1 2\nto nan 0 0 0\ngo\n");
  std::ostringstream out;
  try_lines(*tried, in, out);
  const std::vector<std::string> lines = lines_in(out.str());
  ASSERT_EQ(6u, lines.size());
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_THAT(lines[i], StartsWith("? ")) << i;
  }
}

TEST(TriedTrialTest, TheTestFollowsTheTrainingByThePassesOfSessions) {
  const Experiment experiment = shipped("force_training.toml");
  const auto& d = dynamic_cast<const protocols::ForceDefinition&>(*experiment.definition);
  const auto tried = experiment.study->tried_trial(d, {});
  ASSERT_NE(nullptr, tried);
  const protocols::GuidedTrial trial = guided_trial(d, previewed_session(1), 1);
  device::MouseDevice mouse = page_hand(d, tried->start());
  const Vector3d pointer = tried->start() + Vector3d(0.003, -0.004, 0.002);
  for (const record::Phase& phase : {record::Phase::kTraining, record::Phase::kTest}) {
    const auto pass =
        make_pass(trial.plan.condition, phase, trial.stimulus, d.guidance, trial.plan.block);
    pass->begin(0);
    double most = 0.0;
    while (pass->state() == protocols::PassState::kRunning) {
      const TriedTrial::Moment moment = tried->tick(pointer);
      mouse.reach({pointer, Eigen::Quaterniond::Identity()});
      device::DeviceReading reading;
      mouse.read(reading);
      const protocols::PassOutput out = pass->tick(reading, 1.0 / d.rate);
      mouse.write({out.force});
      ASSERT_EQ(reading.tool.position, moment.hand.position);
      ASSERT_EQ(out.force, moment.force);
      most = std::max(most, out.force.norm());
    }
    EXPECT_GT(most, 1.0);
    EXPECT_THAT(tried->now(), StartsWith(phase.name()));
  }
  EXPECT_EQ("test: over", tried->now());
  EXPECT_EQ(Vector3d::Zero(), tried->tick(pointer).force) << "nobody holds the hand any more";
  tried->choose(0);
  tried->tick(pointer);
  EXPECT_THAT(tried->now(), StartsWith("training: approach"));
}

/// Leads the hand into the bone as the camera looks. @returns the greatest force of the way [N]
double press_onto_bone(const protocols::BoneDefinition& d, TriedTrial& tried, double seconds) {
  const Camera& camera = d.simulator.camera.start;
  const Vector3d away = (camera.target - camera.eye).normalized();
  double most = 0.0;
  const auto ticks = static_cast<int>(seconds * tried.rate());
  for (int i = 0; i < ticks; ++i) {
    const double depth = 0.03 * std::min(1.0, 2.0 * i / ticks);
    most = std::max(most, tried.tick(tried.start() + depth * away).force.norm());
  }
  return most;
}

TEST(TriedTrialTest, ABurrTakesBoneWithPowerAlone) {
  const Experiment experiment = shipped("burr_shapes.toml");
  const auto& d = dynamic_cast<const protocols::BoneDefinition&>(*experiment.definition);
  const auto tried = experiment.study->tried_trial(d, {});
  ASSERT_NE(nullptr, tried);
  ASSERT_EQ(2 * d.simulator.tools.size(), tried->stages().size());
  EXPECT_FALSE(tried->objects().empty());
  const double rest = press_onto_bone(d, *tried, 1.0);
  EXPECT_GT(rest, 0.5);
  EXPECT_LE(rest, d.drilling.force_limit * (1.0 + 1e-12));
  EXPECT_THAT(tried->now(), AllOf(StartsWith(d.simulator.tools[0].name), HasSubstr("at the bone"),
                                  HasSubstr(" 0.00 mm³")));
  tried->choose(1);
  press_onto_bone(d, *tried, 1.0);
  EXPECT_THAT(tried->now(), Not(HasSubstr(" 0.00 mm³")));
}

TEST(TriedTrialTest, AToolThatIsChosenIsTakenInHand) {
  const Experiment experiment = shipped("burr_shapes.toml");
  const auto& d = dynamic_cast<const protocols::BoneDefinition&>(*experiment.definition);
  const auto tried = experiment.study->tried_trial(d, {});
  const std::size_t last = d.simulator.tools.size() - 1;
  ASSERT_GT(last, 0u);
  for (const std::size_t tool : {last, std::size_t{0}}) {
    tried->choose(2 * tool);
    for (int i = 0; i < 100; ++i) {
      tried->tick(tried->start());
    }
    EXPECT_THAT(tried->now(), StartsWith(d.simulator.tools[tool].name));
  }
}

/// Every shipped definition has a trial that a pointer tries without an exception or a force beyond
/// the device's.
class EveryTriedTrialTest : public testing::TestWithParam<std::string> {};

TEST_P(EveryTriedTrialTest, BeginsAtRestAndStaysFinite) {
  const Experiment experiment = shipped(GetParam());
  const auto tried = experiment.study->tried_trial(*experiment.definition, {});
  ASSERT_NE(nullptr, tried);
  for (std::size_t stage = 0; stage < tried->stages().size(); ++stage) {
    tried->choose(stage);
    for (int i = 0; i < 200; ++i) {
      const TriedTrial::Moment moment = tried->tick(tried->start());
      ASSERT_TRUE(moment.force.allFinite());
      ASSERT_LT(moment.hand.position.norm(), tried->reach());
    }
    EXPECT_FALSE(tried->now().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryTriedTrialTest,
                         testing::Values("force_training.toml", "force_training_curve.toml",
                                         "tutoring_study.toml", "two_hands.toml",
                                         "mandible_osteotomy.toml", "lump_search.toml"),
                         [](const auto& each) {
                           return each.param.substr(0, each.param.find('.'));
                         });

}  // namespace
}  // namespace haptrial::experiments::tried_trial_test
