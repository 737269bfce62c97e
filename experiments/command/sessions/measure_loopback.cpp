#include "experiments/command/sessions/measure_loopback.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
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

void print(std::vector<double> latencies) {
  std::ranges::sort(latencies);
  const std::size_t n = latencies.size();
  const double median = 0.5 * (latencies[(n - 1) / 2] + latencies[n / 2]);
  fmt::print("latency     median {:.2f} ms, {:.2f} to {:.2f} ms ({} onsets)\n", 1e3 * median,
             1e3 * latencies.front(), 1e3 * latencies.back(), n);
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
  std::vector<double> latencies;
  for (const sound::HeardOnset& onset : onsets) {
    if (onset.heard) {
      latencies.push_back(onset.latency);
    }
  }
  if (latencies.empty()) {
    throw InputError(
        fmt::format("{}: the second channel has sounds.{} within 0.5 s of none of the {} pulses; "
                    "lead the card's output to it",
                    options.loopback, options.name, onsets.size()));
  }
  print(latencies);
  for (const sound::HeardOnset& onset : onsets) {
    if (!onset.heard) {
      fmt::print("no sound    after the pulse at {:.3f} s\n", onset.pulse);
    }
  }
  return latencies.size() == onsets.size() ? 0 : 1;
}

}  // namespace haptrial::experiments
