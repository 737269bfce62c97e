// Haply's devices over a stand-in of the Inverse Service.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/device/catalog.h"
#include "core/device/haply.h"
#include "core/device/vendor_devices.h"
#include "tests/core/device/device_rigs.h"
#include "tests/support/free_port.h"
#include "tests/support/haply_service.h"
#include "tests/support/message_of.h"
#include "tests/support/wait.h"

namespace haptrial::device {
namespace {

using Eigen::Vector3d;
using test::Failure;
using test::HaplyService;
using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

HaplyParameters parameters_of(const HaplyService& service) {
  HaplyParameters parameters;
  parameters.port = service.port();
  return parameters;
}

/// The refusal of a device with these parameters.
std::string refusal(const HaplyParameters& parameters, int number = 0) {
  return message_of<RunError>([&] { HaplyDevice(parameters, test::kRigRate, number); });
}

std::string refusal(const HaplyService& service) { return refusal(parameters_of(service)); }

/// Ticks on the real clock until the condition holds.
template <class Condition>
void tick_until(HaplyDevice& device, const Vector3d& force, const Condition& condition) {
  DeviceReading reading;
  test::wait_until([&] {
    for (int tick = 0; tick < 10; ++tick) {
      device.read(reading);
      device.write(force);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return condition(reading);
  });
}

// A state of the service's documents.
constexpr const char* kState =
    R"({"inverse3":[{"device_id":"049D","state":{"angular_position":{"a0":1.0,"a1":2.0,"a2":3.0},)"
    R"("cursor_position":{"x":0.01,"y":-0.12,"z":0.15},"cursor_velocity":{"x":0.1,"y":0.2,"z":-0.3},)"
    R"("control_mode":"cartesian_force"},"status":{"calibrated":true}}],"wireless_verse_grip":)"
    R"([{"device_id":"61548","state":{"orientation":{"w":0.6,"x":0.0,"y":0.8,"z":0.0},)"
    R"("buttons":{"a":true,"b":false,"c":true}}}]})";

HaplyState read(const std::string& text) { return read_haply_state(text, "049D", "61548", {}); }

TEST(HaplyFrameTest, AStateIsReadAsItStands) {
  const HaplyState state = read(kState);
  EXPECT_EQ(state.fault, HaplyFault::kNone);
  EXPECT_EQ(state.cursor.position, Vector3d(0.01, -0.12, 0.15));
  EXPECT_EQ(state.cursor.velocity, Vector3d(0.1, 0.2, -0.3));
  EXPECT_NEAR(state.orientation.angularDistance(Eigen::Quaterniond(0.6, 0.0, 0.8, 0.0)), 0.0,
              1e-12);
  EXPECT_EQ(state.buttons, 0b101u);
}

TEST(HaplyFrameTest, WhatIsMissingOrWrongIsAFault) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kState;
    text.replace(text.find(from), from.size(), to);
    return read(text).fault;
  };
  EXPECT_EQ(with("049D", "049E"), HaplyFault::kDeviceMissing);
  EXPECT_EQ(with("\"inverse3\"", "\"inverse4\""), HaplyFault::kDeviceMissing);
  EXPECT_EQ(with("61548", "61549"), HaplyFault::kGripMissing);
  EXPECT_EQ(with("cursor_velocity", "cursor_speed"), HaplyFault::kMalformed);
  EXPECT_EQ(with("-0.12", "null"), HaplyFault::kMalformed);
  EXPECT_EQ(with("-0.12", "\"-0.12\""), HaplyFault::kMalformed);
  EXPECT_EQ(with("-0.12", "1e999"), HaplyFault::kMalformed);
  EXPECT_EQ(with("-0.12", "NaN"), HaplyFault::kMalformed);
  EXPECT_EQ(with("\"w\":0.6", "\"w\":0.0"), HaplyFault::kMalformed) << "no unit quaternion";
  EXPECT_EQ(with("\"a\":true", "\"a\":1"), HaplyFault::kMalformed);
  EXPECT_EQ(read("").fault, HaplyFault::kMalformed);
  EXPECT_EQ(read("[]").fault, HaplyFault::kMalformed);
  EXPECT_EQ(read("{}").fault, HaplyFault::kDeviceMissing);
}

TEST(HaplyFrameTest, AStateWithoutAStatusKeepsTheOneBefore) {
  std::string text = kState;
  text.replace(text.find("\"calibrated\":true"), 17, "\"calibrated\":false");
  const HaplyState before = read(text);
  EXPECT_EQ(before.status, HaplyFault::kNotCalibrated);
  text = kState;
  text.erase(text.find(",\"status\""), 29);
  EXPECT_EQ(read_haply_state(text, "049D", "", before).status, HaplyFault::kNotCalibrated);
  EXPECT_EQ(read_haply_state(kState, "049D", "", before).status, HaplyFault::kNone);
}

TEST(HaplyFrameTest, NoDamagedStateIsReadAsNumbersThatAreNone) {
  std::mt19937 random(7);
  int good = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = kState;
    for (std::size_t k = random() % 3 + 1; k > 0 && !text.empty(); --k) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(at, random() % 20);
          break;
        default:
          text.resize(at + 1);
      }
    }
    const HaplyState state = read(text);
    good += state.fault == HaplyFault::kNone ? 1 : 0;
    ASSERT_TRUE(state.fault != HaplyFault::kNone ||
                (state.cursor.position.allFinite() && state.cursor.velocity.allFinite() &&
                 std::abs(state.orientation.norm() - 1.0) < 1e-9))
        << text;
    static_cast<void>(read_haply_inventory(text));
    static_cast<void>(read_haply_version(text));
  }
  EXPECT_GT(good, 100) << "some damage is harmless";
}

