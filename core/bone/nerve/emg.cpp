#include "core/bone/nerve/emg.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace haptrial::nerve {

constexpr double kUnitTime = 0.004;  // of one discharge [s]

Emg::Emg(const EmgParameters& parameters, std::uint64_t seed, std::string_view name)
    : p_(parameters),
      random_(seed, std::string(name) + " discharges"),
      noise_(seed, std::string(name) + " noise") {
  wave_length_ = std::min<std::size_t>(wave_.size(), std::lround(kUnitTime * p_.rate));
  double peak = 0.0;
  for (std::size_t i = 0; i < wave_length_; ++i) {  // one period under a bell: no constant part
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(wave_length_) - 0.5;
    wave_[i] = static_cast<float>(-std::sin(2.0 * std::numbers::pi * t) * std::exp(-12.0 * t * t));
    peak = std::max(peak, std::abs(static_cast<double>(wave_[i])));
  }
  for (float& value : wave_) {
    value /= static_cast<float>(peak);
  }
}

void Emg::discharge(std::uint64_t sample, double amplitude) noexcept {
  for (std::size_t i = 0; i < wave_length_ && sample + i < at_ + kAhead; ++i) {
    ahead_[(sample + i) % kAhead] += static_cast<float>(amplitude) * wave_[i];
  }
}

SimulatedDischarge Emg::burst(double severity) noexcept {
  const double seconds = 0.05 + 0.25 * severity * random_.uniform();
  const auto units = 5 + static_cast<int>(25.0 * severity * random_.uniform());
  const double strength = p_.unit * (0.5 + severity);
  SimulatedDischarge planted{SimulatedDischarge::Kind::kBurst, at_, at_, 0.0};
  for (int i = 0; i < units; ++i) {
    const auto sample = at_ + static_cast<std::uint64_t>(seconds * p_.rate * random_.uniform());
    const double amplitude = strength * std::exp(0.4 * random_.normal());
    discharge(sample, amplitude);
    planted.last = std::max(planted.last, sample + wave_length_ - 1);
    planted.amplitude = std::max(planted.amplitude, amplitude);
  }
  return planted;
}

SimulatedDischarge Emg::train(double severity) noexcept {
  const double seconds = 0.1 + 3.0 * severity * random_.uniform();
  Train train;
  train.next = at_;
  train.end = at_ + static_cast<std::uint64_t>(seconds * p_.rate);
  train.interval = p_.rate / random_.uniform(60.0, 200.0);
  train.amplitude = p_.unit * (0.8 + 1.5 * severity);
  const auto place = std::min_element(trains_.begin(), trains_.end(),
                                      [](const Train& a, const Train& b) { return a.end < b.end; });
  *place = train;  // in place of the one that ends soonest
  return {SimulatedDischarge::Kind::kTrain, at_, train.end, train.amplitude};
}

SimulatedDischarge Emg::response(double latency, double amplitude) noexcept {
  const auto first = at_ + static_cast<std::uint64_t>(latency * p_.rate);
  if (amplitude > 0.0) {
    discharge(first, amplitude);
  }
  return {SimulatedDischarge::Kind::kResponse, first, first + wave_length_ - 1, amplitude};
}

std::span<const float> Emg::step(const Artefacts& artefacts, std::size_t count) noexcept {
  for (Train& train : trains_) {
    while (train.next < train.end && train.next < at_ + count) {
      discharge(train.next, train.amplitude * (1.0 + 0.03 * random_.normal()));
      const double even = train.interval * (1.0 + 0.02 * random_.normal());
      train.next += static_cast<std::uint64_t>(std::max(1.0, even));
    }
  }
  // A first-order low pass leaves of white noise the share (1 - a) / (1 + a) of its power.
  constexpr double kKeep = 0.5;
  const double scale = p_.background * std::sqrt((1.0 + kKeep) / (1.0 - kKeep)) * (1.0 - kKeep);
  const double common = artefacts.drilling ? p_.drilling : artefacts.suction ? p_.suction : 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    smooth_ = kKeep * smooth_ + scale * noise_.normal();
    float& coming = ahead_[(at_ + i) % kAhead];
    double value = static_cast<double>(coming) + smooth_;
    coming = 0.0f;
    if (common > 0.0 && i < artefacts.common.size()) {
      value += common * static_cast<double>(artefacts.common[i]);
    }
    constexpr double kSpikeTime = 2.0;  // samples, over which a spike falls to 1/e
    if (artefacts.spike != 0.0f) {
      value +=
          static_cast<double>(artefacts.spike) * std::exp(-static_cast<double>(i) / kSpikeTime);
    }
    if (artefacts.stimulus && i < 2) {
      value += i == 0 ? p_.stimulus : -0.6 * p_.stimulus;
    }
    out_[i] = static_cast<float>(value);
  }
  at_ += count;
  return std::span(out_).first(count);
}

std::span<const float> CommonNoise::step(std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    out_[i] = static_cast<float>(random_.normal());
  }
  return std::span(out_).first(count);
}

double answer_to(double current, double distance, const StimulationParameters& p) noexcept {
  const double threshold = p.threshold + p.per_distance * std::max(0.0, distance);
  return p.most / (1.0 + std::exp(-(current - threshold) / (0.25 * p.spread * threshold)));
}

}  // namespace haptrial::nerve
