#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/sound/card_player.h"
#include "core/sound/cue.h"
#include "core/sound/onset_latency.h"
#include "core/sound/wav.h"
#include "experiments/command/sessions/certify_device.h"
#include "experiments/command/sessions/device_bench.h"
#include "experiments/command/sessions/live_reading.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

/// The samples of a sound that are the same in each trial.
std::vector<float> samples_of(const DeviceTestOptions& options) {
  if (options.definition.empty()) {
    throw InputError("--loopback needs --definition FILE, which states the sound");
  }
  const Experiment experiment = load_experiment(options.definition);
  const sound::CueSet* set = experiment.definition->sounds();
  std::vector<std::string> names;
  for (const sound::Cue& cue : set == nullptr ? std::vector<sound::Cue>{} : set->cues) {
    if (cue.name == options.name && (cue.varies || cue.kind == sound::Cue::Kind::kNoise)) {
      throw InputError(fmt::format(
          "sounds.{} is not the same in each session; record a tone, a click or a file without "
          "formulas",
          cue.name));
    }
    if (cue.name == options.name) {
      return sound::rendered(cue, 0);
    }
    names.push_back(cue.name);
  }
  throw InputError(names.empty() ? fmt::format("{} has no [sounds]", options.definition)
                                 : not_allowed("NAME", fmt::format("'{}'", options.name), names));
}

/// The channels of pulses and sound.
std::vector<sound::Recording> channels_of(const std::string& file) {
  std::vector<sound::Recording> channels = sound::read_channels(file);
  if (channels.size() != 2 || channels.front().rate != sound::CardPlayer::kRate) {
    throw InputError(fmt::format(
        "{}: has {} channels of {:g} samples a second; allowed: 2, the markers' pulses and the "
        "sound, of {:g}",
        file, channels.size(), channels.front().rate, sound::CardPlayer::kRate));
  }
  return channels;
}

