#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/device/pedal/input_axis.h"
#include "core/realtime/latest_value.h"

namespace haptrial {
class Table;
}

namespace haptrial::device {

/// Where an analog pedal is, and what its axis means.
struct PedalParameters {
  std::string input;               // file of the input device; empty: there is no pedal
  int axis{0};                     // the kernel's number
  std::optional<double> released;  // axis value of a pedal that nobody presses; left out: as the
  std::optional<double> pressed;   // device states its range; of one that is down. They differ
  double dead_zone{0.05};          // share of the way that still counts as up, 0 to 0.9
};

/// Reads a [pedal] table.
PedalParameters read_pedal_parameters(Table& table);

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
  /// Something that happened to it while it was read.
  struct Change {
    bool back{false};  // else it was lost
    std::string why;   // of a loss
  };

  /// @throws InputError as InputAxis does, and if an end is missing that a pipe does not state
  explicit Pedal(const PedalParameters& parameters);
  ~Pedal();
  Pedal(const Pedal&) = delete;
  Pedal& operator=(const Pedal&) = delete;

  /// 0 to 1. Servo thread: wait-free.
  double depth() noexcept;
  /// What happened since the last call. Any thread but the servo thread.
  std::vector<Change> take_changes();
  const std::string& input() const { return parameters_.input; }

 private:
  void read();
  void show();
  void lose();
  void try_again();

  PedalParameters parameters_;
  double released_{0.0};
  double pressed_{1.0};
  std::unique_ptr<InputAxis> axis_;  // null while it is lost; the reading thread's
  realtime::LatestValue<double> channel_;
  double depth_{0.0};  // servo thread
  std::mutex mutex_;
  std::vector<Change> changes_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

}  // namespace haptrial::device
