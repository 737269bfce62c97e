#include "core/device/hapi_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::device {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr char kDeviceId = 5;          // of whoever asks; the board repeats it
constexpr double kMostAngle = 3600.0;  // of what a reading may say [deg]

constexpr const char* kInLine =
    "the forearms of the board are in line, so that it gives no defined force there; move the "
    "handle "
    "towards the middle";

std::size_t motors_of(const HapiParameters& p) {
  return p.mechanism == HapiParameters::Mechanism::kLever ? 1 : 2;
}

/// Directions in W of the two axes of the mechanism's plane, as columns.
Eigen::Matrix<double, 3, 2> plane_of(HapiParameters::Side motors) {
  Eigen::Matrix<double, 3, 2> plane;
  switch (motors) {
    case HapiParameters::Side::kFar:
      plane << -Vector3d::UnitX(), Vector3d::UnitZ();
      break;
    case HapiParameters::Side::kNear:
      plane << Vector3d::UnitX(), -Vector3d::UnitZ();
      break;
    case HapiParameters::Side::kBelow:
      plane << Vector3d::UnitX(), Vector3d::UnitY();
      break;
    case HapiParameters::Side::kAbove:
      plane << -Vector3d::UnitX(), -Vector3d::UnitY();
      break;
  }
  return plane;
}

void append(std::string& bytes, double number) {
  const auto value = static_cast<float>(number);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 4; ++i) {
    bytes.push_back(static_cast<char>((bits >> (8 * i)) & 0xFFu));
  }
}

double number_at(std::string_view bytes, std::size_t from) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[from + i])) << (8 * i);
  }
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

class HapiProtocol final : public BoardProtocol {
 public:
  explicit HapiProtocol(const HapiParameters& parameters)
      : p_(parameters), plane_(plane_of(p_.motors)), motors_(motors_of(p_)) {
    for (std::size_t i = 0; i < motors_; ++i) {
      order_.push_back(i);
    }
    std::ranges::sort(order_, {}, [&](std::size_t motor) { return p_.ports[motor]; });
  }

  bool answers() const override { return true; }

  std::string start_message() const override {
    std::string bytes = header(1, 0);
    if (p_.firmware == HapiParameters::Firmware::kCurrent) {
      append_motors(bytes);
      append_motors(bytes);  // each with its encoder
      bytes.push_back(0);    // no sensors
      bytes.push_back(0);    // no pulses
    }
    for (const std::size_t motor : order_) {
      append(bytes, p_.encoder_offset[motor]);
      append(bytes, p_.encoder_resolution);
    }
    return bytes;
  }

  std::string force_message(const Vector3d& force) override {
    const Vector2d torques = jacobian_.transpose() * (plane_.transpose() * force);
    std::string bytes = header(2, 1);
    for (const std::size_t motor : order_) {
      append(bytes, torques[static_cast<Eigen::Index>(motor)]);
    }
    return bytes;
  }

  std::optional<BoardReading> take(std::string_view bytes) override {
    const std::size_t whole = 1 + 4 * motors_;
    std::optional<BoardReading> newest;
    came_ += bytes;
    while (came_.size() >= whole) {
      if (const auto reading = reading_of(std::string_view(came_).substr(0, whole))) {
        newest = reading;
        came_.erase(0, whole);
      } else {
        misunderstood_ = came_.substr(0, whole);
        came_.erase(0, 1);
      }
    }
    return newest;
  }

  void forget() override { came_.clear(); }

  std::string misunderstood() const override {
    std::string shown;
    for (const char each : misunderstood_) {
      shown += fmt::format("{}{:02x}", shown.empty() ? "" : " ", static_cast<unsigned char>(each));
    }
    return shown;
  }

 private:
  /// @param now, before  number of the message in the firmware of today and of 2017
  std::string header(char now, char before) const {
    const bool current = p_.firmware == HapiParameters::Firmware::kCurrent;
    return {current ? now : static_cast<char>(before << 4 | ports()), kDeviceId};
  }

  int ports() const {
    int bits = 0;
    for (const std::size_t motor : order_) {
      bits |= 1 << (static_cast<int>(p_.ports[motor]) - 1);
    }
    return bits;
  }

  void append_motors(std::string& bytes) const {
    bytes.push_back(static_cast<char>(ports()));
    for (const std::size_t motor : order_) {
      const bool clockwise = std::ranges::count(p_.clockwise, static_cast<double>(motor + 1)) > 0;
      bytes.push_back(clockwise ? 0 : 1);
    }
  }

  /// Nothing unless the bytes can be an answer.
  std::optional<BoardReading> reading_of(std::string_view bytes) {
    Vector2d angles = Vector2d::Zero();
    for (std::size_t i = 0; i < motors_; ++i) {
      const double angle = number_at(bytes, 1 + 4 * i);
      if (bytes[0] != kDeviceId || !(std::abs(angle) <= kMostAngle)) {
        return std::nullopt;
      }
      angles[static_cast<Eigen::Index>(order_[i])] = kDegree * angle;
    }
    return motors_ == 1 ? lever(angles[0]) : pantograph(angles);
  }

