// Parts of drivers that the one suite over every device does not test: how the vendors' devices are
// set up, and what each of their failures is called.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/device/catalog.h"
#include "core/device/force_dimension.h"
#include "core/device/gamepad.h"
#include "core/device/open_haptics.h"
#include "core/device/serial_board.h"
#include "tests/core/device/device_rigs.h"
#include "tests/support/message_of.h"

namespace haptrial::device {
namespace {

using Eigen::Vector3d;
using test::Failure;
using test::kRigRate;
using test::message_of;
using test::StandIn;
using testing::AllOf;
using testing::HasSubstr;

std::vector<std::string> calls(const test::StandInSetup& setup) {
  std::istringstream text(setup.calls);
  return {std::istream_iterator<std::string>(text), {}};
}

/// Functions of `wanted` that were called, in the order of the calls.
std::vector<std::string> order(const test::StandInSetup& setup,
                               const std::vector<std::string>& wanted) {
  std::vector<std::string> found;
  for (const std::string& call : calls(setup)) {
    if (std::find(wanted.begin(), wanted.end(), call) != wanted.end()) {
      found.push_back(call);
    }
  }
  return found;
}

TEST(DynamicLibraryTest, AnAbsentLibraryIsNamedWithWhereToGetIt) {
  const std::string words =
      message_of<InputError>([] { DynamicLibrary("libnowhere.so.9", "the SDK of nobody"); });
  EXPECT_THAT(words, AllOf(HasSubstr("libnowhere.so.9"), HasSubstr("the SDK of nobody")));
  EXPECT_EQ(words.find('\n'), std::string::npos);
}

TEST(DynamicLibraryTest, AnAbsentFunctionIsNamedOrNull) {
  const StandIn stand_in("stand_in_dhd");
  void (*function)() = nullptr;
  EXPECT_THAT(message_of<InputError>([&] { stand_in.library.get(function, "dhdNoSuch"); }),
              AllOf(HasSubstr("dhdNoSuch"), HasSubstr("libstand_in_dhd.so")));
  stand_in.library.find(function, "dhdNoSuch");
  EXPECT_EQ(function, nullptr);
}

TEST(DynamicLibraryTest, ALibraryOfSomethingElseIsRefused) {
  const std::string path = std::string(HAPTRIAL_BINARY_DIR) + "/libstand_in_hd.so";
  EXPECT_THAT(message_of<InputError>([&] { ForceDimensionDevice({}, kRigRate, path); }),
              HasSubstr("dhdGetDeviceCount"));
}

TEST(ForceDimensionTest, EverySettingIsMadeInTheVendorsUnits) {
  const StandIn stand_in("stand_in_dhd");
  ForceDimensionParameters p;
  p.max_force = 9.0;
  p.effector_mass = 0.19;
  p.velocity_window = 0.012;
  p.watchdog = 0.01;
  p.velocity_threshold = 33;
  p.time_guard = 0.0004;
  const ForceDimensionDevice device(p, kRigRate, stand_in.path);
  const test::StandInSetup set = stand_in.setup();
  EXPECT_EQ(set.max_force, 9.0);
  EXPECT_EQ(set.effector_mass, 0.19);
  EXPECT_EQ(set.gravity, 1);
  EXPECT_EQ(set.window_ms, 12);
  EXPECT_EQ(set.window_mode, 0);
  EXPECT_EQ(set.watchdog, 80) << "steps of 125 µs";
  EXPECT_EQ(set.threshold, 33);
  EXPECT_EQ(set.time_guard_us, 400);
  EXPECT_TRUE(stand_in.look().forces_on);
  EXPECT_THAT(device.info().name, HasSubstr("omega.3"));
  EXPECT_EQ(device.info().max_force, 9.0);
  EXPECT_FALSE(device.info().simulated);
}

TEST(ForceDimensionTest, ADefinitionMayNotClaimMoreForceThanTheModelGives) {
  const StandIn stand_in("stand_in_dhd");  // an omega.3
  ForceDimensionParameters p;
  p.max_force = 12.5;
  EXPECT_THAT(
      message_of<InputError>([&] { ForceDimensionDevice(p, kRigRate, stand_in.path); }),
      AllOf(HasSubstr("max_force is 12.5 N"), HasSubstr("at most 12 N"), HasSubstr("omega.3")));
}

TEST(ForceDimensionTest, StartsInTheVendorsOrder) {
  const std::vector<std::string> all{"drdOpen", "dhdOpen", "auto_init", "drdStop",
                                     "mass",    "gravity", "window",    "force_on"};
  const StandIn both("stand_in_dhd");
  { const ForceDimensionDevice device({}, kRigRate, both.path); }
  EXPECT_EQ(order(both.setup(), all), all);
  const StandIn alone("stand_in_dhd_only");
  { const ForceDimensionDevice device({}, kRigRate, alone.path); }
  EXPECT_EQ(order(alone.setup(), all),
            (std::vector<std::string>{"dhdOpen", "mass", "gravity", "window", "force_on"}));
  EXPECT_EQ(order(both.setup(), {"force_off", "stop", "dhdClose"}),
            (std::vector<std::string>{"force_off", "stop", "dhdClose"}));
}

TEST(ForceDimensionTest, TheMakersVelocityThresholdIsKeptUnlessOneIsGiven) {
  const StandIn stand_in("stand_in_dhd");
  const ForceDimensionDevice device({}, kRigRate, stand_in.path);
  EXPECT_TRUE(order(stand_in.setup(), {"threshold"}).empty());
  EXPECT_EQ(order(stand_in.setup(), {"watchdog"}).size(), 1u) << "which is never off";
}

TEST(ForceDimensionTest, ItsStopButtonIsThatOfTheHandleUnlessThereIsNone) {
  const StandIn stand_in("stand_in_dhd");
  ForceDimensionParameters p;
  for (const int button : {0, -1}) {
    p.stop_button = button;
    ForceDimensionDevice device(p, kRigRate, stand_in.path);
    for (const unsigned pressed : {0u, 1u, 2u}) {
      stand_in.buttons(pressed);
      DeviceReading reading;
      ASSERT_TRUE(device.read(reading));
      EXPECT_EQ(reading.buttons, pressed);
      EXPECT_EQ(reading.stop_pressed, button == 0 && pressed == 1u);
    }
    stand_in.buttons(0);
  }
}

TEST(ForceDimensionTest, ForcesReachTheMotorsInTheVendorsAxes) {
  const StandIn stand_in("stand_in_dhd");
  ForceDimensionDevice device({}, kRigRate, stand_in.path);
  ASSERT_TRUE(device.write(Eigen::Vector3d(1.0, 2.0, 3.0)));  // right, up, to the user
  const test::StandInView seen = stand_in.look();
  EXPECT_EQ(seen.force[0], 3.0) << "x is to the user";
  EXPECT_EQ(seen.force[1], 1.0) << "y is to the right";
  EXPECT_EQ(seen.force[2], 2.0) << "z is up";
}

TEST(ForceDimensionTest, SaysWhyForcesWentOffOrALinkWasLost) {
  const std::pair<Failure, const char*> cases[] = {{Failure::kForcesOffByButton, "button"},
                                                   {Failure::kForcesOffByVelocity, "too fast"},
                                                   {Failure::kForcesOffByWatchdog, "watchdog"},
                                                   {Failure::kLostLink, "communication"},
                                                   {Failure::kTimeout, "in time"}};
  for (const auto& [failure, word] : cases) {
    const StandIn stand_in("stand_in_dhd");
    ForceDimensionDevice device({}, kRigRate, stand_in.path);
    stand_in.fail(static_cast<int>(failure), 5);
    DeviceReading reading;
    bool well = true;
    for (int tick = 0; tick < 10 && well; ++tick) {
      device.write(Eigen::Vector3d(1.0, 0.0, 0.0));
      well = device.read(reading) && reading.forces_on;
    }
    EXPECT_FALSE(well) << word;
    EXPECT_THAT(device.trouble(), HasSubstr(word));
  }
}

TEST(ForceDimensionTest, AFailedReadLeavesTheReadingAlone) {
  const StandIn stand_in("stand_in_dhd");
  ForceDimensionDevice device({}, kRigRate, stand_in.path);
  stand_in.fail(static_cast<int>(Failure::kLostLink), 0);
  DeviceReading reading;
  reading.tool.position = {1.0, 2.0, 3.0};
  EXPECT_FALSE(device.read(reading));
  EXPECT_EQ(reading.tool.position, Vector3d(1.0, 2.0, 3.0));
}

TEST(ForceDimensionTest, SlowCallsAreCountedAndSaturationIsNoFailure) {
  const StandIn stand_in("stand_in_dhd");
  ForceDimensionDevice device({}, kRigRate, stand_in.path);
  DeviceReading reading;
  stand_in.fail(static_cast<int>(Failure::kSlowCall), 0);
  const std::uint64_t before = device.slow_calls();
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(device.read(reading));
  }
  EXPECT_GE(device.slow_calls(), before + 3);
  EXPECT_TRUE(device.write(Eigen::Vector3d(0.0, 20.0, 0.0)));
  EXPECT_EQ(stand_in.look().force[2], 12.0);
}

TEST(ForceDimensionTest, NoDeviceIsAFailureAndASentence) {
  const StandIn stand_in("stand_in_dhd");
  stand_in.fail(static_cast<int>(Failure::kNoDevice), 0);
  EXPECT_THAT(message_of<RunError>([&] { ForceDimensionDevice({}, kRigRate, stand_in.path); }),
              AllOf(HasSubstr("not found"), HasSubstr("cable")));
}

TEST(ForceDimensionTest, ParametersOutOfBoundsAreRefused) {
  const auto refused = [](auto change) {
    ForceDimensionParameters p;
    change(p);
    EXPECT_THROW(ForceDimensionDevice(p, kRigRate), std::invalid_argument);
  };
  refused([](auto& p) { p.watchdog = 0.0; });
  refused([](auto& p) { p.watchdog = 0.04; });
  refused([](auto& p) { p.max_force = 0.0; });
  refused([](auto& p) { p.effector_mass = -0.1; });
  refused([](auto& p) { p.index = 4; });
  refused([](auto& p) { p.velocity_window = 0.0; });
}

TEST(ForceDimensionTest, ParametersAreReadWithTheirBounds) {
  const std::string text =
      "index = 1\nmax_force = 12.0\nworkspace_radius = 0.075\neffector_mass = 0.1\n"
      "gravity_compensation = false\nvelocity_window = 0.02\nwatchdog = 0.01\ntime_guard = 0.0\n"
      "stop_button = 2\n";
  Table table = Table::parse(text, "f.toml");
  const ForceDimensionParameters p = force_dimension_schema().read(table);
  EXPECT_NO_THROW(table.finish());
  EXPECT_EQ(p.index, 1);
  EXPECT_FALSE(p.gravity_compensation);
  EXPECT_EQ(p.velocity_threshold, -1);
  EXPECT_EQ(p.stop_button, 2);
  Table off = Table::parse(text + "velocity_threshold = -5\n", "f.toml");
  force_dimension_schema().read(off);
  EXPECT_THROW(off.finish(), InputError);
}

/// An OpenHaptics device whose scheduler is stepped by hand.
class OpenHapticsTest : public testing::Test {
 protected:
  OpenHapticsTest() { stand_in_.manual(1); }
  ~OpenHapticsTest() override { stand_in_.manual(0); }
  StandIn stand_in_{"stand_in_hd"};
};

TEST_F(OpenHapticsTest, StartsWithForcesOnAtItsRate) {
  const OpenHapticsDevice device({}, 500.0, stand_in_.path);
  EXPECT_EQ(stand_in_.setup().rate, 500.0);
  EXPECT_TRUE(stand_in_.look().forces_on);
  const std::vector<std::string> all{"init", "current", "enable", "schedule", "start"};
  EXPECT_EQ(order(stand_in_.setup(), all), all);
  EXPECT_EQ(device.info().max_force, 3.3) << "the nominal one";
}

TEST_F(OpenHapticsTest, TheSmallerForceLimitHolds) {
  OpenHapticsParameters p;
  p.max_force = 2.0;
  EXPECT_EQ(OpenHapticsDevice(p, kRigRate, stand_in_.path).info().max_force, 2.0);
}

TEST_F(OpenHapticsTest, WithoutCommandsTheSchedulerLetsTheForceGo) {
  OpenHapticsDevice device({}, kRigRate, stand_in_.path);
  device.write(Eigen::Vector3d(1.0, 2.0, -3.0));
  stand_in_.step();
  EXPECT_EQ(stand_in_.look().force[0], 1.0);
  EXPECT_EQ(stand_in_.look().force[1], 2.0);
  EXPECT_EQ(stand_in_.look().force[2], -3.0) << "the vendor's axes are ours";
  int held = 0;
  for (; stand_in_.look().force[0] != 0.0 && held < 100; ++held) {
    stand_in_.step();
  }
  EXPECT_NEAR(held, 20, 2) << "patience is 20 ms";
}

TEST_F(OpenHapticsTest, AnErrorOfOneFrameIsNotLost) {
  OpenHapticsDevice device({}, kRigRate, stand_in_.path);
  DeviceReading reading;
  stand_in_.fail(static_cast<int>(Failure::kMotorsWarm), 0);
  stand_in_.step();
  stand_in_.fail(static_cast<int>(Failure::kNone), 0);
  stand_in_.step();  // a good frame before anybody looked
  ASSERT_TRUE(device.read(reading));
  EXPECT_FALSE(reading.forces_on);
  EXPECT_THAT(device.trouble(), HasSubstr("warm"));
}

TEST_F(OpenHapticsTest, NoDeviceIsAFailureAndASentence) {
  stand_in_.fail(static_cast<int>(Failure::kNoDevice), 0);
  EXPECT_THAT(message_of<RunError>([&] { OpenHapticsDevice({}, kRigRate, stand_in_.path); }),
              HasSubstr("cable"));
}

TEST_F(OpenHapticsTest, RunsWithTheVendorsOwnThread) {
  stand_in_.manual(0);
  OpenHapticsDevice device({}, kRigRate, stand_in_.path);
  DeviceReading reading;
  double farthest = 0.0;
  for (int tick = 0; tick < 300; ++tick) {
    ASSERT_TRUE(device.read(reading)) << device.trouble();
    device.write(Eigen::Vector3d(0.0, 1.0, 0.0));
    farthest = std::max(farthest, reading.tool.position.y());
    const timespec pause{0, 1'000'000};
    nanosleep(&pause, nullptr);
  }
  EXPECT_NEAR(farthest, 1.0 / 200.0, 1e-3) << "1 N on 200 N/m";
}

TEST_F(OpenHapticsTest, ParametersAreReadWithTheirBounds) {
  Table table = Table::parse(
      "name = \"Touch\"\nmax_force = 3.0\nworkspace_radius = 0.07\npatience = 0.01\n"
      "stop_button = 0\n",
      "f.toml");
  const OpenHapticsParameters p = open_haptics_schema().read(table);
  EXPECT_NO_THROW(table.finish());
  EXPECT_EQ(p.name, "Touch");
  EXPECT_EQ(p.patience, 0.01);
  EXPECT_EQ(p.stop_button, 0);
}

TEST_F(OpenHapticsTest, ItsStopButtonIsTheSecondOneUnlessAnotherIsNamed) {
  OpenHapticsParameters p;
  for (const int button : {1, 0, -1}) {
    p.stop_button = button;
    OpenHapticsDevice device(p, kRigRate, stand_in_.path);
    for (const unsigned pressed : {0u, 1u, 2u}) {
      stand_in_.buttons(pressed);
      stand_in_.step();
      DeviceReading reading;
      ASSERT_TRUE(device.read(reading));
      EXPECT_EQ(reading.stop_pressed, button >= 0 && pressed == (1u << button)) << button;
    }
  }
}

TEST(CatalogTest, SaysWhatIsThereAndWhatIsMissing) {
  const StandIn plugged_in("stand_in_dhd");
  const auto here =
      list_devices({{"force-dimension", std::string(HAPTRIAL_BINARY_DIR) + "/libstand_in_dhd.so"},
                    {"open-haptics", std::string(HAPTRIAL_BINARY_DIR) + "/libstand_in_hd.so"}});
  ASSERT_EQ(here.size(), 9u);
  for (const DeviceListing& listing : here) {
    const bool board = listing.name == "hapi" || listing.name == "paddle";
    const bool wanted = board                       ? !find_serial_lines().empty()
                        : listing.name == "gamepad" ? !find_gamepads().empty()
                                                    : true;
    EXPECT_TRUE(listing.available == wanted || listing.name == "haply")  // a computer may have it
        << listing.name << ": " << listing.what;
  }
  const auto missing = list_devices(
      {{"force-dimension", "libnowhere_dhd.so"}, {"open-haptics", "libnowhere_hd.so"}});
  EXPECT_EQ(missing[4].name, "force-dimension");
  EXPECT_FALSE(missing[4].available);
  EXPECT_THAT(missing[4].what, AllOf(HasSubstr("libnowhere_dhd.so"), HasSubstr("https://")));
  EXPECT_EQ(missing[5].name, "open-haptics");
  EXPECT_FALSE(missing[5].available);
  EXPECT_THAT(missing[5].what, AllOf(HasSubstr("libnowhere_hd.so"), HasSubstr("https://")));
}

TEST(CatalogTest, ALibraryWithoutADeviceIsTold) {
  const StandIn stand_in("stand_in_dhd");
  stand_in.fail(static_cast<int>(Failure::kNoDevice), 0);
  const auto list = list_devices({{"force-dimension", stand_in.path}});
  EXPECT_FALSE(list[4].available);
  EXPECT_THAT(list[4].what, HasSubstr("no device answers"));
}

/// A quarter turn about an axis, by rows.
using Rows = std::array<double, 9>;

TEST(ForceDimensionTest, AWristsTurnIsMappedLikeItsPositions) {
  const StandIn stand_in("stand_in_dhd");
  // About the vendor's z, which points up: that is our y, so that our z turns to our x.
  const Rows about_up{0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  stand_in.turn(about_up.data());
  ForceDimensionDevice device({}, kRigRate, stand_in.path);
  EXPECT_TRUE(device.info().senses_orientation);
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading));
  EXPECT_LT((reading.orientation * Vector3d::UnitY() - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((reading.orientation * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 1e-12);
}

TEST(ForceDimensionTest, WithoutAWristNothingIsTurned) {
  const StandIn stand_in("stand_in_dhd");
  ForceDimensionDevice device({}, kRigRate, stand_in.path);
  EXPECT_FALSE(device.info().senses_orientation);
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading));
  EXPECT_EQ(reading.orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(OpenHapticsStylusTest, ItsTurnComesFromItsTransform) {
  const StandIn stand_in("stand_in_hd");
  stand_in.manual(1);
  const Rows about_x{1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0};
  stand_in.turn(about_x.data());
  OpenHapticsDevice device({}, kRigRate, stand_in.path);
  EXPECT_TRUE(device.info().senses_orientation);
  stand_in.step();
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading));
  EXPECT_LT((reading.orientation * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-12);
  stand_in.manual(0);
}

}  // namespace
}  // namespace haptrial::device
