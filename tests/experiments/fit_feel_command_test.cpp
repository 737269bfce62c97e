// haptrial bone fit-feel as a stranger uses it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::fit_feel_command_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// An exact trace of a ball of 3 mm radius: gains of 0.5 and 1.5 N/mm^3 with 2 mm^3 between them.
std::string exact_trace() {
  std::string text = "time,depth,force\n";
  for (int n = 1; n <= 60; ++n) {
    const double h = 2e-5 * n;
    const double volume = std::numbers::pi * h * h * (3e-3 - h / 3.0);
    const double force = 0.5e9 * std::min(volume, 2e-9) + 1.5e9 * std::max(0.0, volume - 2e-9);
    text += fmt::format("{},{:.9g},{:.9g}\n", 1e-3 * n, h, force);
  }
  return text;
}

TEST(FitFeelCommandTest, AnExactTraceGivesItsConstantsAsKeysOfADefinition) {
  const test::TemporaryFolder folder;
  const fs::path study = test::write_small_drilling(folder.path(), 1.0);
  test::write_text(folder / "press.csv", exact_trace());
  const std::string command = "haptrial bone fit-feel '" + (folder / "press.csv").string() +
                              "' --definition '" + study.string() + "' ";
  const fs::path out = folder / "fitted.toml";
  const auto done = test::run_command(command + "--tool cutting --out '" + out.string() + "'");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("60 samples in contact"));
  EXPECT_THAT(done.output, HasSubstr("removal        not fitted"));
  const auto fitted = protocols::load_bone_definition(out);
  const auto& feel = fitted.simulator.tools[0].as<bone::BurrTool>()->feel;
  EXPECT_NEAR(feel.first_gain, 0.5e9, 1e4);
  EXPECT_NEAR(feel.second_gain, 1.5e9, 1e4);
  EXPECT_NEAR(feel.threshold, 2e-9, 1e-13);

  const auto again = test::run_command(command + "--tool cutting --out '" + out.string() + "'");
  EXPECT_EQ(again.status, 2) << "the file is there";
  const auto other = test::run_command(command + "--tool suction");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("allowed: cutting, diamond"));
}

}  // namespace
}  // namespace haptrial::experiments::fit_feel_command_test
