// haptrial device-test --certificate, sessions that name a certificate, and what validate says.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

constexpr const char* kFaults =
    "\n[device.faults]\ngain = 0.87\nresonance = 90.0\nresonance_damping = 0.12\n"
    "cogging = 0.08\ncogging_period = 0.003\ndead_zone = 0.15\n";

std::string shipped_text(const char* name) {
  return file_text(std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / name);
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

Json json_of(const std::filesystem::path& file) { return Json::parse(file_text(file)); }

/// A certificate as the command writes it, with these findings.
std::string certificate(const std::string& findings) {
  return R"({"certificate": 1, "device": "virtual", "simulated": true, "summary": {"findings": {)" +
         findings + "}}}";
}

/// A definition whose device then has this certificate.
std::string naming(std::string text, const std::string& file) {
  const std::string key = fmt::format("certificate = \"{}\"\n", file);
  const std::size_t table = text.find("\n[device]");
  return table == std::string::npos ? text + "\n[device]\n" + key
                                    : text.insert(text.find('\n', table + 1) + 1, key);
}

/// The row of the only certificate in the results of a study.
Json certificates(const Json& results) {
  return results.at("own_findings").at("certificates").at("tables").at("certificates").at(0);
}

class CertificateCommandTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path at(const char* name) const { return folder_.path() / name; }
  test::CommandResult run(const std::string& arguments) const {
    return test::run_command("cd '" + folder_.path().string() + "' && haptrial " + arguments);
  }
};

TEST_F(CertificateCommandTest, TheVirtualArmGetsACertificateWithItsPlantedFaults) {
  write(at("arm.toml"), shipped_text("stiffness_discrimination.toml") + kFaults);
  const test::CommandResult result =
      run("device-test virtual --definition arm.toml --certificate out --mass 0.2");
  ASSERT_EQ(result.status, 0) << result.output << result.errors;
  const Json root = json_of(at("out") / "certificate.json");
  EXPECT_TRUE(root["simulated"].get<bool>());
  const Json& found = root["summary"]["findings"];
  const auto near = [&found](const char* name, double truth, double share) {
    EXPECT_NEAR(found[name]["estimate"].get<double>(), truth, share * truth) << name;
    EXPECT_LE(found[name]["low_95"].get<double>(), found[name]["estimate"].get<double>());
  };
  near("gain", 0.87, 0.005);
  near("dead_zone", 0.15, 0.05);
  near("cogging", 0.08, 0.03);
  near("cogging_period", 0.003, 0.01);
  near("resonance", 90.0, 0.02);
  near("delay", 0.001, 0.1);
  near("inertia", 0.22, 0.02);
  near("friction", 0.1, 0.05);
  EXPECT_THAT(file_text(at("out") / "certificate.html"),
              AllOf(HasSubstr("rehearsal"), HasSubstr("gain 0.87"), HasSubstr("<svg")));
}

TEST_F(CertificateCommandTest, AHandleThatFallsByTheWeightThatIsLeftIsCaught) {
  write(at("arm.toml"),
        shipped_text("stiffness_discrimination.toml") + kFaults + "gravity_error = -0.12\n");
  const test::CommandResult result =
      run("device-test virtual --definition arm.toml --certificate out --mass 0.2");
  ASSERT_EQ(result.status, 0) << result.output << result.errors;
  const Json root = json_of(at("out") / "certificate.json");
  EXPECT_NEAR(root["summary"]["findings"]["gain"]["estimate"].get<double>(), 0.87, 0.01);
}

/// The force that holds a falling handle on another axis makes the command longer than its part
/// along the axis, so that the dead zone takes less off that part.
TEST_F(CertificateCommandTest, WithoutASensorItSaysWhatItTakes) {
  const test::CommandResult result = run("device-test virtual --certificate out --without-sensor");
  ASSERT_EQ(result.status, 0) << result.output << result.errors;
  const Json root = json_of(at("out") / "certificate.json");
  EXPECT_FALSE(root["with_sensor"].get<bool>());
  const Json& found = root["summary"]["findings"];
  EXPECT_THAT(found["gain"]["not_defined"].get<std::string>(), HasSubstr("known mass"));
  EXPECT_THAT(found["cogging"]["not_defined"].get<std::string>(), HasSubstr("force sensor"));
  EXPECT_NEAR(found["friction_commanded"]["estimate"].get<double>(), 0.1, 0.01);
  EXPECT_THAT(found["bandwidth"]["not_defined"].get<std::string>(), HasSubstr("no resonance"));
}

