// design.mirror_left_handed: what a left-handed participant feels is the mirror image of what a
// right-handed one does; who is asked for a hand, and when.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/support/stand_in_record.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::mirroring_test {
namespace {

using testing::HasSubstr;

std::string study(const std::string& more = "") {
  return R"([experiment]
protocol = "trials"
name = "sides"
[design]
participants = 2
mirror_left_handed = true
[fields.pull]
type = "constant"
force = [3.0, 1.0, 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.6 }
[[blocks]]
name = "one"
trials = 1
[force_dimension]
index = 0
max_force = 12.0
workspace_radius = 0.075
effector_mass = 0.0
gravity_compensation = true
velocity_window = 0.008
watchdog = 0.02
time_guard = 0.0
stop_button = 0
)" + more;
}

class MirroringTest : public testing::Test {
 protected:
  std::string file(const std::string& text) {
    const std::string name = folder_ / "sides.toml";
    std::ofstream(name) << text;
    return name;
  }
  std::string live(const std::string& subject, const std::string& options) {
    return "run '" + file(study()) + "' --subject " + subject + " --out '" +
           (folder_ / "out").string() + "' --device force-dimension --library '" +
           HAPTRIAL_BINARY_DIR "/libstand_in_dhd.so' --console " + options;
  }
  /// The largest force that reached the motors, in the vendor's axes.
  std::array<double, 3> presented(const std::string& subject, const std::string& hand) {
    const std::string forces = folder_ / subject;
    test::LiveCommand session(live(subject, "--handedness " + hand),
                              "export STAND_IN_FORCES='" + forces + "'");
    test::ConsolePerson person(session.line_after("console: "));
    EXPECT_TRUE(person.sees("instructions")) << session.errors();
    EXPECT_TRUE(person.ask("start"));
    const test::CommandResult result = session.wait();
    EXPECT_EQ(result.status, 0) << result.errors;
    return largest(forces);
  }
  static std::array<double, 3> largest(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    test::ForceRecord::Head head{};
    stream.read(reinterpret_cast<char*>(&head), sizeof head);
    std::array<double, 3> found{};
    test::ForceRecord::Row row{};
    const auto size = [](const auto& f) { return std::hypot(f[0], f[1], f[2]); };
    for (std::int64_t i = 0;
         i < head.count && stream.read(reinterpret_cast<char*>(&row), sizeof row); ++i) {
      found = size(row.force) > size(found) ? row.force : found;
    }
    return found;
  }
  bool is_mirrored(const std::string& subject) const {
    bool found = false;
    for (const record::EventRow& event :
         record::SessionReader(folder_ / "out" / (subject + ".h5")).events()) {
      found = found || event.kind == "mirrored";
    }
    return found;
  }
  test::TemporaryFolder folder_;
};

using LiveMirroringTest = MirroringTest;

TEST_F(LiveMirroringTest, ALeftHandFeelsTheMirrorImage) {
  const auto right = presented("S01", "right");
  const auto left = presented("S02", "left");
  int turned = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::abs(left[axis]), std::abs(right[axis]), 0.05) << axis;
    const bool other = std::abs(left[axis] + right[axis]) < 0.05 && std::abs(right[axis]) > 1.0;
    turned += other ? 1 : 0;
    if (other) {
      EXPECT_NEAR(std::abs(right[axis]), 3.0, 0.1) << "the force along x, and no other";
    }
  }
  EXPECT_EQ(turned, 1);
  EXPECT_FALSE(is_mirrored("S01"));
  EXPECT_TRUE(is_mirrored("S02"));
}

TEST_F(MirroringTest, APersonMustSayWhichHand) {
  const auto result = test::run_command("haptrial " + live("S01", ""));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--handedness is ''; the definition has "
                                       "design.mirror_left_handed, so it must be 'left' or "
                                       "'right'"));
}

TEST_F(MirroringTest, AVirtualParticipantHasNoBetterHand) {
  const auto result =
      test::run_command("haptrial dry-run '" + file(study()) + "' --subjects 1 --out '" +
                        (folder_ / "out").string() + "'");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_FALSE(is_mirrored("S01"));
}

TEST_F(MirroringTest, SeveralDevicesAreRefused) {
  const auto result = test::run_command(
      "haptrial validate '" +
      file(study("[devices.first]\nstart = [0.0, 0.0, 0.0]\n[devices.second]\nstart = [0.0, 0.0, "
                 "0.0]\n")) +
      "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("design.mirror_left_handed is true, but the definition "
                                       "drives several devices"));
}

}  // namespace
}  // namespace haptrial::experiments::mirroring_test
