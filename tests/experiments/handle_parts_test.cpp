// Fields of torque and grip: each by its law from the log of a session, in the units in which a
// definition states it; handles and hands of every inertia at their limits; what is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>

#include "core/record/read/session_reader.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/trial_rows.h"
#include "tests/experiments/command.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::handle_parts_test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kRadius = 0.02;  // [m]

/// A trial in which a knob or a gripper is moved to and fro under one field.
std::string study(const std::string& field, const std::string& of, const std::string& more = "") {
  return R"([experiment]
protocol = "trials"
name = "parts"
[design]
participants = 1
[devices.stylus]
start = [0.0, 0.0, 0.0]
[devices.knob]
rotation_of = "stylus"
radius = 0.02
max_force = 0.14
[devices.pinch]
grip_of = "stylus"
start = [0.02, 0.0, 0.0]
max_force = 6.0
[fields.felt]
device = ")" +
         of + "\"\n" + field + R"(
[[stages]]
name = "feel"
fields = ["felt"]
until = { time = 1.5 }
[response]
question = "Was it there?"
choices = [{ value = "yes", keys = ["Y"] }, { value = "no", keys = ["N"] }]
[[blocks]]
name = "one"
trials = 1
[observer]
decides = "yes"
at_device = ")" +
         of + "\"\n" + more;
}

/// A tick of a rotation in rad and N·m, or of a grip in m and N.
struct Tick {
  double time;  // in the stage [s]
  Vector3d place;
  Vector3d velocity;
  Vector3d force;
};

class HandlePartsTest : public testing::Test {
 protected:
  test::CommandResult run(const std::string& text, const std::string& command = "dry-run") {
    const std::string file = folder_ / "parts.toml";
    std::ofstream(file) << text;
    return test::run_command("haptrial " + command + " " + file +
                             (command == "dry-run" ? " --subjects 1 --out " + out() : ""));
  }
  std::string out() const { return (folder_ / "out").string(); }

  /// The ticks of the stage, once fields and forces have come in and before they go.
  std::vector<Tick> ticks(int device) const {
    const record::SessionReader reader(folder_ / "out" / "S01.h5");
    const record::StageRow stage = reader.rows<record::StageRow>().front();
    const auto arms = reader.rows<record::ArmRow>();
    const double radius = arms[static_cast<std::size_t>(device)].radius;
    const bool turns = arms[static_cast<std::size_t>(device)].part == "rotation";
    std::vector<Tick> ticks;
    for (const record::DeviceRow& row : reader.rows<record::DeviceRow>()) {
      const double time =
          1e-3 * (static_cast<double>(row.sequence) - static_cast<double>(stage.first_sample));
      if (row.device == device && time > 0.3 && row.sequence < stage.last_sample) {
        const double r = turns ? radius : 1.0;
        ticks.push_back({time, row.position / r, row.velocity / r, r * row.force});
      }
    }
    return ticks;
  }

  /// The largest difference between the recorded force and the law, over the largest force.
  double worst(int device, const std::function<Vector3d(const Tick&)>& law) const {
    double difference = 0.0, largest = 0.0;
    for (const Tick& tick : ticks(device)) {
      difference = std::max(difference, (tick.force - law(tick)).norm());
      largest = std::max(largest, tick.force.norm());
    }
    EXPECT_GT(largest, 0.0);
    return difference / largest;
  }

  /// The share of ticks whose force is that of the law. After a pause of the loop, as on a busy
  /// machine, forces ramp in anew.
  double share_by(int device, const std::function<Vector3d(const Tick&)>& law) const {
    const std::vector<Tick> all = ticks(device);
    const auto by_law = std::ranges::count_if(all, [&](const Tick& tick) {
      return (tick.force - law(tick)).norm() <= 2e-3 * tick.force.norm();
    });
    return static_cast<double>(by_law) / static_cast<double>(all.size());
  }

  test::TemporaryFolder folder_;
};

