#include "core/bone/nerve/nerve_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace haptrial::nerve {
namespace {

using EventKind = record::NerveEventRow::Kind;
using Cause = record::NerveThresholdRow::Cause;

constexpr double kBetweenBranches = 0.0009;  // that an answer comes later from muscle to muscle [s]
constexpr double kAnswerWithin = 0.02;       // after a stimulus an event is its answer [s]
constexpr double kSpikeStep = 0.05;          // share by which a spike differs from muscle to muscle

EventKind kind_of(SimulatedDischarge::Kind kind) {
  switch (kind) {
    case SimulatedDischarge::Kind::kTrain:
      return EventKind::kTrain;
    case SimulatedDischarge::Kind::kResponse:
      return EventKind::kResponse;
    case SimulatedDischarge::Kind::kArtefact:
      return EventKind::kArtefact;
    default:
      return EventKind::kBurst;
  }
}

}  // namespace

std::vector<Channel> channels_of(const NerveSetup& setup) {
  std::vector<Channel> channels;
  for (std::size_t n = 0; n < setup.nerves.size(); ++n) {
    for (const std::string& name : setup.nerves[n].channels) {
      channels.push_back({name, setup.nerves[n].name, n});
    }
  }
  return channels;
}

NerveSimulation::NerveSimulation(const NerveSetup& setup, double rate, std::uint64_t seed,
                                 PulseCurrent pulse)
    : setup_(setup),
      channels_(channels_of(setup)),
      samples_a_tick_(samples_a_tick(rate)),
      common_(seed, "drill at the electrodes"),
      branches_(seed, "branches"),
      monitor_(setup.monitor, channels_.size()),
      stimulator_(pulse ? std::move(pulse)
                        : std::make_shared<std::atomic<float>>(static_cast<float>(setup.current)),
                  rate),
      muted_(channels_.size(), setup.muted),
      settings_(channels_.size()),
      stimulus_(channels_.size(), 0) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    emg_.emplace_back(setup.emg, seed, fmt::format("muscle {}", channels_[i].name));
  }
}

std::uint64_t NerveSimulation::tick_of(std::uint64_t sample) const noexcept {
  return first_ + sample / samples_a_tick_;
}

std::span<const record::NerveEventRow> NerveSimulation::ended() const noexcept {
  return std::span(rows_.events).subspan(std::min(ended_, rows_.events.size()));
}

void NerveSimulation::tick(const NerveTick& tick, bool heard) {
  if (!begun_) {
    begun_ = true;
    first_ = tick.sequence;
  }
  ended_ = rows_.events.size();
  const auto searched = stimulator_.searching();
  const bool quiet = !searched || !monitor_.channel(*searched).tone;
  discharge(tick);
  make(tick);
  look(tick, heard);
  note_settings(tick.sequence);
  stimulator_.follow(tick.sequence, static_cast<double>(tick.current), quiet, ended(),
                     rows_.stimuli);
}

/// One of the nerve's muscles at random: what irritates a nerve seldom reaches all of its fibres.
std::optional<std::size_t> NerveSimulation::branch(std::size_t nerve) noexcept {
  const auto count = static_cast<std::uint64_t>(
      std::count_if(channels_.begin(), channels_.end(),
                    [&](const Channel& channel) { return channel.of == nerve; }));
  const auto first = static_cast<std::size_t>(
      std::find_if(channels_.begin(), channels_.end(),
                   [&](const Channel& channel) { return channel.of == nerve; }) -
      channels_.begin());
  return count > 0 ? std::optional(first + branches_.below(count)) : std::nullopt;
}

void NerveSimulation::plant(const NerveTick& tick, std::size_t channel,
                            const SimulatedDischarge& planted) {
  const NerveTick::OfNerve& nerve = tick.nerves[channels_[channel].of];
  record::NerveDischargeRow row;
  row.sequence = tick.sequence;
  row.channel = static_cast<std::int32_t>(channel);
  row.kind = kind_of(planted.kind);
  row.end = tick_of(planted.last);
  row.amplitude = planted.amplitude;
  row.distance = static_cast<double>(nerve.distance);
  row.warmth = static_cast<double>(nerve.warmth);
  row.current =
      planted.kind == SimulatedDischarge::Kind::kResponse ? static_cast<double>(tick.current) : 0.0;
  rows_.discharges.push_back(row);
}

