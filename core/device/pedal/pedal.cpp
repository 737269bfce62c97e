#include "core/device/pedal/pedal.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/device/pedal/axis_names.h"

namespace haptrial::device {
namespace {

constexpr std::chrono::milliseconds kLook{50};    // for the end of the session
constexpr std::chrono::milliseconds kRetry{500};  // until a lost pedal is looked for again
constexpr double kMostValue = 2147483647.0;       // of the kernel's axes

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
      axis_(std::make_unique<InputAxis>(parameters.input, parameters.axis)) {
  const auto range = axis_->range();
  released_ = end_of("released", parameters.released,
                     range ? std::optional(range->lowest) : std::nullopt, parameters.input);
  pressed_ = end_of("pressed", parameters.pressed,
                    range ? std::optional(range->highest) : std::nullopt, parameters.input);
  if (released_ == pressed_) {
    throw InputError(fmt::format(
        "pedal {}: pedal.released and pedal.pressed are both {:g}, one of them as the device "
        "states its range; state both, as two values",
        parameters.input, released_));
  }
  show();
  thread_ = std::thread([this] { read(); });
}

Pedal::~Pedal() {
  over_.store(true, std::memory_order_relaxed);
  thread_.join();
}

double Pedal::depth() noexcept {
  channel_.read(depth_);
  return depth_;
}

std::vector<Pedal::Change> Pedal::take_changes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(changes_, {});
}

void Pedal::read() {
  while (!over_.load(std::memory_order_relaxed)) {
    if (axis_ == nullptr) {
      try_again();
    } else if (axis_->wait(kLook)) {
      show();
    } else {
      lose();
    }
  }
}

void Pedal::show() {
  const auto value = axis_->value();
  channel_.write(value ? depth_of(*value, released_, pressed_, parameters_.dead_zone) : 0.0);
}

void Pedal::lose() {
  channel_.write(0.0);
  const std::lock_guard lock(mutex_);
  changes_.push_back({false, axis_->error()});
  axis_.reset();
}

void Pedal::try_again() {
  for (auto waited = kLook; waited <= kRetry && !over_.load(std::memory_order_relaxed);
       waited += kLook) {
    std::this_thread::sleep_for(kLook);
  }
  try {
    axis_ = std::make_unique<InputAxis>(parameters_.input, parameters_.axis);
  } catch (const InputError&) {
    return;  // still away
  }
  show();
  const std::lock_guard lock(mutex_);
  changes_.push_back({true, ""});
}

}  // namespace haptrial::device
