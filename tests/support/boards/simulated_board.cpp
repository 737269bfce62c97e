#include "tests/support/boards/simulated_board.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace haptrial::test {

using Eigen::Vector2d;
using Eigen::Vector3d;

SimulatedBoard::SimulatedBoard(std::unique_ptr<BoardFirmware> firmware, const Vector3d& free)
    : firmware_(std::move(firmware)), free_(free) {
  std::array<char, 256> name{};
  termios raw{};
  cfmakeraw(&raw);
  if (openpty(&line_, &other_end_, name.data(), &raw, nullptr) != 0) {
    throw std::runtime_error("no pseudo-terminal can be opened");
  }
  fcntl(line_, F_SETFL, O_NONBLOCK);
  for (const int file : {line_, other_end_}) {
    fcntl(file, F_SETFD, FD_CLOEXEC);  // a command that kept it open would never see it unplugged
  }
  name_ = name.data();
}

SimulatedBoard::~SimulatedBoard() {
  stop();
  unplug();
}

void SimulatedBoard::unplug() {
  for (int* file : {&line_, &other_end_}) {
    if (*file >= 0) {
      close(*file);
      *file = -1;
    }
  }
}

void SimulatedBoard::start(int delay, std::function<void(SimulatedBoard&, double)> hand) {
  over_ = false;
  thread_ = std::thread([this, delay, hand = std::move(hand)] { run(delay, hand); });
}

void SimulatedBoard::stop() {
  over_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
}

void SimulatedBoard::fail(BoardFailure failure, long tick) {
  failure_ = failure;
  failure_tick_ = tick;
  ticks_ = 0;
}

/// @returns whether a force came
bool SimulatedBoard::hear(int most_ms) {
  std::array<char, 4096> bytes{};
  pollfd ready{line_, POLLIN, 0};
  if (line_ < 0 || poll(&ready, 1, most_ms) <= 0) {
    return false;
  }
  const ssize_t count = ::read(line_, bytes.data(), bytes.size());
  return count > 0 && firmware_->take({bytes.data(), static_cast<std::size_t>(count)}) > 0;
}

void SimulatedBoard::drain() {
  while (hear(0)) {
  }
}

void SimulatedBoard::say(const std::string& bytes) {
  if (line_ >= 0 && ::write(line_, bytes.data(), bytes.size()) < 0) {
    return;  // the computer does not listen
  }
}

/// The reading after a failure had its way.
std::string SimulatedBoard::next_reading() {
  const BoardFailure failure = ticks_ >= failure_tick_ ? failure_ : BoardFailure::kNone;
  const Vector3d handle = mass.state().position.cwiseProduct(free_);
  const std::string whole = firmware_->reading(handle, buttons);
  switch (failure) {
    case BoardFailure::kSilent:
      return "";
    case BoardFailure::kUnplugged:
      unplug();
      return "";
    case BoardFailure::kNotFinite:
      return firmware_->reading(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()), 0);
    case BoardFailure::kTorn:
      return whole.substr(0, whole.size() / 2);
    case BoardFailure::kNoise:
      return std::string("\x81\xfe\x13\x77\n\xffq#\x90\x05\x7f\x80\x01").substr(ticks_ % 7);
    case BoardFailure::kJump:
      return firmware_->reading(handle + Vector3d(0.02, 0.0, 0.0), buttons);
    case BoardFailure::kDoubled:
      return whole + whole;
    case BoardFailure::kEveryOther:
      return ticks_ % 2 == 0 ? whole : "";
    case BoardFailure::kLate:
      return std::exchange(held_back_, whole);
    case BoardFailure::kNone:
      break;
  }
  return whole;
}

void SimulatedBoard::pass_millisecond() {
  ++ticks_;
  mass.step(force().cwiseProduct(free_), 1e-3);
}

bool SimulatedBoard::is_understood() const {
  const bool failed = ticks_ >= failure_tick_ &&
                      (failure_ == BoardFailure::kSilent || failure_ == BoardFailure::kUnplugged ||
                       failure_ == BoardFailure::kNotFinite || failure_ == BoardFailure::kTorn ||
                       failure_ == BoardFailure::kNoise);
  return !failed;
}

void SimulatedBoard::step(const std::function<std::uint64_t()>& readings) {
  constexpr int kLongest = 20'000;  // [ms]
  const std::uint64_t before = readings();
  const bool understood = is_understood();
  if (understood && firmware_->answers()) {
    hear(kLongest);
  }
  drain();
  const std::string reading = next_reading();
  pass_millisecond();
  say(reading);
  if (!understood || reading.empty()) {
    return;
  }
  for (int i = 0; readings() == before && i < 50 * kLongest; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
  if (!firmware_->answers()) {
    hear(kLongest);  // each reading is answered by a force
  }
}

void SimulatedBoard::run(int delay, const std::function<void(SimulatedBoard&, double)>& hand) {
  const auto begin = std::chrono::steady_clock::now();
  const auto since = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  while (!over_ && 1e3 * since() < delay) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    tcflush(line_, TCIFLUSH);  // a board that restarts hears nothing
  }
  while (!over_) {
    const bool commanded = hear(1);
    for (const double now = 1e3 * since(); static_cast<double>(ticks_) < now && !over_;) {
      if (hand) {
        hand(*this, 1e-3 * static_cast<double>(ticks_));
      }
      pass_millisecond();
      if (!firmware_->answers()) {
        say(next_reading());
      }
    }
    if (commanded && firmware_->answers()) {
      say(next_reading());
    }
  }
}