TEST(HaplyFrameTest, TheForceIsSpelledAsTheVersionAsks) {
  const std::array<std::pair<const char*, const char*>, 7> spellings{{{"", "values"},
                                                                      {"3.0.7.0", "values"},
                                                                      {"3.4.9", "values"},
                                                                      {"3.5.0.0", "vector"},
                                                                      {"3.10.0", "vector"},
                                                                      {"4.0.0", "vector"},
                                                                      {"nonsense", "values"}}};
  for (const auto& [version, key] : spellings) {
    const HaplyCommands commands("0\"9", version);
    const auto message = nlohmann::json::parse(commands.force({1.5, -2.25, 1e-7}));
    const auto& device = message.at("inverse3").at(0);
    EXPECT_EQ(device.at("device_id"), "0\"9");
    const auto& force = device.at("commands").at("set_cursor_force").at(key);
    EXPECT_EQ(force.at("x"), 1.5) << version;
    EXPECT_EQ(force.at("y"), -2.25);
    EXPECT_NEAR(force.at("z").get<double>(), 1e-7, 1e-12);
    const auto first = nlohmann::json::parse(commands.first());
    EXPECT_EQ(first.at("session").at("configure").at("profile").at("name"), "haptrial");
  }
}

TEST(HaplyFrameTest, TheVersionIsFoundInEitherAnswer) {
  EXPECT_EQ(read_haply_version(R"({"project_version":"3.0.0.0"})"), "3.0.0.0");
  EXPECT_EQ(read_haply_version(R"({"ok":true,"data":{"project_version":"3.5.1"}})"), "3.5.1");
  EXPECT_EQ(read_haply_version("Not Found"), "");
}

class HaplyVersionTest : public testing::TestWithParam<const char*> {};

/// The stand-in takes no other spelling than its own version's.
TEST_P(HaplyVersionTest, TheForceReachesEveryService) {
  HaplyService service({.rate = 1000.0, .version = GetParam()});
  HaplyDevice device(parameters_of(service), test::kRigRate);
  tick_until(device, {0.0, 1.0, 0.0}, [&](const DeviceReading& reading) {
    return reading.tool.position.y() > 0.5 / test::StandInHandle::kStiffness;
  });
  EXPECT_THAT(service.first_message(), HasSubstr("\"haptrial\""));
}

