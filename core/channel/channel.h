#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/channel/channel_options.h"
#include "core/channel/channel_source.h"
#include "core/channel/sample_clock.h"
#include "core/realtime/block_log.h"
#include "core/realtime/latest_value.h"

namespace haptrial::channel {

/// Newest values of a channel.
struct ChannelState {
  bool live{false};  // data come
  bool lost{false};  // they came no more, or never within the patience
  std::array<double, kMostQuantities> values{};
  std::int64_t time_ns{0};      // at which they were measured
  std::uint64_t beyond{0};      // samples so far with a value beyond the limit
  std::size_t beyond_value{0};  // of the last of them: its first quantity beyond the limit
};

/// A channel of a running session. A thread of its own opens the instrument, reads it and gives
/// each sample its time; one that is lost is opened anew twice a second. Samples go to the session
/// through a block log, their newest values to the servo thread, and neither side ever waits.
class Channel final : private ChannelInbox {
 public:
  /// Time since the session's first tick [ns]; any thread.
  using Now = std::function<std::int64_t()>;

  /// Starts the thread, which opens the instrument; its samples count from begin() on. @param first
  /// number of the first sample: of those that an earlier run of the session has
  Channel(ChannelOptions options, Now now, std::uint64_t first = 0);
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  const ChannelOptions& options() const noexcept { return options_; }
  /// Waits until the instrument has answered or could not be opened. Session's thread.
  /// @returns why it could not, in a sentence; empty if it is open
  std::string wait_until_open();

  /// Lets samples count from now on: the session's clock runs. Session's thread.
  void begin() { reading_.store(true, std::memory_order_relaxed); }

  /// The newest values; a channel that is lost has `live` false. Servo thread: wait-free.
  const ChannelState& newest() noexcept;
  /// The newest values for another thread, such as a console's; it locks.
  ChannelState seen() const;

  using Log = realtime::BlockLog<ChannelRow>;
  /// Samples that have come; the session's thread is their consumer.
  Log& log() noexcept { return log_; }
  /// Samples for the servo thread, which is their consumer here; those that it leaves lie here
  /// until there is no more room.
  Log& unseen() noexcept { return unseen_; }
  /// Incidents since the last call. Any thread but the servo thread.
  std::vector<IncidentRow> take_incidents();

 private:
  void take(const InstrumentSample& sample) override;
  void note(Incident what, double amount, const std::string& text,
            std::optional<std::int64_t> time_ns) override;
  void note(Incident what, double amount = 0.0, const std::string& text = "") {
    note(what, amount, text, std::nullopt);
  }
  std::int64_t now() const override { return now_(); }
  void run(const std::stop_token& stop);
  bool open();
  void read();
  bool is_useful(std::span<const double> values) const;
  SampleTime clocked(const InstrumentSample& sample, std::int64_t received_ns);
  double time_since(std::int64_t time_ns) const;
  void compare_with_limit(std::span<const double> values);
  void lose(const std::string& why);
  void come_back();
  void show(bool live);

  ChannelOptions options_;
  Now now_;
  Log log_;
  Log unseen_;
  realtime::LatestValue<ChannelState> latest_;
  ChannelState newest_;  // servo thread

  // The channel's thread.
  std::unique_ptr<ChannelSource> source_;
  SampleClock clock_;
  int steps_{0};  // of its clock, each soon after the one before; kMostSteps: it is no clock
  std::int64_t stepped_ns_{0};  // when its clock stepped last
  std::uint64_t next_;
  std::int64_t arrived_ns_{0};  // when a sample came last
  std::int64_t heard_ns_{0};    // when a useful one came last
  bool heard_{false};           // one came in this reading; the session's clock may stand
  std::int64_t lost_ns_{-1};    // since when the channel is lost; -1: it is not
  ChannelState state_;
  std::uint64_t no_room_{0};  // samples for which the log had no room

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::vector<IncidentRow> incidents_;
  ChannelState seen_;
  bool tried_{false};
  std::string error_;
  std::atomic<bool> reading_{false};  // begin() was called
  std::jthread thread_;               // last: it uses the others
};

}  // namespace haptrial::channel