void NerveSimulation::discharge(const NerveTick& tick) {
  for (std::size_t n = 0; n < setup_.nerves.size(); ++n) {
    const NerveTick::OfNerve& nerve = tick.nerves[n];
    const auto severity = static_cast<double>(nerve.severity);
    if (const auto at = nerve.burst ? branch(n) : std::nullopt) {
      plant(tick, *at, emg_[*at].burst(severity));
    }
    if (const auto at = nerve.train ? branch(n) : std::nullopt) {
      plant(tick, *at, emg_[*at].train(severity));
    }
  }
  if (!(tick.current > 0.0f)) {
    return;
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const NerveTick::OfNerve& nerve = tick.nerves[channels_[i].of];
    stimulus_[i] = emg_[i].samples() + 1;
    const double amplitude = answer_to(static_cast<double>(tick.current),
                                       static_cast<double>(nerve.distance), setup_.stimulation);
    if (nerve.distance < NerveDistances::kFar && amplitude > setup_.emg.background) {
      const double latency = setup_.stimulation.latency + kBetweenBranches * static_cast<double>(i);
      plant(tick, i, emg_[i].response(latency, amplitude));
    }
  }
}

void NerveSimulation::make(const NerveTick& tick) {
  const bool works = tick.drilling || tick.suction;
  const bool switched = works != worked_;
  worked_ = works;
  Emg::Artefacts artefacts;
  artefacts.common = common_.step(samples_a_tick_);
  artefacts.drilling = tick.drilling;
  artefacts.suction = tick.suction;
  artefacts.stimulus = tick.current > 0.0f;
  for (std::size_t i = 0; i < emg_.size(); ++i) {
    const double reaches = setup_.emg.spike * (1.0 - kSpikeStep * static_cast<double>(i));
    artefacts.spike = switched ? static_cast<float>(reaches) : 0.0f;
    samples_[i] = emg_[i].step(artefacts, samples_a_tick_);
  }
  if (switched) {
    rows_.discharges.push_back(
        {tick.sequence, -1, EventKind::kArtefact, tick.sequence, setup_.emg.spike, 0.0, 0.0, 0.0});
  }
}

void NerveSimulation::look(const NerveTick& tick, bool heard) {
  std::array<float, kMostChannels> now{};
  for (std::size_t s = 0; s < samples_a_tick_; ++s) {
    record::EmgRow row;
    row.sequence = tick.sequence;
    row.sample = static_cast<std::uint8_t>(s);
    for (std::size_t i = 0; i < emg_.size(); ++i) {
      now[i] = samples_[i][s];
      row.channels[i] = static_cast<double>(now[i]);
    }
    rows_.emg.push_back(row);
    monitor_.look({now.data(), emg_.size()}, s == 0 && tick.current > 0.0f);
  }
  for (const NerveEvent& e : monitor_.ended()) {
    record::NerveEventRow row;
    const std::uint64_t pulse = stimulus_[e.channel];
    const bool answers = pulse > 0 && e.first + 1 >= pulse &&
                         e.first + 1 - pulse <= static_cast<std::uint64_t>(kAnswerWithin * rate());
    row.sequence = tick.sequence;
    row.channel = e.channel;
    row.kind = e.artefact            ? EventKind::kArtefact
               : answers             ? EventKind::kResponse
               : e.train_time > 0.0f ? EventKind::kTrain
                                     : EventKind::kBurst;
    row.begin = tick_of(e.first);
    row.end = tick_of(e.last);
    row.peak = static_cast<double>(e.peak);
    row.threshold = monitor_.channel(e.channel).threshold;
    row.train_time = static_cast<double>(e.train_time);
    row.heard = heard && !muted_[e.channel];
    rows_.events.push_back(row);
  }
  monitor_.forget_ended();
}

void NerveSimulation::note_settings(std::uint64_t sequence) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    record::NerveThresholdRow& last = settings_[i];
    const double threshold = monitor_.channel(i).threshold;
    if (threshold != last.threshold || muted_[i] != last.muted) {
      const Cause cause = last.threshold == 0.0 ? Cause::kStart
                          : by_technician_      ? Cause::kTechnician
                                                : Cause::kMonitor;
      last = {sequence, static_cast<std::int32_t>(i), threshold, muted_[i], cause};
      rows_.thresholds.push_back(last);
    }
  }
  by_technician_ = false;
}

void NerveSimulation::set_threshold(std::size_t channel, double threshold) {
  monitor_.set_threshold(channel, threshold);
  by_technician_ = true;
}

void NerveSimulation::set_muted(std::size_t channel, bool muted) {
  muted_[channel] = muted;
  by_technician_ = true;
}

}  // namespace haptrial::nerve