constexpr const char* kTurned =
    "[observer.actions.feel]\nknob = { do = \"stroke\", direction = [0.0, 1.0, 0.0], "
    "half_length = 0.4, frequency = 0.7, normal = [1.0, 0.0, 0.0] }\n";
constexpr const char* kPinched =
    "[observer.actions.feel]\npinch = { do = \"stroke\", direction = [1.0, 0.0, 0.0], "
    "half_length = 0.01, frequency = 0.7, normal = [0.0, 1.0, 0.0] }\n";
constexpr double kRounding = 2e-3;  // of rows of /devices, and of what fades

TEST_F(HandlePartsTest, ASpringOfARotationGivesItsTorquePerAngle) {
  const auto result =
      run(study("type = \"spring\"\nto = [0.0, 0.3, 0.0]\nstiffness = 0.1\n"
                "damping = 0.0005\n",
                "knob", kTurned));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_LT(worst(1,
                  [](const Tick& t) -> Vector3d {
                    return 0.1 * (Vector3d(0.0, 0.3, 0.0) - t.place) - 0.0005 * t.velocity;
                  }),
            kRounding);
}

TEST_F(HandlePartsTest, ADamperOfARotationGivesItsTorquePerAngularVelocity) {
  const auto result = run(study("type = \"viscous\"\ndamping = 0.004\n", "knob", kTurned));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_LT(worst(1, [](const Tick& t) -> Vector3d { return -0.004 * t.velocity; }), kRounding);
}

TEST_F(HandlePartsTest, AConstantTorqueIsAsStated) {
  const auto result =
      run(study("type = \"constant\"\nforce = [0.0, 0.03, 0.0]\n", "knob", kTurned));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_LT(worst(1, [](const Tick&) { return Vector3d(0.0, 0.03, 0.0); }), kRounding);
}

TEST_F(HandlePartsTest, DetentsOfAKnobAreTurnsApart) {
  const auto result =
      run(study("type = \"detent\"\nat = [0.0, 0.0, 0.0]\ndirection = [0.0, 1.0, 0.0]\n"
                "spacing = 0.3\npeak = 0.02\n",
                "knob", kTurned));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_LT(worst(1,
                  [](const Tick& t) {
                    const double wave = 2.0 * std::numbers::pi / 0.3;
                    return Vector3d(0.0, -0.02 * std::sin(wave * t.place.y()), 0.0);
                  }),
            0.05);
}

TEST_F(HandlePartsTest, AGripSpringPushesTheFingersApart) {
  const auto result =
      run(study("type = \"spring\"\nto = [0.02, 0.0, 0.0]\nstiffness = 200.0\n"
                "damping = 1.0\n",
                "pinch", kPinched));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_LT(worst(2,
                  [](const Tick& t) -> Vector3d {
                    return 200.0 * (Vector3d(0.02, 0.0, 0.0) - t.place) - 1.0 * t.velocity;
                  }),
            kRounding);
}

TEST_F(HandlePartsTest, AGripForceIsHeld) {
  const auto result =
      run(study("type = \"constant\"\nforce = [1.5, 0.0, 0.0]\n", "pinch", kPinched));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_LT(worst(2, [](const Tick&) { return Vector3d(1.5, 0.0, 0.0); }), kRounding);
}

TEST_F(HandlePartsTest, TheSumOfTorquesStaysWithinTheLimitOfTheRotation) {
  const auto result =
      run(study("type = \"spring\"\nto = [0.0, 1.5, 0.0]\nstiffness = 0.2\ndamping = 0.002\n"
                "limit = 0.2\n",
                "knob", "[observer.actions.feel]\nknob = { do = \"hold\" }\n"));
  ASSERT_EQ(result.status, 0) << result.errors;
  double largest = 0.0;
  for (const Tick& tick : ticks(1)) {
    largest = std::max(largest, tick.force.norm());
  }
  EXPECT_NEAR(largest, 0.14, 1e-5);
}

