// Certificates of a rotation and a grip, and what validate says of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

constexpr double kRadius = 0.02;  // [m]

/// A trial in which one part is felt. @param stiffness  of its spring, in its own unit
std::string study(const std::string& part, double stiffness, const std::string& unit) {
  return fmt::format(R"([experiment]
protocol = "trials"
name = "parts"
[design]
participants = 1
[device]
certificate = "arm.json"
[devices.stylus]
start = [0.0, 0.0, 0.0]
[devices.knob]
rotation_of = "stylus"
radius = 0.02
handle_mass = 2e-5
max_force = 0.14
faults = {{ gain = 0.92, dead_zone = 0.002, cogging = 0.0012, cogging_period = 0.2 }}
[devices.pinch]
grip_of = "stylus"
start = [0.02, 0.0, 0.0]
handle_mass = 0.08
max_force = 6.0
faults = {{ gain = 0.8, dead_zone = 0.15 }}
[fields.felt]
device = "{}"
type = "spring"
to = [0.0, 0.0, 0.0]
stiffness = {}
damping = 0.0001
limit = "$level"
[[stages]]
name = "feel"
fields = ["felt"]
until = {{ time = 1.5 }}
[response]
question = "Was it there?"
choices = [{{ value = "yes", keys = ["Y"] }}, {{ value = "no", keys = ["N"] }}]
[procedure]
kind = "constant"
variable = "level"
unit = "{}"
levels = [0.001, 0.05]
counts = "$answer == 1"
[[blocks]]
name = "one"
[observer]
decides = "yes"
at_device = "{}"
)",
                     part, stiffness, unit, part);
}

class PartCertificateTest : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  test::CommandResult run(const std::string& arguments) const {
    return test::run_command("cd '" + folder_.path().string() + "' && haptrial " + arguments);
  }
  Json findings(const char* list) const {
    return Json::parse(file_text(folder_ / "out" / "certificate.json")).at(list).at("findings");
  }

  test::TemporaryFolder folder_;
};

constexpr const char* kNothingKnown =
    R"({"certificate": 1, "device": "virtual", "simulated": true, "summary": {"findings": {}}})";

TEST_F(PartCertificateTest, TheVirtualRotationAndGripGetTheirPlantedFaults) {
  write("arm.json", kNothingKnown);
  write("parts.toml", study("knob", 0.2, "N·m"));
  const test::CommandResult result =
      run("device-test virtual --definition parts.toml --certificate out");
  ASSERT_EQ(result.status, 0) << result.output << result.errors;
  const auto near = [](const Json& found, const char* name, double truth, double share) {
    EXPECT_NEAR(found.at(name).at("estimate").get<double>(), truth, share * truth) << name;
    EXPECT_LT(found.at(name).at("low_95").get<double>(),
              found.at(name).at("high_95").get<double>());
  };
  const Json knob = findings("rotation_summary");
  near(knob, "gain", 0.92, 0.01);
  near(knob, "dead_zone", 0.002, 0.1);
  near(knob, "cogging", 0.0012, 0.05);
  near(knob, "cogging_period", 0.2, 0.02);
  near(knob, "inertia", 2e-5, 0.05);
  near(knob, "friction", 0.1 * kRadius, 0.05);
  EXPECT_EQ(knob.at("friction").at("unit"), "N·m");
  EXPECT_EQ(knob.at("stiffest_wall").at("unit"), "N·m/rad");
  const Json pinch = findings("grip_summary");
  near(pinch, "gain", 0.8, 0.02);
  near(pinch, "inertia", 0.08, 0.05);
  EXPECT_EQ(pinch.at("friction").at("unit"), "N");
  EXPECT_THAT(result.output, AllOf(HasSubstr("rotation"), HasSubstr("between the fingers")));
}

TEST_F(PartCertificateTest, APartThatTheDeviceLacksIsNamed) {
  const test::CommandResult result = run("device-test virtual --certificate out");
  ASSERT_EQ(result.status, 0) << result.output << result.errors;
  EXPECT_THAT(findings("rotation_summary").at("gain").at("not_defined").get<std::string>(),
              HasSubstr("no such part"));
  EXPECT_TRUE(findings("grip_summary").at("gain").contains("not_defined"));
}

TEST_F(PartCertificateTest, ValidateComparesTorquesAndGripForcesWithTheirOwnFigures) {
  write("arm.json",
        R"({"certificate": 1, "device": "virtual", "simulated": true,
            "summary": {"findings": {}},
            "rotation_summary": {"findings": {"friction": {"estimate": 0.004},
                                              "stiffest_wall": {"low_95": 0.1}}},
            "grip_summary": {"findings": {"dead_zone": {"estimate": 0.3}}}})");
  write("parts.toml", study("knob", 0.2, "N·m"));
  const test::CommandResult turned = run("validate parts.toml");
  EXPECT_EQ(turned.status, 0) << turned.errors;
  EXPECT_THAT(turned.output, AllOf(HasSubstr("rotation's friction is 0.004 N·m"),
                                   HasSubstr("0.1 N·m/rad is the stiffest spring"),
                                   Not(HasSubstr("give no grip force"))));
  write("parts.toml", study("pinch", 200.0, "N"));
  const test::CommandResult pinched = run("validate parts.toml");
  EXPECT_EQ(pinched.status, 0) << pinched.errors;
  EXPECT_THAT(pinched.output, AllOf(HasSubstr("commands up to 0.3 N give no grip force"),
                                    Not(HasSubstr("rotation's friction"))));
}

}  // namespace
}  // namespace haptrial::experiments