  BoardReading lever(double angle) {
    BoardReading reading;
    jacobian_ << p_.bars.arm, 0.0, 0.0, 0.0;
    reading.position = plane_.col(0) * p_.bars.arm * angle;
    return reading;
  }

  BoardReading pantograph(const Vector2d& angles) {
    const FiveBarPose pose = solve_five_bar(p_.bars, angles);
    BoardReading reading;
    jacobian_ = pose.jacobian;
    reading.trouble = pose.regular ? "" : kInLine;
    reading.position = plane_ * (pose.handle - Vector2d(p_.center[0], p_.center[1]));
    return reading;
  }

  HapiParameters p_;
  Eigen::Matrix<double, 3, 2> plane_;
  std::size_t motors_;
  std::vector<std::size_t> order_;       // motors by their ports
  Matrix2d jacobian_{Matrix2d::Zero()};  // at the angles that were read last; zero: no force
  std::string came_;
  std::string misunderstood_;
};

/// Two numbers, or one for each motor.
void check_lists(Table& table, HapiParameters& p) {
  const std::size_t motors = motors_of(p);
  if (p.center.size() != 2) {
    table.reject("center", fmt::format("{} long", p.center.size()), "two numbers");
  }
  const auto check = [&](const char* key, const std::vector<double>& numbers) {
    if (numbers.size() < motors) {
      table.reject(key, fmt::format("{} long", numbers.size()), "a number for each motor");
    }
  };
  check("encoder_offset", p.encoder_offset);
  check("ports", p.ports);
  for (const double port : p.ports) {
    if (port != std::floor(port) || std::ranges::count(p.ports, port) > 1) {
      table.reject("ports", fmt::format("{:g} among them", port),
                   "whole numbers from 1 to 4, each at most once");
      return;
    }
  }
}

}  // namespace

const Schema<HapiParameters>& hapi_schema() {
  using P = HapiParameters;
  static const auto bars =
      Schema<FiveBar>()
          .number("motor_distance", &FiveBar::base, {0.0, 1.0}, "m",
                  "Distance between the two motors of a pantograph")
          .number("arm", &FiveBar::arm, {0.0, 1.0, true}, "m",
                  "Length of the arm on each motor; of a lever, from motor to handle")
          .number("forearm", &FiveBar::forearm, {0.0, 1.0, true}, "m",
                  "Length from the end of each arm to the handle");
  static const auto schema =
      Schema<P>()
          .keys_of(&P::line, serial_board_schema())
          .choice("firmware", &P::firmware,
                  {{"current", P::Firmware::kCurrent}, {"2017", P::Firmware::kPorts}},
                  "Messages that the board's firmware takes")
          .choice("mechanism", &P::mechanism,
                  {{"pantograph", P::Mechanism::kPantograph}, {"lever", P::Mechanism::kLever}},
                  "Mechanism on the board: two motors and five bars, or one motor with a lever")
          .keys_of(&P::bars, bars)
          .choice("motors", &P::motors,
                  {{"far", P::Side::kFar},
                   {"near", P::Side::kNear},
                   {"below", P::Side::kBelow},
                   {"above", P::Side::kAbove}},
                  "Side on which the motors are, seen by the person: far or near on a table, below "
                  "or above upright")
          .numbers("center", &P::center, {-1.0, 1.0}, "m",
                   "Center of the workspace, from motor 1: towards motor 2, and away from both")
          .otherwise("[0.019, 0.1]")
          .numbers("ports", &P::ports, {1.0, 4.0}, "",
                   "Ports of the board to which motors 1 and 2 and their encoders are connected")
          .otherwise("[2, 1]")
          .numbers("clockwise", &P::clockwise, {1.0, 2.0}, "",
                   "Numbers of the motors that the board is to turn clockwise")
          .otherwise("none")
          .numbers("encoder_offset", &P::encoder_offset, {-360.0, 360.0}, "deg",
                   "Angles of motors 1 and 2 at which the handle rests when the session opens the "
                   "board")
          .otherwise("[168, 12]")
          .number("encoder_resolution", &P::encoder_resolution, {1.0, 1e6}, "",
                  "Counts of each encoder for a turn")
          .check(check_lists);
  return schema;
}

std::unique_ptr<BoardProtocol> hapi_protocol(const HapiParameters& parameters) {
  return std::make_unique<HapiProtocol>(parameters);
}

Eigen::Vector3d force_axes(const HapiParameters& parameters) {
  const auto plane = plane_of(parameters.motors);
  return plane.leftCols(static_cast<Eigen::Index>(motors_of(parameters)))
      .cwiseAbs()
      .rowwise()
      .sum();
}

std::unique_ptr<SerialBoard> open_hapi_board(const HapiParameters& parameters, double rate) {
  SerialBoardSetup setup = parameters.line;
  setup.table = "hapi";
  setup.force_axes = force_axes(parameters);
  return std::make_unique<SerialBoard>(std::move(setup), hapi_protocol(parameters), rate);
}

}  // namespace haptrial::device