TEST_F(CertificateCommandTest, OptionsThatDoNotFitAreRefused) {
  const test::CommandResult alone = run("device-test virtual --mass 0.2");
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.errors, HasSubstr("--certificate FOLDER"));
  const test::CommandResult heavy = run("device-test virtual --certificate out --mass 50");
  EXPECT_EQ(heavy.status, 2);
  EXPECT_THAT(heavy.errors, HasSubstr("allowed: a number from 0 to 5 [kg]"));
  const test::CommandResult mouse = run("device-test mouse --certificate out");
  EXPECT_EQ(mouse.status, 2);
  EXPECT_THAT(mouse.errors, HasSubstr("a mouse gives no force"));
}

TEST_F(CertificateCommandTest, AThresholdOfAWeakArmIsRightAsMeasured) {
  const std::string perfect = shipped_text("stiffness_discrimination.toml");
  write(at("perfect.toml"), perfect);
  write(at("weak.toml"), perfect + "\n[device.faults]\ngain = 0.87\n");
  ASSERT_EQ(run("device-test virtual --definition weak.toml --certificate arm").status, 0);
  write(at("named.toml"),
        naming(perfect, "arm/certificate.json") + "\n[device.faults]\ngain = 0.87\n");
  for (const char* name : {"perfect", "named"}) {
    const test::CommandResult dry = run(fmt::format(
        "dry-run {0}.toml --out {0} --subjects 2 --seed 5 && haptrial analyze {0}", name));
    ASSERT_EQ(dry.status, 0) << dry.output << dry.errors;
  }
  const Json plain = json_of(at("perfect") / "results.json");
  const Json made = json_of(at("named") / "results.json");
  EXPECT_FALSE(plain.contains("apparatus"));
  ASSERT_TRUE(made.contains("apparatus")) << made.dump(1).substr(0, 2000);
  int rows = 0;
  for (const Json& row : made["apparatus"]["thresholds"]) {
    const double commanded = row["commanded"]["estimate"].get<double>();
    const double measured = row["measured"]["estimate"].get<double>();
    const double truth = 0.87 * commanded;  // what the planted arm gave
    EXPECT_NEAR(commanded / truth, 1.0 / 0.87, 1e-9) << "13 % of it never reached the hand";
    EXPECT_NEAR(measured / truth, 1.0, 0.01);
    ++rows;
  }
  EXPECT_GE(rows, 2);
  EXPECT_THAT(file_text(at("named") / "report.html"),
              AllOf(HasSubstr("Apparatus"), HasSubstr("as measured"),
                    HasSubstr("Force on the hand per force commanded")));
}

TEST_F(CertificateCommandTest, SessionsKeepTheCertificateTheyRanWith) {
  write(at("arm.json"),
        certificate(R"("gain": {"estimate": 0.9, "low_95": 0.89, "high_95": 0.91})"));
  write(at("study.toml"), naming(shipped_text("stiffness_discrimination.toml"), "arm.json"));
  const test::CommandResult dry = run("dry-run study.toml --out s --subjects 1 --seed 5");
  ASSERT_EQ(dry.status, 0) << dry.output << dry.errors;
  std::filesystem::remove(at("arm.json"));
  const test::CommandResult report = run("analyze s");
  ASSERT_EQ(report.status, 0) << report.errors;
  const Json row = certificates(json_of(at("s") / "results.json"));
  EXPECT_NEAR(row["gain"]["estimate"].get<double>(), 0.9, 1e-9);
  EXPECT_EQ(row["checksum"].dump().size(), 2 + 16u);
}

TEST_F(CertificateCommandTest, EveryProtocolsReportSaysWhatTheDeviceDid) {
  write(at("arm.json"),
        certificate(R"("gain": {"estimate": 0.9, "low_95": 0.89, "high_95": 0.91})"));
  const std::string drilling = file_text(test::write_small_drilling(folder_.path(), 2.0));
  for (const auto& [name, text] : {std::pair("force.toml", shipped_text("force_training.toml")),
                                   {"drilling.toml", drilling}}) {
    write(at(name), naming(text, "arm.json"));
    const test::CommandResult made = run(fmt::format(
        "dry-run {0} --out of_{0} --subjects 2 --trials 1 --seed 5 && haptrial analyze of_{0}",
        name));
    ASSERT_EQ(made.status, 0) << made.output << made.errors;
    const std::filesystem::path folder = folder_ / fmt::format("of_{}", name);
    const Json row = certificates(json_of(folder / "statistics.json"));
    EXPECT_NEAR(row["gain"]["estimate"].get<double>(), 0.9, 1e-9) << name;
    EXPECT_EQ(row["sessions"]["estimate"], 2) << name;
    EXPECT_THAT(file_text(folder / "report.html"),
                HasSubstr("What the device did with what was commanded"))
        << name;
  }
}

