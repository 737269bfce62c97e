#include "core/device/gamepad.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "core/base/definition/schema.h"

namespace haptrial::device {
namespace {

enum Axis : std::size_t { kX, kY, kRightX, kRightY, kLeftTrigger, kRightTrigger, kPad };
constexpr std::array<int, 7> kCodes{ABS_X, ABS_Y, ABS_RX, ABS_RY, ABS_Z, ABS_RZ, ABS_HAT0X};

// Range of a stick if the file, a pipe, does not state it: as most drivers have it.
constexpr InputFile::Range kStick{-32768, 32767};
constexpr InputFile::Range kTrigger{0, 255};
constexpr InputFile::Range kDirection{-1, 1};

constexpr std::array<int, 11> kButtons{BTN_SOUTH, BTN_EAST,   BTN_NORTH,  BTN_WEST,
                                       BTN_TL,    BTN_TR,     BTN_SELECT, BTN_START,
                                       BTN_MODE,  BTN_THUMBL, BTN_THUMBR};

InputFile::Range usual(std::size_t axis) {
  return axis == kPad                                    ? kDirection
         : axis == kLeftTrigger || axis == kRightTrigger ? kTrigger
                                                         : kStick;
}

double beyond(double way, double dead_zone) noexcept {
  return std::clamp((way - dead_zone) / (1.0 - dead_zone), 0.0, 1.0);
}

}  // namespace

std::vector<std::string> find_gamepads(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().filename().string().ends_with("-event-joystick")) {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

const Schema<GamepadParameters>& gamepad_schema() {
  using P = GamepadParameters;
  static const auto schema =
      Schema<P>()
          .text("input", &P::input,
                "File of the game controller, /dev/input/by-id/...-event-joystick")
          .required()
          .number("dead_zone", &P::dead_zone, {0.0, 0.9}, "1",
                  "Share of a stick's or a trigger's range that counts as rest")
          .integer("stop_button", &P::stop_button, -1, static_cast<long>(kButtons.size()) - 1,
                   "Button of the game controller for emergency stops, 7 is start; -1: none");
  return schema;
}

double stick_of(double value, const InputFile::Range& range, double dead_zone) noexcept {
  const double middle = 0.5 * (range.lowest + range.highest);
  const double way = (value - middle) / (range.highest - middle);
  return std::copysign(beyond(std::abs(way), dead_zone), way);
}

double trigger_of(double value, const InputFile::Range& range, double dead_zone) noexcept {
  return beyond((value - range.lowest) / (range.highest - range.lowest), dead_zone);
}

Gamepad::Gamepad(const GamepadParameters& parameters)
    : parameters_(parameters),
      reader_(parameters.input, {"gamepad", [this](InputFile& file) { take_ranges(file); },
                                 [this](const InputReports* reports) { show(reports); }}) {}

/// Sticks it must have; all else some controllers lack.
void Gamepad::take_ranges(InputFile& file) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const bool needed = axis == kX || axis == kY;
    const auto range = needed ? file.follow_axis(kCodes[axis]) : file.find_axis(kCodes[axis]);
    ranges_[axis] = range || !file.is_pipe() ? range : usual(axis);
  }
  file.follow_buttons();
}

void Gamepad::show(const InputReports* reports) {
  GamepadState state;
  if (reports != nullptr) {
    const auto read = [&](Axis axis, auto of) {
      const auto value = reports->axis(kCodes[axis]);
      return value && ranges_[axis] ? of(*value, *ranges_[axis], parameters_.dead_zone) : 0.0;
    };
    state.move = {read(kX, stick_of), -read(kY, stick_of)};
    state.depth = read(kRightTrigger, trigger_of) - read(kLeftTrigger, trigger_of);
    state.turn = {read(kRightY, stick_of), read(kRightX, stick_of), -read(kPad, stick_of)};
    for (std::size_t i = 0; i < kButtons.size(); ++i) {
      state.buttons |= reports->held(kButtons[i]) ? 1U << i : 0U;
    }
  }
  channel_.write(state);
}

GamepadState Gamepad::state() noexcept {
  channel_.read(state_);
  return state_;
}

}  // namespace haptrial::device
