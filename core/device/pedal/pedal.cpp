#include "core/device/pedal/pedal.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/device/input/axis_names.h"

namespace haptrial::device {
namespace {

constexpr double kMostValue = 2147483647.0;  // of the kernel's axes

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

PedalParameters read_pedal_parameters(Table& table) {
  PedalParameters p;
  p.input = table.text("input");
  p.axis = axis_of(table.choice("axis", axis_names()));
  const auto end = [&table](const char* key, std::optional<double>& into) {
    if (table.has(key)) {
      into = table.number(key, {-kMostValue, kMostValue}, "");
    }
  };
  end("released", p.released);
  end("pressed", p.pressed);
  p.dead_zone = table.number_or("dead_zone", p.dead_zone, {0.0, 0.9}, "1");
  if (p.released && p.pressed && *p.released == *p.pressed) {
    table.reject("pressed", fmt::format("{:g}", *p.pressed),
                 "another value than pedal.released, which is above or below it");
  }
  return p;
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