INSTANTIATE_TEST_SUITE_P(All, HaplyVersionTest, testing::Values("3.0.7.0", "3.4.1.0", "3.5.0.0"),
                         [](const auto& version) {
                           std::string name = version.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST(HaplyDeviceTest, AxesButtonsAndTheTurnOfTheGripAreThoseOfTheWorld) {
  HaplyService service({.rate = 0.0});
  HaplyParameters parameters = parameters_of(service);
  parameters.patience = 1.0;
  parameters.origin = {0.01, -0.1, 0.2};
  HaplyDevice device(parameters, test::kRigRate);
  EXPECT_TRUE(device.info().senses_orientation);
  EXPECT_THAT(device.info().name, AllOf(HasSubstr("inverse3"), HasSubstr("right-handed")));
  const double half = std::sqrt(0.5);
  service.turn_grip(half, 0.0, 0.0, half);  // a quarter turn about the service's z, which is up
  service.with_handle([](test::StandInHandle& handle) { handle.buttons = 0b110; });
  service.step();
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading));
  // The stand-in's middle is (0, -0.12, 0.15): to the left, towards the user and below the origin.
  EXPECT_LT((reading.tool.position - Vector3d(-0.01, -0.05, 0.02)).norm(), 1e-12);
  EXPECT_LT((reading.orientation * Vector3d::UnitY() - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((reading.orientation * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_EQ(reading.buttons, 0b110u);
  EXPECT_TRUE(reading.stop_pressed);
}

TEST(HaplyDeviceTest, WithoutAGripThereIsNeitherTurnNorStopButton) {
  HaplyService service({.rate = 0.0, .grips = {}});
  HaplyParameters parameters = parameters_of(service);
  parameters.patience = 1.0;
  HaplyDevice device(parameters, test::kRigRate);
  EXPECT_FALSE(device.info().senses_orientation);
  service.step();
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading)) << device.trouble();
  EXPECT_EQ(reading.orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_FALSE(reading.stop_pressed);
}

TEST(HaplyDeviceTest, AForceAboveTheLimitKeepsItsDirection) {
  HaplyService service({.rate = 0.0});
  HaplyParameters parameters = parameters_of(service);
  parameters.patience = 1.0;
  parameters.max_force = 2.5;
  HaplyDevice device(parameters, test::kRigRate);
  EXPECT_EQ(device.info().max_force, 2.5);
  for (int i = 0; i < 3; ++i) {
    device.write(Eigen::Vector3d(3.0, 0.0, -4.0));
    service.step();
  }
  const auto force = service.force();
  EXPECT_NEAR(force[0], 1.5, 1e-5);
  EXPECT_NEAR(force[1], 2.0, 1e-5);
  EXPECT_EQ(force[2], 0.0);
}

TEST(HaplyDeviceTest, TheWorkspaceIsAtMostTheModels) {
  const HaplyService small({.type = "minverse"});
  EXPECT_EQ(HaplyDevice(parameters_of(small), test::kRigRate).info().workspace_radius, 0.04);
  const HaplyService large({.type = "inverse3x"});
  HaplyParameters parameters = parameters_of(large);
  EXPECT_EQ(HaplyDevice(parameters, test::kRigRate).info().workspace_radius, 0.1);
  parameters.workspace_radius = 0.05;
  EXPECT_EQ(HaplyDevice(parameters, test::kRigRate).info().workspace_radius, 0.05);
}

TEST(HaplyDeviceTest, TheOneThatIsNamedIsDriven) {
  const HaplyService service({.devices = {"049D", "B2", "C3"}, .grips = {"61548", "7"}});
  HaplyParameters parameters = parameters_of(service);
  const auto name = [&](int number) {
    return HaplyDevice(parameters, test::kRigRate, number).info().name;
  };
  EXPECT_THAT(name(0), HasSubstr("049D"));
  EXPECT_THAT(name(1), HasSubstr("B2"));
  parameters.device_id = "C3";
  parameters.grip_id = "7";
  EXPECT_THAT(name(0), HasSubstr("C3"));
  EXPECT_THAT(name(1), HasSubstr("049D"));
  parameters.device_id = "D4";
  EXPECT_THAT(refusal(parameters), HasSubstr("no device 'D4'; it lists: 049D, B2, C3"));
  parameters.device_id = "";
  parameters.grip_id = "8";
  EXPECT_THAT(refusal(parameters), HasSubstr("no grip '8'; it lists: 61548, 7"));
  parameters.grip_id = "";
  EXPECT_THAT(refusal(parameters, 3), HasSubstr("3 of the 4 devices"));
}

TEST(HaplyDeviceTest, WhatCannotBeDrivenIsASentence) {
  HaplyParameters nobody;
  nobody.port = test::free_port();
  EXPECT_THAT(refusal(nobody), AllOf(HasSubstr("no Haply Inverse Service answers on port " +
                                               std::to_string(nobody.port)),
                                     HasSubstr("haply-inverse-service")));
  const HaplyService empty({.devices = {}, .grips = {}});
  EXPECT_THAT(refusal(empty), HasSubstr("lists no device; check cable"));
  const HaplyService turned({.basis = "XZY"});
  EXPECT_THAT(refusal(turned), HasSubstr("allowed: its own axes"));
  HaplyService dark;
  dark.fail(Failure::kNoPower);
  EXPECT_THAT(refusal(dark), HasSubstr("no power supply"));
}

/// Another program may sit on the port, one that hangs up at once or one that says nothing.
TEST(HaplyDeviceTest, AnotherProgramOnThePortIsASentence) {
  for (const bool hangs_up : {true, false}) {
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    const auto port = static_cast<unsigned short>(test::free_port());
    const boost::asio::ip::tcp::endpoint endpoint(boost::asio::ip::address_v4::loopback(), port);
    ASSERT_EQ(::bind(listener, endpoint.data(), static_cast<socklen_t>(endpoint.size())), 0);
    ASSERT_EQ(::listen(listener, 4), 0);
    std::thread other([&] {
      if (hangs_up) {
        ::close(::accept(listener, nullptr, nullptr));
      }
    });
    HaplyParameters parameters;
    parameters.port = port;
    EXPECT_THAT(refusal(parameters), HasSubstr("not as Haply's Inverse Service does"));
    other.join();
    ::close(listener);
  }
}

TEST(HaplyDeviceTest, WithoutCommandsTheForceGoes) {
  HaplyService service;
  HaplyDevice device(parameters_of(service), test::kRigRate);
  tick_until(device, {0.0, 1.0, 0.0},
             [&](const DeviceReading&) { return service.force_size() > 0.5; });
  test::wait_until([&] { return service.force_size() == 0.0; });
  const long messages = service.messages();
  test::wait_until([&] { return service.messages() > messages + 20; });
  EXPECT_EQ(service.force_size(), 0.0) << "the link still talks, but commands nothing";
}

TEST(HaplyDeviceTest, AServiceThatDiedIsAFaultUntilTheDeviceIsOpenedAnew) {
  auto service = std::make_unique<HaplyService>();
  const HaplyParameters parameters = parameters_of(*service);
  auto device = std::make_unique<HaplyDevice>(parameters, test::kRigRate);
  DeviceReading reading;
  ASSERT_TRUE(device->read(reading));
  service->kill();
  test::wait_until([&] { return !device->read(reading); });
  service = std::make_unique<HaplyService>(HaplyService::Options{.port = parameters.port});
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(device->read(reading));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_THAT(device->trouble(), HasSubstr("start the service again"));
  device = std::make_unique<HaplyDevice>(parameters, test::kRigRate);
  EXPECT_TRUE(device->read(reading)) << device->trouble();
}

TEST(HaplyDeviceTest, AFaultOfOneStateIsNotLost) {
  HaplyService service({.rate = 0.0});
  HaplyParameters parameters = parameters_of(service);
  parameters.patience = 1.0;
  HaplyDevice device(parameters, test::kRigRate);
  service.fail(Failure::kMalformed);
  service.step();
  service.fail(Failure::kNone);
  service.step();  // a good state before anybody looked
  DeviceReading reading;
  EXPECT_FALSE(device.read(reading));
  EXPECT_THAT(device.trouble(), HasSubstr("cannot be read"));
}

TEST(HaplyDeviceTest, TheListSaysWhatIsConnected) {
  const auto* const haply = vendor_device("haply");
  ASSERT_NE(haply, nullptr);
  const auto list = list_devices();
  const auto listed = std::ranges::find(list, "haply", &DeviceListing::name);
  ASSERT_NE(listed, list.end());
  if (!listed->available) {
    EXPECT_THAT(listed->what, HasSubstr("Inverse Service"));
  }
}

TEST(HaplyDeviceTest, ParametersAreReadWithTheirBounds) {
  Table table = Table::parse(
      "port = 10002\ndevice_id = \"049D\"\ngrip_id = \"61548\"\nmax_force = 3.0\n"
      "workspace_radius = 0.08\norigin = [0.0, -0.1, 0.2]\npatience = 0.01\nstop_button = -1\n",
      "f.toml");
  const HaplyParameters p = haply_schema().read(table);
  EXPECT_NO_THROW(table.finish());
  EXPECT_EQ(p.port, 10002);
  EXPECT_EQ(p.device_id, "049D");
  EXPECT_EQ(p.origin, Vector3d(0.0, -0.1, 0.2));
  EXPECT_EQ(p.stop_button, -1);
  Table off = Table::parse(
      "max_force = 3.0\nworkspace_radius = 0.08\npatience = 0.01\nstop_button = 3\n", "f.toml");
  haply_schema().read(off);
  EXPECT_THAT(message_of<InputError>([&] { off.finish(); }), HasSubstr("stop_button is 3"));
}

TEST(VendorDevicesTest, EachHasItsOwnTableAndItsOwnSetUp) {
  std::set<std::string> tables;
  for (const VendorDevice& device : vendor_devices()) {
    EXPECT_TRUE(tables.insert(device.table).second) << device.name;
    EXPECT_EQ(vendor_device(device.name), &device);
    VendorSetups setups;
    const std::array buttons{&setups.force_dimension.stop_button, &setups.open_haptics.stop_button,
                             &setups.haply.stop_button, &setups.paddle.stop_button};
    std::ranges::for_each(buttons, [](int* button) { *button = 1; });
    device.free_stop_button(setups);
    const auto freed = std::ranges::count_if(buttons, [](const int* b) { return *b == -1; });
    EXPECT_EQ(freed, device.has_buttons(setups) || device.name == std::string("paddle") ? 1 : 0)
        << device.name;
    EXPECT_GT(device.limits(setups).max_force, 0.0);
  }
  EXPECT_EQ(vendor_device("falcon9"), nullptr);
}

}  // namespace
}  // namespace haptrial::device
