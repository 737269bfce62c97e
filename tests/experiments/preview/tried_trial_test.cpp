// A trial under a pointer gives the forces of the mouse device and the scene, to the bit; its lines
// say the same.

#include "experiments/preview/tried_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/error.h"
#include "core/device/mouse.h"
#include "core/scene/scene.h"
#include "experiments/studies/experiment.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::experiments::tried_trial_test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
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
  std::istringstream numbers(lines[3]);
  std::vector<double> said;
  for (double number = 0.0; numbers >> number;) {
    said.push_back(number);
  }
  ASSERT_EQ(7u, said.size());
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

TEST(TriedTrialTest, OtherProtocolsHaveNone) {
  const Experiment experiment = shipped("force_training.toml");
  EXPECT_EQ(nullptr, experiment.study->tried_trial(*experiment.definition, {}));
}

}  // namespace
}  // namespace haptrial::experiments::tried_trial_test