TEST_F(HandlePartsTest, TheFileSaysWhatTheRowsOfEachPartAre) {
  ASSERT_EQ(run(study("type = \"viscous\"\ndamping = 0.001\n", "knob", kTurned)).status, 0);
  const auto arms = record::SessionReader(folder_ / "out" / "S01.h5").rows<record::ArmRow>();
  ASSERT_EQ(arms.size(), 3u);
  EXPECT_EQ(arms[0].part, "tip");
  EXPECT_EQ(arms[1].name, "knob");
  EXPECT_EQ(arms[1].part, "rotation");
  EXPECT_EQ(arms[1].of, 0);
  EXPECT_EQ(arms[1].radius, kRadius);
  EXPECT_EQ(arms[2].part, "grip");
}

TEST_F(HandlePartsTest, AFieldWithoutADeviceActsOnTipsAlone) {
  std::string text = study("type = \"constant\"\nforce = [0.0, 1.0, 0.0]\n", "knob", kTurned);
  text.replace(text.find("device = \"knob\"\n"), 16, "");
  ASSERT_EQ(run(text).status, 0);
  for (const int part : {1, 2}) {
    for (const Tick& tick : ticks(part)) {
      ASSERT_TRUE(tick.force.isZero(0.0)) << part;
    }
  }
}

TEST_F(HandlePartsTest, WhatIsWrongIsSaidInTheUnitsOfTheRotation) {
  const auto said = [&](const std::string& text) { return run(text, "validate").errors; };
  EXPECT_THAT(said(study("type = \"spring\"\nto = [0.0, 1.0, 0.0]\nstiffness = 900.0\n"
                         "damping = 0.0\n",
                         "knob")),
              HasSubstr("allowed: a number of at least 0 and at most 40 [N·m/rad]"));
  EXPECT_THAT(said(study("type = \"constant\"\nforce = [0.0, 0.18, 0.0]\nlimit = 0.2\n", "knob")),
              HasSubstr("fields.felt asks for 0.18 N·m; allowed: at most 0.14 [N·m], "
                        "devices.knob.max_force"));
  const auto spring = [&](const char* stiffness, const char* damping) {
    return run(study(fmt::format("type = \"spring\"\nto = [0.0, 0.0, 0.0]\nstiffness = {}\n"
                                 "damping = {}\n",
                                 stiffness, damping),
                     "knob"),
               "validate");
  };
  EXPECT_THAT(spring("1.0", "0.01").output,
              HasSubstr("stage feel: its fields on knob add up to 1 N·m/rad and 0.01 N·m·s/rad"));
  EXPECT_THAT(spring("2.0", "0.2").errors, HasSubstr("no fingers of up to 0.25 kg carry that"));
}

TEST_F(HandlePartsTest, ObjectsMeetDevicesThemselves) {
  const std::string objects =
      "[objects.ball]\nshape = \"sphere\"\nradius = 0.01\ndevice = \"knob\"\nstiffness = 30.0\n"
      "damping = 0.0\n";
  const auto result =
      run(study("type = \"viscous\"\ndamping = 0.001\n" + objects, "knob"), "validate");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors,
              HasSubstr("objects.ball.device is \"knob\"; allowed: a device itself"));
}

TEST_F(HandlePartsTest, ADamagedFileIsRecoveredWithItsParts) {
  ASSERT_EQ(run(study("type = \"viscous\"\ndamping = 0.001\n", "knob", kTurned)).status, 0);
  const std::string file = (folder_ / "out" / "S01.h5").string();
  const auto before = record::SessionReader(file).rows<record::DeviceRow>();
  const auto damaged =
      test::run_command("cd '" + folder_.path().string() +
                        "' && cp out/S01.h5 cut.h5 && printf '\\0\\0\\0\\0' | dd of=cut.h5 bs=1 "
                        "conv=notrunc status=none && haptrial recover cut.h5 back.h5");
  ASSERT_EQ(damaged.status, 0) << damaged.errors;
  const record::SessionReader back((folder_ / "back.h5").string());
  EXPECT_EQ(back.rows<record::DeviceRow>().size(), before.size());
  EXPECT_EQ(back.rows<record::ArmRow>().size(), 3u);
}

