#include "core/bone/nerve/monitor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::nerve {

NerveMonitor::NerveMonitor(const MonitorParameters& parameters, std::size_t channels)
    : p_(parameters) {
  if (channels < 1 || channels > kMostChannels) {
    throw std::invalid_argument("NerveMonitor: channels must be 1 to 8");
  }
  channels_.resize(channels);
  state_.resize(channels);
  for (std::size_t i = 0; i < channels; ++i) {
    set_threshold(i, p_.threshold);
    state_[i].frequency = p_.lowest_tone * std::pow(p_.tone_step, static_cast<double>(i));
  }
}

void NerveMonitor::set_threshold(std::size_t i, double threshold) noexcept {
  channels_[i].base = state_[i].threshold = threshold;
}

std::uint64_t NerveMonitor::samples_of(double seconds) const noexcept {
  return static_cast<std::uint64_t>(std::llround(seconds * p_.rate));
}

void NerveMonitor::look(std::span<const float> samples, bool stimulus) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& c = channels_[i];
    if (stimulus) {
      c.blind_until = at_ + samples_of(p_.blanked);
    }
    const double size = at_ >= c.blind_until ? std::abs(samples[i]) : 0.0;
    if (size > 0.5 * state_[i].threshold) {
      c.half = at_ + 1;
    }
    if (size > state_[i].threshold) {
      cross(i, samples[i]);
    }
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    look_around(i);
    discharge(i);
    if (channels_[i].open && at_ - channels_[i].event.last > samples_of(p_.event_gap)) {
      end_event(i);
    }
    adapt(i);
  }
  ++at_;
}

/// Half a millisecond after the crossing that a discharge began with: what did the others do?
void NerveMonitor::look_around(std::size_t i) noexcept {
  Channel& c = channels_[i];
  const std::uint64_t near = samples_of(0.0005);
  if (c.peak_at == 0 || at_ + 1 != c.peak_at + near) {
    return;
  }
  bool everywhere = p_.artefact_filter && channels_.size() > 1;
  for (std::size_t other = 0; other < channels_.size(); ++other) {
    const std::uint64_t half = channels_[other].half;
    everywhere = everywhere && half > 0 && at_ + 1 - half <= 2 * near;
  }
  c.genuine = c.genuine || !everywhere;
}

void NerveMonitor::cross(std::size_t i, float value) noexcept {
  Channel& c = channels_[i];
  if (!c.open) {
    c.open = true;
    c.event = {at_, at_, 0.0f, 0.0f, static_cast<std::uint8_t>(i), false};
    c.genuine = false;
    c.train_length = 0;
    c.last_discharge = 0;
    c.peak_at = 0;
  }
  c.event.last = at_;
  c.event.peak = std::max(c.event.peak, std::abs(value));
  if (c.peak_at == 0) {
    c.peak_at = at_ + 1;  // the first crossing stands for the discharge
  }
  c.crossed = at_ + 1;
}

/// A discharge is over when nothing crossed for 2 ms; its interval to the one before may go on with
/// a train.
void NerveMonitor::discharge(std::size_t i) noexcept {
  Channel& c = channels_[i];
  if (c.peak_at == 0 || at_ + 1 - c.crossed < samples_of(0.002)) {
    return;
  }
  const std::uint64_t place = c.peak_at - 1;
  c.peak_at = 0;
  const auto interval = static_cast<double>(place - c.last_discharge);
  const bool between =
      c.last_discharge > 0 && interval >= 0.004 * p_.rate && interval <= 0.02 * p_.rate;
  const bool even =
      c.train_length == 0 || std::abs(interval - c.mean_interval) <= 0.25 * c.mean_interval;
  if (between && even) {
    c.mean_interval += (interval - c.mean_interval) / (c.train_length + 1);
    ++c.train_length;
  } else {
    end_train(i);
    c.train_first = place;
  }
  c.last_discharge = place;
}

void NerveMonitor::end_train(std::size_t i) noexcept {
  Channel& c = channels_[i];
  constexpr int kIntervals = 5;  // six discharges
  if (c.train_length >= kIntervals && c.genuine) {
    const double seconds = static_cast<double>(c.last_discharge - c.train_first) / p_.rate;
    c.event.train_time += static_cast<float>(seconds);
    state_[i].train_time += seconds;
  }
  c.train_length = 0;
  c.mean_interval = 0.0;
}

void NerveMonitor::end_event(std::size_t i) noexcept {
  Channel& c = channels_[i];
  end_train(i);
  c.event.artefact = !c.genuine;
  ++(c.event.artefact ? state_[i].artefacts : state_[i].events);
  if (ended_count_ < ended_.size()) {
    ended_[ended_count_++] = c.event;
  }
  c.open = false;
}

void NerveMonitor::adapt(std::size_t i) noexcept {
  Channel& c = channels_[i];
  ChannelState& s = state_[i];
  const bool was = s.tone;
  s.tone = c.open && c.genuine;
  if (s.tone && !was) {
    c.tone_since = at_;
  }
  const bool heard = c.crossed > 0;
  const std::uint64_t quiet = heard ? at_ + 1 - c.crossed : at_;
  s.shown = heard && quiet <= samples_of(p_.shown_for);
  if (s.tone && at_ - c.tone_since >= samples_of(p_.rises_after)) {
    s.threshold = std::max(s.threshold, std::min(p_.highest, 1.5 * s.threshold));
    c.tone_since = at_;
  } else if (!c.open && quiet >= samples_of(p_.returns_after)) {
    s.threshold = c.base;
  }
}

}  // namespace haptrial::nerve