double median_of_sorted(const std::vector<double>& values) {
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

std::vector<double> sorted(const std::vector<sound::HeardOnset>& onsets,
                           double sound::HeardOnset::*part) {
  std::vector<double> values;
  for (const sound::HeardOnset& onset : onsets) {
    if (onset.heard) {
      values.push_back(onset.*part);
    }
  }
  std::ranges::sort(values);
  return values;
}

void print(const std::vector<sound::HeardOnset>& onsets) {
  constexpr double kOff = 4e-4;  // that says something [s]
  const std::vector<double> latencies = sorted(onsets, &sound::HeardOnset::latency);
  fmt::print("latency     median {:.2f} ms, {:.2f} to {:.2f} ms ({} onsets)\n",
             1e3 * median_of_sorted(latencies), 1e3 * latencies.front(), 1e3 * latencies.back(),
             latencies.size());
  const double off = median_of_sorted(sorted(onsets, &sound::HeardOnset::off));
  if (std::abs(off) > kOff) {
    fmt::print(
        "warning     the recording is not this sound alone: it leaves its noise {:.2f} ms after "
        "the pulse (median), {:.2f} ms {} than such a sound would. The latency above is wrong; an "
        "actuator that rings up has begun by then at the latest\n",
        1e3 * median_of_sorted(sorted(onsets, &sound::HeardOnset::left)), 1e3 * std::abs(off),
        off < 0.0 ? "earlier" : "later");
  }
}

/// Prints how long after the pulse of each marker a sound or vibration left the card, by a
/// recording of both.
/// @returns the exit status: 1 if a pulse is not followed by the sound
/// @throws InputError for a definition without the sound, and a recording that shows no onset
int measure_loopback(const DeviceTestOptions& options) {
  const std::vector<float> sound = samples_of(options);
  const std::vector<sound::Recording> channels = channels_of(options.loopback);
  const auto onsets = sound::onset_latencies(channels[0].samples, channels[1].samples, sound,
                                             sound::CardPlayer::kRate);
  if (onsets.empty()) {
    throw InputError(
        fmt::format("{}: the first channel has no pulse that stands out of its noise; lead the "
                    "markers' output to it",
                    options.loopback));
  }
  const auto heard = std::ranges::count_if(onsets, &sound::HeardOnset::heard);
  if (heard == 0) {
    throw InputError(
        fmt::format("{}: the second channel has sounds.{} within 0.5 s of none of the {} pulses; "
                    "lead the card's output to it",
                    options.loopback, options.name, onsets.size()));
  }
  print(onsets);
  for (const sound::HeardOnset& onset : onsets) {
    if (!onset.heard) {
      fmt::print("no sound    after the pulse at {:.3f} s\n", onset.pulse);
    }
  }
  return heard == std::ssize(onsets) ? 0 : 1;
}

/// The speed and jump of a hand that tries the workspace are not those of a trial.
device::EnvelopeLimits limits_of(const device::DeviceInfo& info, const DeviceSetup& setup) {
  device::EnvelopeLimits limits;
  limits.holding_force = setup.holding_force;
  limits.max_force = 0.4 * info.max_force;
  limits.max_force_rate = 200.0;
  limits.workspace_radius = 2.0 * info.workspace_radius;  // further than the handle can go
  limits.max_speed = 2.0;
  limits.max_jump = 0.02;  // a fast hand, and a loop that was late
  limits.ramp_in = 0.0;
  return limits;
}

const char* prompt(CheckPart part) {
  switch (part) {
    case CheckPart::kRest:
      return "hold the handle still in the middle";
    case CheckPart::kMove:
      return "move the handle to every side: left and right, up and down, near and far";
    case CheckPart::kPush:
      return "hold the handle loosely in the middle: the device pushes gently, six times";
    case CheckPart::kButton:
      return "press a button of the handle";
    case CheckPart::kDone:
      break;
  }
  return "";
}

/// Runs the loop on a thread of its own, and tells the person what to do.
void run_check(DeviceCheck& check, device::Device& device, realtime::ServoLoop& loop, bool person) {
  TaskStop stop(check, device);
  const WatchedStop watched(stop);
  std::thread servo([&] {
    stop.set_servo_thread();
    loop.run(check);
  });
  std::optional<CheckPart> told;
  while (check.part() != CheckPart::kDone) {
    if (person && told != check.part() && check.part() != CheckPart::kDone) {
      told = check.part();
      fmt::print("-> {}\n", prompt(*told));
      std::fflush(stdout);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  servo.join();
  if (interrupted()) {
    throw RunError("interrupted; the check came to no verdict");
  }
}

/// @returns 0 when the device is fit for use, else 1.
int device_test(const DeviceTestOptions& options) {
  watch_for_interrupt();
  watch_fatal_signals();
  constexpr double kLeast = 1.0;
  constexpr double kMost = 3600.0;
  if (!(options.seconds >= kLeast && options.seconds <= kMost)) {
    throw InputError(fmt::format("--seconds is {}; allowed: a number from {} to {} [s]",
                                 options.seconds, kLeast, kMost));
  }
  if (!options.loopback.empty()) {
    return measure_loopback(options);
  }
  const DeviceSetup setup = setup_of(options);
  if (!options.certificate.empty()) {
    return certify_device(options, setup);
  }
  if (options.mass != 0.0 || options.without_sensor || !options.sensor.empty() ||
      !options.grip_sensor.empty()) {
    throw InputError(
        "--mass, --sensor, --grip-sensor and --without-sensor belong to "
        "--certificate FOLDER");
  }
  if (options.read) {
    return print_live_device(options, setup);
  }
  DeviceUnderTest bench = make_bench(options, setup);
  const device::DeviceInfo& info = bench.device->info();
  fmt::print("{}{}: {:.1f} N, workspace radius {:.0f} mm\n", info.name,
             info.simulated ? " (simulated)" : "", info.max_force, 1e3 * info.workspace_radius);
  const auto ticks = static_cast<std::uint64_t>(std::lround(options.seconds * kDeviceTestRate));
  DeviceCheck check(*bench.device, limits_of(info, setup), ticks, bench.hand);
  realtime::ServoLoop loop(realtime::ClockKind::kReal, kDeviceTestRate);
  run_check(check, *bench.device, loop, !bench.hand);

  bool good = true;
  for (const Verdict& v : judge(check.findings(), loop, bench.reach, bench.has_button)) {
    fmt::print("{}  {:<12} {}\n", v.good ? "good" : "FAIL", v.what, v.text);
    good = good && v.good;
  }
  fmt::print("      {:<12} {} took longer than a period\n", "calls", bench.device->slow_calls());
  for (const std::string& margin : setup.margins) {
    fmt::print("      {:<12} {}\n", "margin", margin);
  }
  if (!loop.real_time_status().notice.empty()) {
    fmt::print("{}\n", loop.real_time_status().notice);
  }
  fmt::print("verdict: {} {}\n", options.name, good ? "is fit for use" : "is NOT fit for use");
  return good ? 0 : 1;
}

}  // namespace

void add_device_test(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "device-test", "Check whether a device is fit for experiments",
                             "haptrial device-test force-dimension", {"", "devices.md"});
  auto& o = options_of<DeviceTestOptions>(*sub, status, device_test);
  sub->add_option("NAME", o.name,
                  fmt::format("Device: virtual, mouse, {} or one of this program's own; with "
                              "--loopback a sound of the definition",
                              fmt::join(device::vendor_names(), ", ")))
      ->required();
  sub->add_option(
      "--definition", o.definition,
      "Definition whose set-up of the device is checked (.toml) (default: the driver's own)");
  sub->add_option("--seconds", o.seconds, with_default("Duration [s]", o.seconds));
  sub->add_flag("--read", o.read,
                "Print where the handle is and which buttons are pressed, without force");
  sub->add_option("--certificate", o.certificate,
                  "Folder for a certificate: what the device does, with intervals");
  sub->add_option("--mass", o.mass,
                  "Known mass that you fix to the handle for a certificate [kg] (default: none)");
  sub->add_option("--sensor", o.sensor,
                  "Channel of the definition, a force sensor to which you clamp the handle for a "
                  "certificate; one that also measures torque is the rotation's sensor, too");
  sub->add_option("--grip-sensor", o.grip_sensor,
                  "Channel of the definition that measures the grip force as the quantity grip");
  sub->add_option(
      "--sensor-axes", o.sensor_axes,
      with_default("Axes of the world along which the sensor's x, y and z point", o.sensor_axes));
  sub->add_flag("--without-sensor", o.without_sensor,
                "Certificate of the virtual device without its simulated force sensor");
  sub->add_option("--loopback", o.loopback,
                  "Recording of a session with the sound NAME, whose latency is measured: markers' "
                  "pulses in the first channel, the sound in the second");
  sub->add_option("--library", o.library,
                  "Path of the vendor's library (default: found by the system)");
}

}  // namespace haptrial::experiments