TEST_F(HandlePartsTest, AnImpossiblePartIsRefused) {
  const std::string text = study("type = \"viscous\"\ndamping = 0.001\n", "knob");
  const auto without = [&](const std::string& what, const std::string& instead) {
    std::string changed = text;
    changed.replace(changed.find(what), what.size(), instead);
    const auto result = run(changed, "validate");
    EXPECT_EQ(result.status, 2);
    return result.errors;
  };
  EXPECT_THAT(without("rotation_of = \"stylus\"", "rotation_of = \"nobody\""),
              HasSubstr("devices.knob.rotation_of is \"nobody\"; allowed: \"stylus\""));
  EXPECT_THAT(without("grip_of = \"stylus\"\nstart = [0.02, 0.0, 0.0]\nmax_force = 6.0",
                      "rotation_of = \"stylus\""),
              HasSubstr("devices.pinch is the same part of stylus as knob; leave out one"));
}

/// A handle with motors for torque and grip, over the stand-in library, at which nobody is.
class LiveHandlePartsTest : public HandlePartsTest {
 protected:
  std::string live(const std::string& text) {
    std::ofstream(folder_ / "parts.toml") << text;
    return "run '" + (folder_ / "parts.toml").string() + "' --subject S01 --out '" + out() +
           "' --device force-dimension --library '" +
           HAPTRIAL_BINARY_DIR "/libstand_in_dhd.so' --console";
  }
  static std::string study_of_both() {
    std::string text = study(
        "type = \"spring\"\nto = [0.0, 0.3, 0.0]\nstiffness = 0.05\ndamping = 0.0005\n"
        "[fields.sponge]\ndevice = \"pinch\"\ntype = \"spring\"\nto = [0.03, 0.0, 0.0]\n"
        "stiffness = 100.0\ndamping = 1.0\n",
        "knob");
    text.replace(text.find("fields = [\"felt\"]"), 17, "fields = [\"felt\", \"sponge\"]");
    text.replace(text.find("time = 1.5"), 10, "time = 1.0");  // before all has come to rest
    const auto question = text.find("[response]");
    text.erase(question, text.find("[[blocks]]") - question);
    text.erase(text.find("[observer]"));
    return text +
           "[force_dimension]\nindex = 0\nmax_force = 12.0\nmax_torque = 0.15\nmax_grip_force = "
           "6.0\n"
           "workspace_radius = 0.075\neffector_mass = 0.0\ngravity_compensation = true\n"
           "velocity_window = 0.008\nwatchdog = 0.02\ntime_guard = 0.0\nstop_button = 0\n";
  }
};

TEST_F(LiveHandlePartsTest, TorqueAndGripReachTheDevice) {
  test::LiveCommand session(live(study_of_both()), "export STAND_IN_ACTIVE=1");
  test::ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  ASSERT_TRUE(person.ask("start"));
  const test::CommandResult result = session.wait();
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_GT(share_by(1,
                     [](const Tick& t) -> Vector3d {
                       return 0.05 * (Vector3d(0.0, 0.3, 0.0) - t.place) - 0.0005 * t.velocity;
                     }),
            0.5);
  EXPECT_GT(share_by(2,
                     [](const Tick& t) -> Vector3d {
                       return 100.0 * (Vector3d(0.03, 0.0, 0.0) - t.place) - 1.0 * t.velocity;
                     }),
            0.5);
  // The wrist's own spring would keep it at 0, the gripper's at 20 mm.
  EXPECT_GT(ticks(1).back().place.y(), 0.05);
  EXPECT_GT(ticks(2).back().place.x(), 0.0205);
}

TEST_F(LiveHandlePartsTest, ADeviceWithoutTheMotorsIsRefusedBeforeTheSession) {
  const auto result = test::run_command("haptrial " + live(study_of_both()));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("devices.knob wants a torque, which the Force Dimension "
                                       "omega.3 does not give"));
}

}  // namespace
}  // namespace haptrial::experiments::handle_parts_test
