#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <thread>

#include "core/base/definition/schema.h"
#include "core/channel/channel_kinds.h"

/// A kind of channel that needs no instrument: a value that rises from 0 to 1 again and again.
namespace own {

using namespace haptrial::channel;

struct SawOptions {
  double period{1.0};  // > 0 [s]
  double rate{100.0};  // > 0 [Hz]
};

class SawSource final : public ChannelSource {
 public:
  explicit SawSource(const SawOptions& options) : options_(options) {}
  void read(ChannelInbox& into, std::chrono::milliseconds) override {
    std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / options_.rate));
    const double turns = static_cast<double>(++samples_) / options_.rate / options_.period;
    const std::array<double, 1> values{turns - static_cast<double>(static_cast<long>(turns))};
    into.take({.values = values});
  }

 private:
  SawOptions options_;
  long samples_{0};
};

inline const haptrial::Schema<SawOptions>& saw_schema() {
  static const auto schema =
      haptrial::Schema<SawOptions>()
          .number("period", &SawOptions::period, {0.01, 100.0}, "s", "Time of one rise of a saw")
          .number("rate", &SawOptions::rate, {1.0, 1000.0}, "Hz", "Samples of a saw per second");
  return schema;
}

/// Reads [channels.NAME] kind = "saw": period, rate.
inline ChannelPlan read_saw(haptrial::Table& table) {
  const SawOptions options = saw_schema().read(table);
  ChannelPlan plan;
  plan.quantities = {{"share", "1"}};
  plan.rate = options.rate;
  plan.open = [options] { return std::make_unique<SawSource>(options); };
  return plan;
}

inline void add_saw() {
  add_kind_of_channel({"saw", "a value that rises again and again", read_saw});
}

}  // namespace own