TEST_F(CertificateCommandTest, ValidateSaysWhatTheDeviceCannotPresent) {
  write(at("arm.json"), certificate(R"("stiffest_wall": {"estimate": 400, "low_95": 400},
      "dead_zone": {"estimate": 0.3}, "force_noise": {"estimate": 0.06})"));
  write(at("study.toml"), naming(shipped_text("stiffness_discrimination.toml"), "arm.json"));
  const test::CommandResult stiff = run("validate study.toml");
  EXPECT_EQ(stiff.status, 0) << stiff.errors;
  EXPECT_THAT(stiff.output, AllOf(HasSubstr("warning: stage press"), HasSubstr("600 N/m"),
                                  HasSubstr("400 N/m is the stiffest wall")));
  write(at("plain.toml"), shipped_text("stiffness_discrimination.toml"));
  EXPECT_THAT(run("validate plain.toml").output, Not(HasSubstr("stiffest wall")));
}

TEST_F(CertificateCommandTest, AFileThatIsNoCertificateIsRefused) {
  write(at("study.toml"), naming(shipped_text("stiffness_discrimination.toml"), "arm.json"));
  const test::CommandResult missing = run("validate study.toml");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.errors, HasSubstr("arm.json is not a file"));
  write(at("arm.json"), R"({"gain": 0.87})");
  const test::CommandResult other = run("validate study.toml");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("arm.json is no certificate"));
}

TEST_F(CertificateCommandTest, FiguresOfAnotherFormatOrUnitAreRefused) {
  write(at("study.toml"), naming(shipped_text("stiffness_discrimination.toml"), "arm.json"));
  const auto refused = [&](const std::string& text, const char* sentence) {
    write(at("arm.json"), text);
    const test::CommandResult result = run("validate study.toml");
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.errors, HasSubstr(sentence));
  };
  std::string later = certificate("");
  later.replace(later.find("\"certificate\": 1"), 16, "\"certificate\": 99");
  refused(later, "arm.json is a certificate of format 99; allowed: format 1");
  refused(certificate(R"("friction": {"estimate": 100.0, "unit": "mN"})"),
          "arm.json: summary.friction.unit is \"mN\"; allowed: \"N\"");
  refused(certificate(R"("friction": {"estimate": "0.1", "unit": "N"})"),
          "arm.json: summary.friction.estimate is \"0.1\"; allowed: a number");
  refused(certificate(R"("gain": {"estimate": 0.9, "low_95": 0.95, "high_95": 0.97})"),
          "certificate.gain is outside of gain_low to gain_high; allowed: ");
  write(at("arm.json"), certificate(R"("friction": {"estimate": 0.1, "unit": "N"})"));
  EXPECT_EQ(run("validate study.toml").status, 0);
}

/// Noise takes the estimate of a friction or a delay that is nearly none below zero.
TEST_F(CertificateCommandTest, FiguresJustBelowZeroCountAsZero) {
  write(at("study.toml"), naming(shipped_text("stiffness_discrimination.toml"), "arm.json"));
  std::string text = certificate(R"("friction": {"estimate": -1e-6, "unit": "N"},
      "dead_zone": {"estimate": -1e-9, "unit": "N"}, "delay": {"estimate": -1e-7, "unit": "s"})");
  text.insert(text.rfind('}'), R"(, "rotation_summary":
      {"findings": {"friction": {"estimate": -1e-6, "unit": "N·m"}}})");
  write(at("arm.json"), text);
  const test::CommandResult valid = run("validate study.toml");
  EXPECT_EQ(valid.status, 0) << valid.errors;
  EXPECT_THAT(valid.output, HasSubstr("study.toml: valid"));
}

}  // namespace

// Certificates of a rotation and a grip, and what validate says of them.

namespace {

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
