#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/bone/nerve/stimulator.h"

namespace haptrial::nerve {

/// A technician's request for a channel or for the probe.
struct MonitorOrder {
  enum class What { kThreshold, kMute, kSearch, kStimulus } what{What::kThreshold};
  std::size_t channel{0};  // not of kStimulus
  bool muted{false};
  double threshold{0.0};  // of an event [V]
  double current{0.0};    // of the probe's pulses [A]
};

/// State of the probe that a technician sees.
struct MonitorProbe {
  double current{0.0};                   // of the next pulse [A]
  std::optional<std::size_t> searching;  // the channel
  std::optional<FoundThreshold> found;   // by the last search
};

/// State of a channel that a technician sees.
struct MonitorChannel {
  std::string name;
  std::string nerve;
  double threshold{0.0};  // [V]
  bool muted{false};
  bool tone{false};
  bool shown{false};       // an event of the last seconds
  double frequency{0.0};   // of its tone [Hz]
  double train_time{0.0};  // [s]
  std::uint64_t events{0};
  std::uint64_t artefacts{0};
};

/// An event of the log.
struct MonitorEvent {
  double time{0.0};  // since the session's first tick [s]
  std::size_t channel{0};
  std::string kind;
  double duration{0.0};    // [s]
  double peak{0.0};        // [V]
  double threshold{0.0};   // [V]
  double train_time{0.0};  // [s]
};

/// Least and largest sample of a channel in a column of the screen [V].
struct MonitorColumn {
  float low{0.0f};
  float high{0.0f};
};

/// Buffer between the thread that makes electromyograms and pages that show them. Any thread but
/// the servo's: it locks.
class MonitorBuffer {
 public:
  static constexpr double kColumn = 0.005;       // of the screen [s]
  static constexpr std::size_t kColumns = 1200;  // kept: 6 s
  static constexpr std::size_t kEvents = 200;    // of the log, kept

  struct View {
    double time{0.0};  // of the last column [s]
    bool heard{true};  // by the participant, in this procedure
    bool simulated{true};
    MonitorProbe probe;
    std::vector<MonitorChannel> channels;
    std::vector<MonitorEvent> events;    // new ones
    std::vector<MonitorColumn> columns;  // (new columns x channels)
    std::uint64_t next_column{0};
    std::uint64_t next_event{0};
  };

  // The thread that makes electromyograms.
  void show(std::vector<MonitorChannel> channels, const MonitorProbe& probe, double time,
            bool heard);
  void add_column(const std::vector<MonitorColumn>& by_channel);
  void add_event(const MonitorEvent& event);
  std::vector<MonitorOrder> take_orders();

  // Pages.

  /// Columns and events since two counts, which a first call gives as 0.
  View since(std::uint64_t column, std::uint64_t event) const;
  void ask(const MonitorOrder& order);

 private:
  mutable std::mutex mutex_;
  std::vector<MonitorChannel> channels_;
  MonitorProbe probe_;
  double time_{0.0};
  bool heard_{true};
  std::deque<std::vector<MonitorColumn>> columns_;
  std::uint64_t column_count_{0};
  std::deque<MonitorEvent> events_;
  std::uint64_t event_count_{0};
  std::vector<MonitorOrder> orders_;
};

}  // namespace haptrial::nerve
