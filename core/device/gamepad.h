#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/device/input_reader.h"
#include "core/realtime/latest_value.h"

namespace haptrial::device {

/// Path and use of a game controller.
struct GamepadParameters {
  std::string input;       // file of the input device; empty: there is none
  double dead_zone{0.12};  // share of a stick's or a trigger's way that counts as rest, 0 to 0.9
  int stop_button{7};      // emergency stop, of GamepadState::buttons; -1: none
};

/// The game controllers that are connected: their files in a folder like /dev/input/by-id. Empty
/// also if there is no such folder.
std::vector<std::string> find_gamepads(const std::string& folder = "/dev/input/by-id");

/// The keys of [gamepad].
const Schema<GamepadParameters>& gamepad_schema();

/// State of a game controller, with the kernel's names of its parts (Linux gamepad specification).
/// At rest all is 0.
struct GamepadState {
  Eigen::Vector2d move{Eigen::Vector2d::Zero()};  // left stick: right, up, each -1 to 1
  double depth{0.0};                              // right trigger less left one, -1 to 1
  /// About the picture's right, up and towards the eye, each -1 to 1: right stick down, right stick
  /// to the right, directional pad to the left.
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};
  /// Bit 0 south (A), 1 east (B), 2 north, 3 west, 4 and 5 left and right shoulder, 6 select,
  /// 7 start, 8 mode, 9 and 10 left and right stick pressed.
  std::uint32_t buttons{0};
};

/// How far a stick is from its middle, -1 to 1; a trigger from its end, 0 to 1. Where a way w is at
/// least the dead zone d, it counts as (w - d) / (1 - d).
double stick_of(double value, const InputFile::Range& range, double dead_zone) noexcept;
double trigger_of(double value, const InputFile::Range& range, double dead_zone) noexcept;

/// A game controller. A thread of its own reads the input device; another takes the newest state
/// without waiting. One that is lost is at rest until it is back.
class Gamepad {
 public:
  /// @throws InputError as InputReader does, and for a device without a stick
  explicit Gamepad(const GamepadParameters& parameters);

  /// Any one thread: wait-free.
  GamepadState state() noexcept;
  /// Changes since the last call. Any thread but the servo thread.
  std::vector<InputChange> take_changes() { return reader_.take_changes(); }
  const std::string& input() const { return reader_.path(); }

 private:
  static constexpr std::size_t kAxes = 7;
  void take_ranges(InputFile& file);
  void show(const InputReports* reports);

  GamepadParameters parameters_;
  std::array<std::optional<InputFile::Range>, kAxes> ranges_;  // nothing: it has no such axis
  realtime::LatestValue<GamepadState> channel_;
  GamepadState state_;  // of the thread that takes it
  InputReader reader_;  // ends first
};

}  // namespace haptrial::device
