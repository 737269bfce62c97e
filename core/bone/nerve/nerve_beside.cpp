#include "core/bone/nerve/nerve_beside.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace haptrial::nerve {
namespace {

const char* word_of(record::NerveEventRow::Kind kind) {
  using Kind = record::NerveEventRow::Kind;
  switch (kind) {
    case Kind::kTrain:
      return "train";
    case Kind::kResponse:
      return "response";
    case Kind::kArtefact:
      return "artefact";
    default:
      return "burst";
  }
}

}  // namespace

bool has_tone(const NerveSimulation& simulation) noexcept {
  for (std::size_t i = 0; i < simulation.channels().size(); ++i) {
    if (simulation.monitor().channel(i).tone && !simulation.muted(i)) {
      return true;
    }
  }
  return false;
}

void SteppedNerves::after_tick(const NerveTick& tick) noexcept {
  if (!simulation_) {
    simulation_ = make_(tick.sequence);
  }
  simulation_->tick(tick, heard_);
  tone_ = heard_ && has_tone(*simulation_);
}

record::NerveRows SteppedNerves::take() {
  return simulation_ ? std::exchange(simulation_->rows(), {}) : record::NerveRows{};
}

ThreadedNerves::ThreadedNerves(MakeNerveSimulation make, double rate, NerveListeners listeners)
    : make_(std::move(make)), rate_(rate), listeners_(std::move(listeners)) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ThreadedNerves::run(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kBetween{2};
  while (!stop.stop_requested()) {
    if (work() == 0) {
      std::this_thread::sleep_for(kBetween);
    }
  }
}

std::size_t ThreadedNerves::work() {
  obey();
  const std::size_t count = ticks_.flush([this](std::span<const NerveTick> ticks) {
    const bool heard = heard_.load(std::memory_order_relaxed);
    for (const NerveTick& tick : ticks) {
      if (!simulation_) {
        simulation_ = make_(tick.sequence);
      }
      simulation_->tick(tick, heard);
      tone_.store(heard && has_tone(*simulation_), std::memory_order_relaxed);
      follow(tick, heard);
    }
    const std::lock_guard lock(mutex_);
    rows_.append(simulation_->rows());
    simulation_->rows().clear();
  });
  done_.fetch_add(count, std::memory_order_release);
  return count;
}

void ThreadedNerves::follow(const NerveTick& tick, bool heard) {
  if (listeners_.voice) {
    speak(heard);
  }
  if (listeners_.buffer) {
    show(tick, heard);
  }
}

void ThreadedNerves::speak(bool heard) {
  VoiceTick voice;
  for (std::size_t i = 0; heard && i < simulation_->channels().size(); ++i) {
    if (simulation_->muted(i)) {
      continue;
    }
    const ChannelState& state = simulation_->monitor().channel(i);
    const std::span<const float> samples = simulation_->samples(i);
    voice.count = static_cast<std::uint16_t>(samples.size());
    voice.tones[i] = state.tone ? static_cast<float>(state.frequency) : 0.0f;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      voice.raw[s] += samples[s];
    }
  }
  listeners_.voice->push(voice);
}

void ThreadedNerves::show(const NerveTick& tick, bool heard) {
  const std::size_t channels = simulation_->channels().size();
  const double seconds = static_cast<double>(tick.sequence) / rate_;
  if (in_column_ == 0) {
    column_.assign(channels, {1.0f, -1.0f});
  }
  for (std::size_t i = 0; i < channels; ++i) {
    for (const float sample : simulation_->samples(i)) {
      column_[i].low = std::min(column_[i].low, sample);
      column_[i].high = std::max(column_[i].high, sample);
    }
  }
  for (const record::NerveEventRow& e : simulation_->ended()) {
    const auto ticks = static_cast<double>(e.end - e.begin + 1);
    listeners_.buffer->add_event({static_cast<double>(e.begin) / rate_,
                                  static_cast<std::size_t>(e.channel), word_of(e.kind),
                                  ticks / rate_, e.peak, e.threshold, e.train_time});
  }
  if (static_cast<double>(++in_column_) < MonitorBuffer::kColumn * rate_) {
    return;
  }
  in_column_ = 0;
  std::vector<MonitorChannel> shown;
  for (std::size_t i = 0; i < channels; ++i) {
    const ChannelState& s = simulation_->monitor().channel(i);
    const Channel& channel = simulation_->channels()[i];
    shown.push_back({channel.name, channel.nerve, s.threshold, simulation_->muted(i), s.tone,
                     s.shown, s.frequency, s.train_time, s.events, s.artefacts});
  }
  listeners_.buffer->add_column(column_);
  const Stimulator& probe = simulation_->stimulator();
  listeners_.buffer->show(std::move(shown), {probe.current(), probe.searching(), probe.found()},
                          seconds, heard);
}

/// Carries out the technician's requests.
void ThreadedNerves::obey() {
  if (!listeners_.buffer || !simulation_) {
    return;
  }
  using What = MonitorOrder::What;
  for (const MonitorOrder& order : listeners_.buffer->take_orders()) {
    if (order.what == What::kStimulus) {
      simulation_->stimulator().set(order.current);
    } else if (order.channel >= simulation_->channels().size()) {
      continue;
    } else if (order.what == What::kMute) {
      simulation_->set_muted(order.channel, order.muted);
    } else if (order.what == What::kSearch) {
      simulation_->stimulator().search(order.channel);
    } else {
      simulation_->set_threshold(order.channel, order.threshold);
    }
  }
}

record::NerveRows ThreadedNerves::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(rows_, {});
}

void ThreadedNerves::settle() {
  const std::uint64_t wanted = ticks_.pushed();
  constexpr std::chrono::milliseconds kBetween{1};
  while (done_.load(std::memory_order_acquire) < wanted) {
    std::this_thread::sleep_for(kBetween);
  }
}

}  // namespace haptrial::nerve
