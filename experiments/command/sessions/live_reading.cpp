#include "experiments/command/sessions/live_reading.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "core/channel/channel_set.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kBetween = 0.2;  // lines [s]

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::string buttons_of(std::uint32_t buttons) {
  std::string pressed;
  for (int i = 0; i < 32; ++i) {
    if (device::is_pressed(buttons, i)) {
      pressed += (pressed.empty() ? "" : " ") + std::to_string(i);
    }
  }
  return pressed.empty() ? "none" : pressed;
}

std::string words_of(const device::DeviceReading& reading) {
  const Eigen::Vector3d mm = 1e3 * reading.tool.position;
  return fmt::format("x {:7.1f}  y {:7.1f}  z {:7.1f} mm   buttons {}{}", mm.x(), mm.y(), mm.z(),
                     buttons_of(reading.buttons), reading.forces_on ? "" : "   motors off");
}

/// The place of a virtual hand, as in the part of the device test that tries the workspace.
void move_hand(const DeviceUnderTest& bench, double share) {
  if (bench.hand) {
    const double begin = DeviceCheck::start_of(CheckPart::kMove);
    const double end = DeviceCheck::start_of(CheckPart::kPush);
    bench.hand(CheckPart::kMove, begin + share * (end - begin));
  }
}

std::string words_of(const channel::ChannelSet::Seen& seen) {
  std::string words;
  const auto& quantities = seen.options->plan.quantities;
  for (std::size_t i = 0; seen.state.live && i < quantities.size(); ++i) {
    const double value = seen.state.values[i];
    words +=
        fmt::format("{}{} {} {}", words.empty() ? "" : ", ", quantities[i].name,
                    std::isfinite(value) ? fmt::format("{:.4g}", value) : "-", quantities[i].unit);
  }
  if (words.empty()) {
    words = seen.state.live ? "connected" : "lost";
  }
  return fmt::format("{}: {}", seen.options->name, words);
}

}  // namespace

int print_live_device(const DeviceTestOptions& options, const DeviceSetup& setup) {
  const DeviceUnderTest bench = make_bench(options, setup);
  const device::DeviceInfo& info = bench.device->info();
  print_line(fmt::format("{}{}, without force", info.name, info.simulated ? " (simulated)" : ""));
  const auto begin = Clock::now();
  double shown = -kBetween;
  bool good = true;
  for (std::int64_t tick = 1; !interrupted(); ++tick) {
    const double seconds = static_cast<double>(tick) / kDeviceTestRate;
    if (seconds > options.seconds) {
      break;
    }
    std::this_thread::sleep_until(begin + std::chrono::duration<double>(seconds));
    move_hand(bench, seconds / options.seconds);
    device::DeviceReading reading;
    const bool answered = bench.device->read(reading) && bench.device->write({});
    good = good && answered;
    if (seconds - shown >= kBetween) {
      shown = seconds;
      print_line(answered ? words_of(reading)
                          : fmt::format("no answer: {}", bench.device->trouble()));
    }
  }
  return good ? 0 : 1;
}

int print_live_channels(const protocols::Definition& definition, double seconds) {
  const auto begin = Clock::now();
  const auto now = [begin] { return std::chrono::nanoseconds(Clock::now() - begin).count(); };
  channel::ChannelSet channels(definition.channels, {}, true);
  for (const std::string& notice : channels.start(now, {})) {
    print_line(notice);
  }
  channels.begin();
  bool all = true;
  while (!interrupted() && 1e-9 * static_cast<double>(now()) < seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(kBetween));
    channels.collect(now(), [](const record::Rows&) {});
    all = true;
    std::string line;
    for (const channel::ChannelSet::Seen& seen : channels.seen()) {
      all = all && seen.state.live;
      line += (line.empty() ? "" : "   ") + words_of(seen);
    }
    print_line(line);
  }
  return all ? 0 : 1;
}

}  // namespace haptrial::experiments
