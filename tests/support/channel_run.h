#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/channel/channel.h"
#include "core/channel/channel_options.h"
#include "tests/support/wait.h"

namespace haptrial::test {

/// The channels of a definition. @throws InputError with what is wrong with them
inline std::vector<channel::ChannelOptions> channels_of(const std::string& toml) {
  Table root = Table::parse(toml, "lab.toml");
  auto channels = channel::read_channels(root);
  root.finish();
  return channels;
}

/// The only channel of a definition, running on a session's clock that the test sets.
class ChannelRun {
 public:
  explicit ChannelRun(const std::string& toml) {
    options_ = channels_of(toml).at(0);
    start();
  }
  /// @param change  of what the definition says
  template <class Change>
  ChannelRun(const std::string& toml, Change change) {
    options_ = channels_of(toml).at(0);
    change(options_);
    start();
  }

  channel::Channel& channel() { return *channel_; }
  const channel::ChannelOptions& options() const { return options_; }
  double now() const { return 1e-9 * static_cast<double>(now_ns_.load()); }
  void set_now(double seconds) { now_ns_.store(std::llround(1e9 * seconds)); }
  /// Ends the channel, which closes its instrument.
  void close() { channel_.reset(); }

  /// Waits until the channel has taken so many samples in all. @returns all of them
  const std::vector<channel::ChannelRow>& rows(std::size_t count) {
    while (channel_->log().pushed() < count) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    channel_->log().flush(
        [this](auto rows) { rows_.insert(rows_.end(), rows.begin(), rows.end()); });
    return rows_;
  }
  /// Waits for so many incidents of this kind in all. @returns all of this kind
  std::vector<channel::IncidentRow> incidents(channel::Incident what, std::size_t count) {
    wait_until([&] { return of_kind(what).size() >= count; });
    return of_kind(what);
  }
  /// Those that have come so far.
  std::vector<channel::IncidentRow> of_kind(channel::Incident what) {
    for (auto& each : channel_->take_incidents()) {
      incidents_.push_back(std::move(each));
    }
    std::vector<channel::IncidentRow> found;
    for (const auto& each : incidents_) {
      if (each.what == what) {
        found.push_back(each);
      }
    }
    return found;
  }
  double amount(channel::Incident what) {
    double sum = 0.0;
    for (const auto& each : of_kind(what)) {
      sum += each.amount;
    }
    return sum;
  }

 private:
  void start() {
    // Tests count all samples from the opening of an instrument on.
    channel::ChannelOptions options = options_;
    options.plan.open = [this, open = options_.plan.open] {
      wait_until([this] { return begun_.load(); });
      return open();
    };
    channel_ = std::make_unique<channel::Channel>(options, [this] { return now_ns_.load(); });
    channel_->begin();
    begun_ = true;
  }

  std::atomic<std::int64_t> now_ns_{0};
  std::atomic<bool> begun_{false};
  channel::ChannelOptions options_;
  std::vector<channel::ChannelRow> rows_;
  std::vector<channel::IncidentRow> incidents_;
  std::unique_ptr<channel::Channel> channel_;
};

/// Share of rows whose planted time is within the uncertainty that they state.
/// @param truth  when each of them was measured [s]
inline double share_within(const std::vector<channel::ChannelRow>& rows,
                           const std::vector<double>& truth) {
  double within = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double error = std::abs(1e-9 * static_cast<double>(rows[i].time_ns) - truth.at(i));
    within += error <= rows[i].uncertainty ? 1.0 : 0.0;
  }
  return within / static_cast<double>(rows.size());
}

}  // namespace haptrial::test
