#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/device/input_reader.h"
#include "core/realtime/latest_value.h"

namespace haptrial::device {

/// Path of an analog pedal, and the meaning of its axis.
struct PedalParameters {
  std::string input;               // file of the input device; empty: there is no pedal
  int axis{0};                     // the kernel's number
  std::optional<double> released;  // axis value of a pedal that nobody presses; left out: as the
  std::optional<double> pressed;   // device states its range; of one that is down. They differ
  double dead_zone{0.05};          // share of the way that still counts as up, 0 to 0.9
};

/// The keys of [pedal].
const Schema<PedalParameters>& pedal_schema();

/// How far a pedal is down, 0 to 1, where released != pressed:
///
///     way = (value - released) / (pressed - released)
///     depth = clamp((way - dead_zone) / (1 - dead_zone), 0, 1)
double depth_of(double value, double released, double pressed, double dead_zone) noexcept;

/// An analog pedal. A thread of its own reads the input device; the servo thread takes the newest
/// depth without waiting. A pedal that is lost counts as up until it is back, which the thread
/// tries twice a second.
class Pedal {
 public:
  using Change = InputChange;

  /// @throws InputError as InputReader does, and if an end is missing that a pipe does not state
  explicit Pedal(const PedalParameters& parameters);

  /// 0 to 1. Servo thread: wait-free.
  double depth() noexcept;
  /// Changes since the last call. Any thread but the servo thread.
  std::vector<Change> take_changes() { return reader_.take_changes(); }
  const std::string& input() const { return reader_.path(); }

 private:
  void take_ends(InputFile& file);
  void show(const InputReports* reports);

  PedalParameters parameters_;
  double released_{0.0};
  double pressed_{1.0};
  realtime::LatestValue<double> channel_;
  double depth_{0.0};   // servo thread
  InputReader reader_;  // ends first
};

}  // namespace haptrial::device