namespace {

constexpr double kBase = 0.038, kArm = 0.07, kForearm = 0.09;  // of a 2diy [m]
const Vector2d kCenter{0.019, 0.1};

float float_at(const std::string& bytes, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 4; i-- > 0;) {
    bits = bits << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return std::bit_cast<float>(bits);
}

std::string bytes_of(double number) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
  return {static_cast<char>(bits), static_cast<char>(bits >> 8), static_cast<char>(bits >> 16),
          static_cast<char>(bits >> 24)};
}

/// Motors beyond the handle: x of the plane points left, y to the user.
Vector2d plane_of(const Vector3d& handle) { return kCenter + Vector2d(-handle.x(), handle.z()); }

}  // namespace

/// The triangle of motor, elbow and handle; the elbows point outwards.
Vector2d HapiFirmware::angles_at(const Vector2d& handle) {
  const auto bend = [](double reach) {
    return std::acos((kArm * kArm + reach * reach - kForearm * kForearm) / (2.0 * kArm * reach));
  };
  const Vector2d second = handle - Vector2d(kBase, 0.0);
  return {std::atan2(handle.y(), handle.x()) + bend(handle.norm()),
          std::atan2(second.y(), second.x()) - bend(second.norm())};
}

int HapiFirmware::take(const std::string& bytes) {
  int forces = 0;
  came_ += bytes;
  while (came_.size() >= 2) {
    const bool is_setup = first_firmware ? (came_[0] >> 4) == 0 : came_[0] == 1;
    const std::size_t head = is_setup && !first_firmware ? 10 : 2;
    const std::size_t whole = head + (is_setup ? 16 : 8);
    if (came_.size() < whole) {
      break;
    }
    if (is_setup) {
      setup.motor_ports = static_cast<unsigned>(first_firmware ? came_[0] & 15 : came_[2]);
      setup.encoder_ports = first_firmware ? setup.motor_ports : static_cast<unsigned>(came_[5]);
      setup.directions = first_firmware ? "" : came_.substr(3, 2) + came_.substr(6, 2);
      for (std::size_t i = 0; i < 2; ++i) {
        setup.offset[i] = float_at(came_, head + 8 * i);
        setup.resolution[i] = float_at(came_, head + 8 * i + 4);
      }
      ++setup.count;
    } else {
      torque[1] = static_cast<double>(float_at(came_, 2));  // motor 2 is at port 1
      torque[0] = static_cast<double>(float_at(came_, 6));
      ++forces;
    }
    came_.erase(0, whole);
  }
  return forces;
}

Vector3d HapiFirmware::force(const Vector3d& handle) const {
  constexpr double kStep = 1e-6;
  const Vector2d place = plane_of(handle);
  Vector2d force = Vector2d::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    const Vector2d way = kStep * Vector2d::Unit(axis);
    const Vector2d turn = (angles_at(place + way) - angles_at(place - way)) / (2.0 * kStep);
    force[axis] = turn[0] * torque[0] + turn[1] * torque[1];
  }
  return {-force.x(), 0.0, force.y()};
}

std::string HapiFirmware::reading(const Vector3d& handle, unsigned) const {
  const Vector2d degrees =
      angles.value_or(Vector2d(180.0 / std::numbers::pi * angles_at(plane_of(handle))));
  return '\5' + bytes_of(degrees[1]) + bytes_of(degrees[0]);
}

int PaddleFirmware::take(const std::string& bytes) {
  int forces = 0;
  came_ += bytes;
  for (std::size_t end = came_.find('\n'); end != std::string::npos; end = came_.find('\n')) {
    const std::string line = came_.substr(0, end);
    came_.erase(0, end + 1);
    const int wanted = planar ? 2 : 1;
    const int read = planar ? std::sscanf(line.c_str(), "%lf %lf", &value[0], &value[1])
                            : std::sscanf(line.c_str(), "T%lf", &value[0]);
    started_ = started_ || line == "go";
    malformed += read == wanted || line == "go" ? 0 : 1;
    forces += read == wanted ? 1 : 0;
  }
  return forces;
}

Vector3d PaddleFirmware::force(const Vector3d&) const {
  return planar ? Vector3d(value[0], 0.0, value[1]) : Vector3d(value[0] / 0.08, 0.0, 0.0);
}

std::string PaddleFirmware::reading(const Vector3d& handle, unsigned buttons) const {
  ++lines_;
  if (waits_for_start && !started_) {
    return "ready?\r\n";
  }
  return planar ? fmt::format("{:.9f} {:.9f}\n", handle.x(), handle.z())
                : fmt::format("{},{:.6f},{}\r\n", lines_, 100.0 - 1e3 * handle.x(), buttons);
}

}  // namespace haptrial::test
