#include "experiments/command/sessions/measure_loopback.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/sound/card_player.h"
#include "core/sound/cue.h"
#include "core/sound/onset_latency.h"
#include "core/sound/wav.h"
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

}  // namespace

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

}  // namespace haptrial::experiments
