// Boards on pseudo-terminals: their messages byte by byte, restarts, faults, ends; the tables that
// set them up.

#include "core/device/serial_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/device/hapi_board.h"
#include "core/device/paddle_board.h"
#include "tests/core/device/device_rigs.h"
#include "tests/support/boards/simulated_board.h"
#include "tests/support/message_of.h"
#include "tests/support/wait.h"

namespace haptrial::device {
namespace {

using Eigen::Vector3d;
using test::BoardFailure;
using test::HapiFirmware;
using test::message_of;
using test::PaddleFirmware;
using test::SimulatedBoard;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kRate = 1000.0;  // [Hz]

std::string bytes(std::initializer_list<int> numbers) {
  std::string all;
  for (const int number : numbers) {
    all.push_back(static_cast<char>(number));
  }
  return all;
}

HapiParameters hapi_on(const std::string& port) {
  HapiParameters parameters;
  parameters.line.port = port;
  return parameters;
}

/// Ticks of a loop until the condition holds.
template <class Condition>
void tick_board_until(SerialBoard& device, const Vector3d& force, const Condition& condition) {
  test::wait_until([&] {
    DeviceReading reading;
    const bool read = device.read(reading);
    device.write(force);
    return condition(read, reading);
  });
}

TEST(HapiProtocolTest, TheSetUpNamesPortsDirectionsOffsetsAndResolutionsInTheOrderOfPorts) {
  HapiParameters p;
  p.encoder_offset = {180.0, 1.5};
  p.encoder_resolution = 4096.0;
  p.clockwise = {2};
  // 1.5 is 0x3fc00000, 4096 is 0x45800000, 180 is 0x43340000; motor 2 is at port 1.
  const std::string numbers =
      bytes({0, 0, 0xc0, 0x3f, 0, 0, 0x80, 0x45, 0, 0, 0x34, 0x43, 0, 0, 0x80, 0x45});
  EXPECT_EQ(hapi_protocol(p)->start_message(), bytes({1, 5, 3, 0, 1, 3, 0, 1, 0, 0}) + numbers);
  p.firmware = HapiParameters::Firmware::kPorts;
  EXPECT_EQ(hapi_protocol(p)->start_message(), bytes({0x03, 5}) + numbers);
  p.mechanism = HapiParameters::Mechanism::kLever;
  p.ports = {4};
  EXPECT_EQ(hapi_protocol(p)->start_message(),
            bytes({0x08, 5, 0, 0, 0x34, 0x43, 0, 0, 0x80, 0x45}));
}

TEST(HapiProtocolTest, ALeversTorqueIsItsForceTimesItsArm) {
  HapiParameters p;
  p.mechanism = HapiParameters::Mechanism::kLever;
  p.ports = {1};
  p.bars.arm = 0.0625;
  p.motors = HapiParameters::Side::kNear;
  const auto protocol = hapi_protocol(p);
  EXPECT_EQ(force_axes(p), Vector3d::UnitX());
  EXPECT_EQ(protocol->force_message({2.0, 1.0, 1.0}), bytes({2, 5, 0, 0, 0, 0}))
      << "no force before the first reading";
  const auto reading = protocol->take(bytes({5, 0, 0, 0x34, 0x42}));  // 45 degrees
  ASSERT_TRUE(reading);
  EXPECT_NEAR(reading->position.x(), 0.0625 * std::acos(-1.0) / 4.0, 1e-9);
  EXPECT_EQ(protocol->force_message({2.0, 1.0, 1.0}), bytes({2, 5, 0, 0, 0, 0x3e})) << "1/8 N·m";
}

TEST(HapiProtocolTest, AReadingMayComeInPiecesAndWhatIsNoneIsPassedOver) {
  HapiParameters p;
  p.mechanism = HapiParameters::Mechanism::kLever;
  const auto protocol = hapi_protocol(p);
  EXPECT_FALSE(protocol->take(bytes({7, 5, 0})));
  EXPECT_FALSE(protocol->take(bytes({0, 0x34})));
  EXPECT_TRUE(protocol->take(bytes({0x42})));
  EXPECT_FALSE(protocol->take(bytes({5, 0, 0, 0xc0, 0x7f}))) << "not a number";
  EXPECT_FALSE(protocol->take(bytes({5, 0, 0, 0x34, 0x7f}))) << "an angle of no encoder";
  EXPECT_EQ(protocol->misunderstood(), "05 00 00 34 7f");
  protocol->forget();
  EXPECT_FALSE(protocol->take(bytes({5, 0})));
  protocol->forget();
  EXPECT_TRUE(protocol->take(bytes({5, 0, 0, 0x34, 0x42}))) << "the torn one is forgotten";
}

TEST(HapiBoardTest, EachSideOfTheMotorsHasItsOwnPlane) {
  using Side = HapiParameters::Side;
  const std::pair<Side, Vector3d> cases[]{{Side::kFar, {-0.01, 0.0, 0.02}},
                                          {Side::kNear, {0.01, 0.0, -0.02}},
                                          {Side::kBelow, {0.01, 0.02, 0.0}},
                                          {Side::kAbove, {-0.01, -0.02, 0.0}}};
  HapiFirmware firmware;
  firmware.angles = 180.0 / std::acos(-1.0) * HapiFirmware::angles_at({0.029, 0.12});
  for (const auto& [side, expected] : cases) {
    HapiParameters p;
    p.motors = side;
    const auto reading = hapi_protocol(p)->take(firmware.reading(Vector3d::Zero(), 0));
    ASSERT_TRUE(reading);
    EXPECT_LT((reading->position - expected).norm(), 1e-7);
    EXPECT_EQ(force_axes(p), Vector3d(1.0, expected.y() != 0.0, expected.z() != 0.0));
  }
}

TEST(HapiBoardTest, WaitsForABoardThatRestartsAndSetsItUp) {
  for (const bool first : {false, true}) {
    auto owned = std::make_unique<HapiFirmware>();
    HapiFirmware& firmware = *owned;
    firmware.first_firmware = first;
    SimulatedBoard board(std::move(owned), {1.0, 0.0, 1.0});
    board.start(700);
    HapiParameters p = hapi_on(board.port());
    p.firmware = first ? HapiParameters::Firmware::kPorts : HapiParameters::Firmware::kCurrent;
    p.line.start_time = 60.0;
    open_hapi_board(p, kRate);
    board.stop();
    EXPECT_GE(firmware.setup.count, 1);
    EXPECT_EQ(firmware.setup.motor_ports, 3u);
    EXPECT_EQ(firmware.setup.encoder_ports, 3u);
    EXPECT_EQ(firmware.setup.directions, first ? "" : bytes({1, 1, 1, 1}));
    EXPECT_EQ(firmware.setup.offset[0], 12.0F) << "port 1 has motor 2";
    EXPECT_EQ(firmware.setup.offset[1], 168.0F);
    EXPECT_EQ(firmware.setup.resolution[1], 4880.0F);
  }
}

TEST(HapiBoardTest, WithItsArmsInLineItGivesNoForceAndSaysWhy) {
  auto owned = std::make_unique<HapiFirmware>();
  HapiFirmware& firmware = *owned;
  SimulatedBoard board(std::move(owned), {1.0, 0.0, 1.0});
  board.start();
  const auto device = open_hapi_board(hapi_on(board.port()), kRate);
  tick_board_until(*device, {1.0, 0.0, 0.0}, [&](bool read, const DeviceReading& reading) {
    return read && reading.tool.position.x() > 1e-3;
  });
  board.stop();
  firmware.angles = {{74.0, 106.0}};
  board.start();
  tick_board_until(*device, {1.0, 0.0, 0.0}, [](bool read, const DeviceReading&) { return !read; });
  EXPECT_THAT(device->trouble(), HasSubstr("in line"));
  for (const std::uint64_t seen = device->readings(); device->readings() < seen + 3;) {
    DeviceReading reading;
    EXPECT_FALSE(device->read(reading));
    device->write(Eigen::Vector3d(1.0, 0.0, 0.0));
  }
  board.stop();
  EXPECT_EQ(firmware.torque[0], 0.0);
  EXPECT_EQ(firmware.torque[1], 0.0);
}

TEST(SerialBoardTest, WithoutCommandsTheBoardIsGivenNoForce) {
  for (const bool paddle : {false, true}) {
    std::unique_ptr<test::BoardFirmware> firmware;
    if (paddle) {
      firmware = std::make_unique<PaddleFirmware>();
    } else {
      firmware = std::make_unique<HapiFirmware>();
    }
    SimulatedBoard board(std::move(firmware), Vector3d::UnitX());
    board.start();
    const auto device = paddle ? open_paddle_board(test::example_paddle(board.port()), kRate)
                               : open_hapi_board(hapi_on(board.port()), kRate);
    tick_board_until(*device, {1.0, 0.0, 0.0}, [](bool read, const DeviceReading& reading) {
      return read && reading.tool.position.x() > 2e-3;
    });
    DeviceReading reading;
    test::wait_until([&] {  // the loop reads, but commands nothing
      return device->read(reading) && reading.tool.position.x() < 1e-4;
    });
    board.stop();
    EXPECT_LT(board.force().norm(), 1e-12) << paddle;
  }
}

TEST(SerialBoardTest, ALostLineIsToldAtOnceAndStaysLost) {
  SimulatedBoard board(std::make_unique<HapiFirmware>());
  board.start();
  const auto device = open_hapi_board(hapi_on(board.port()), kRate);
  board.stop();
  board.unplug();
  tick_board_until(*device, Vector3d::Zero(), [&](bool read, const DeviceReading&) {
    return !read && std::string(device->trouble()).find("was lost") != std::string::npos;
  });
  DeviceReading reading;
  EXPECT_FALSE(device->read(reading));
  EXPECT_THAT(device->trouble(), HasSubstr("check its cable"));
}

TEST(SerialBoardTest, NoLineAndASilentBoardGetASentence) {
  EXPECT_THAT(message_of<InputError>([] { open_hapi_board(hapi_on("/dev/nowhere"), kRate); }),
              "hapi /dev/nowhere: No such file or directory; connect the board, check hapi.port "
              "(/dev/serial/by-id names what is connected) and that you may open it (on Debian: "
              "group dialout)");
  EXPECT_THAT(message_of<InputError>([] { open_hapi_board(hapi_on("/dev/null"), kRate); }),
              HasSubstr("is no serial line"));
  SimulatedBoard silent(std::make_unique<HapiFirmware>());
  HapiParameters p = hapi_on(silent.port());
  p.line.start_time = 0.3;
  EXPECT_THAT(message_of<RunError>([&] { open_hapi_board(p, kRate); }),
              HasSubstr("gives no reading within 0.3 s, hapi.start_time; check its power, its "
                        "firmware and the baud rate"));
  SimulatedBoard other(std::make_unique<PaddleFirmware>());
  other.start();
  PaddleParameters paddle = test::example_paddle(other.port());
  paddle.columns = {"x"};
  paddle.line.start_time = 1.0;
  EXPECT_THAT(message_of<RunError>([&] { open_paddle_board(paddle, kRate); }),
              AllOf(HasSubstr("it sends \""), HasSubstr(",100.000000,0\", which is no reading"),
                    HasSubstr("the keys of [paddle]")));
}

TEST(PaddleProtocolTest, LinesAreReadByTheirColumnsAndOthersArePassedOver) {
  PaddleParameters p;
  p.columns = {"buttons", "-", "z", "x"};
  p.position_scale = 0.001;
  p.position_zero = 10.0;
  const auto protocol = paddle_protocol(p);
  EXPECT_FALSE(protocol->take("hello\n1 2 3\n1 2 3 4 5\n1 2 x 4\n1 2 nan 4\n-1 2 3 4\n\n"));
  EXPECT_EQ(protocol->misunderstood(), "");
  EXPECT_FALSE(protocol->take(std::string(300, '7') + " 2 3 4\n")) << "too long";
  EXPECT_FALSE(protocol->take("3 0 -1"));
  const auto reading = protocol->take("0.5, 1e1\r\n5;0\t0;20");
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->buttons, 3u);
  EXPECT_LT((reading->position - Vector3d(0.0, 0.0, -0.0205)).norm(), 1e-15);
  EXPECT_TRUE(protocol->take("\n"));
}

TEST(PaddleProtocolTest, CommandsHaveANumberForEachAxis) {
  PaddleParameters p;
  p.command = "F {x} {z};";
  p.force_scale = -100.0;
  EXPECT_EQ(paddle_protocol(p)->force_message({0.5, 3.0, -0.12345678}), "F -50.00000 12.34568;\n");
  EXPECT_EQ(paddle_protocol(p)->force_message(Vector3d::Zero()), "F 0.00000 0.00000;\n");
  EXPECT_EQ(paddle_protocol(p)->start_message(), "");
  p.start = "go";
  EXPECT_EQ(paddle_protocol(p)->start_message(), "go\n");
}

TEST(PaddleBoardTest, APlanarBoardThatWaitsForItsStartMovesInItsPlane) {
  auto owned = std::make_unique<PaddleFirmware>();
  PaddleFirmware& firmware = *owned;
  firmware.planar = true;
  firmware.waits_for_start = true;
  SimulatedBoard board(std::move(owned), {1.0, 0.0, 1.0});
  board.start(300);
  PaddleParameters p;
  p.line.port = board.port();
  p.line.start_time = 60.0;
  p.columns = {"x", "z"};
  p.command = "{x} {z}";
  p.start = "go";
  const auto device = open_paddle_board(p, kRate);
  EXPECT_EQ(device->info().force_axes, Vector3d(1.0, 0.0, 1.0));
  tick_board_until(*device, {0.4, 5.0, -0.8}, [](bool read, const DeviceReading& reading) {
    return read && (reading.tool.position - Vector3d(0.001, 0.0, -0.002)).norm() < 1e-6;
  });
  board.stop();
  EXPECT_EQ(firmware.malformed, 0);
}

TEST(PaddleBoardTest, ItsStopButtonIsTheOneThatIsNamed) {
  SimulatedBoard board(std::make_unique<PaddleFirmware>(), Vector3d::UnitX());
  board.start();
  PaddleParameters p = test::example_paddle(board.port());
  p.stop_button = 1;
  const auto device = open_paddle_board(p, kRate);
  for (const unsigned pressed : {1u, 2u}) {
    board.buttons = pressed;
    bool stopped = false;
    tick_board_until(*device, Vector3d::Zero(), [&](bool read, const DeviceReading& reading) {
      stopped = reading.stop_pressed;
      return read && reading.buttons == pressed;
    });
    EXPECT_EQ(stopped, pressed == 2u);
  }
}

template <class Parameters>
std::string problems_of(const Schema<Parameters>& schema, const std::string& text) {
  return message_of<InputError>([&] {
    Table table = Table::parse(text, "f.toml");
    schema.read(table);
    table.finish();
  });
}

TEST(BoardTablesTest, AreReadWithTheirBounds) {
  Table table = Table::parse(
      "port = \"/dev/ttyACM3\"\nbaud = 230400\nmotor_distance = 0.0\nmotors = \"below\"\n"
      "ports = [1, 3]\nclockwise = [2]\nencoder_offset = [241, -61]\npatience = 0.05\n",
      "f.toml");
  const HapiParameters p = hapi_schema().read(table);
  EXPECT_NO_THROW(table.finish());
  EXPECT_EQ(p.line.port, "/dev/ttyACM3");
  EXPECT_EQ(p.line.baud, 230400);
  EXPECT_EQ(p.line.patience, 0.05);
  EXPECT_EQ(p.bars.base, 0.0);
  EXPECT_EQ(p.motors, HapiParameters::Side::kBelow);
  EXPECT_THAT(p.encoder_offset, ElementsAre(241.0, -61.0));

  const std::string port = "port = \"/dev/ttyACM0\"\n";
  EXPECT_THAT(problems_of(hapi_schema(), "baud = 9600\n"), HasSubstr("port"));
  EXPECT_THAT(problems_of(hapi_schema(), port + "baud = 12345\n"), HasSubstr("baud is 12345"));
  EXPECT_THAT(problems_of(hapi_schema(), port + "ports = [2, 2]\n"),
              HasSubstr("each at most once"));
  EXPECT_THAT(problems_of(hapi_schema(), port + "ports = [2]\n"), HasSubstr("for each motor"));
  EXPECT_THAT(problems_of(hapi_schema(), port + "center = [0.1]\n"), HasSubstr("two numbers"));
  EXPECT_THAT(problems_of(paddle_schema(), port + "columns = [\"x\", \"w\"]\n"),
              HasSubstr("\"w\" among them; allowed: x, y, z and buttons"));
  EXPECT_THAT(problems_of(paddle_schema(), port + "columns = [\"x\", \"z\"]\n"),
              HasSubstr("command is \"{x}\"; allowed: a text with {x}, {y} and {z} for just the "
                        "axes that columns has"));
  EXPECT_THAT(problems_of(paddle_schema(), port + "columns = [\"-\"]\ncommand = \"a\"\n"),
              HasSubstr("x, y or z among them"));
  EXPECT_THAT(problems_of(paddle_schema(), port + "force_scale = 0.0\n"), HasSubstr("force_scale"));
}

}  // namespace
}  // namespace haptrial::device
