#include "core/device/pedal.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/device/axis_names.h"

namespace haptrial::device {
namespace {

constexpr double kMostValue = 2147483647.0;  // of the kernel's axes

std::vector<std::pair<std::string, int>> named_axes() {
  std::vector<std::pair<std::string, int>> axes;
  for (const std::string& name : axis_names()) {
    axes.emplace_back(name, axis_of(name));
  }
  return axes;
}

/// An end of the calibration: as stated, else as the device has it.
double end_of(const char* key, std::optional<double> stated, std::optional<int> told,
              const std::string& input) {
  if (!stated && !told) {
    throw InputError(
        fmt::format("pedal {}: a pipe does not say how far its axis goes; state pedal.{}, the "
                    "axis value there",
                    input, key));
  }
  return stated ? *stated : static_cast<double>(*told);
}

}  // namespace

const Schema<PedalParameters>& pedal_schema() {
  using P = PedalParameters;
  static const auto schema =
      Schema<P>()
          .text("input", &P::input,
                "File of the input device of an analog pedal: "
                "/dev/input/by-id/…-event-joystick, /dev/input/eventN, or a named pipe")
          .required()
          .choice("axis", &P::axis, named_axes(), "Axis of the pedal, by the kernel's name")
          .required()
          .number("released", &P::released, {-kMostValue, kMostValue}, "",
                  "Axis value of a pedal that nobody presses")
          .otherwise("lower end of the axis, as the device states it")
          .number("pressed", &P::pressed, {-kMostValue, kMostValue}, "",
                  "Axis value of a pedal that is fully down")
          .otherwise("upper end of the axis, as the device states it")
          .number("dead_zone", &P::dead_zone, {0.0, 0.9}, "1",
                  "Share of the pedal's range that still counts as up")
          .check([](Table& table, const P& p) {
            if (p.released && p.pressed && *p.released == *p.pressed) {
              table.reject("pressed", fmt::format("{:g}", *p.pressed),
                           "another value than pedal.released, which is above or below it");
            }
          });
  return schema;
}

double depth_of(double value, double released, double pressed, double dead_zone) noexcept {
  const double way = (value - released) / (pressed - released);
  return std::clamp((way - dead_zone) / (1.0 - dead_zone), 0.0, 1.0);
}

Pedal::Pedal(const PedalParameters& parameters)
    : parameters_(parameters),
      reader_(parameters.input, {"pedal", [this](InputFile& file) { take_ends(file); },
                                 [this](const InputReports* reports) { show(reports); }}) {}

void Pedal::take_ends(InputFile& file) {
  const auto range = file.follow_axis(parameters_.axis);
  released_ = end_of("released", parameters_.released,
                     range ? std::optional(range->lowest) : std::nullopt, parameters_.input);
  pressed_ = end_of("pressed", parameters_.pressed,
                    range ? std::optional(range->highest) : std::nullopt, parameters_.input);
  if (released_ == pressed_) {
    throw InputError(fmt::format(
        "pedal {}: pedal.released and pedal.pressed are both {:g}, one of them as the device "
        "states its range; state both, as two values",
        parameters_.input, released_));
  }
}

double Pedal::depth() noexcept {
  channel_.read(depth_);
  return depth_;
}

void Pedal::show(const InputReports* reports) {
  const auto value = reports != nullptr ? reports->axis(parameters_.axis) : std::nullopt;
  channel_.write(value ? depth_of(*value, released_, pressed_, parameters_.dead_zone) : 0.0);
}

}  // namespace haptrial::device
