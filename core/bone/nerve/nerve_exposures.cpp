#include "core/bone/nerve/nerve_exposures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace haptrial::nerve {

NerveExposures::NerveExposures(const NerveSetup& setup,
                               std::shared_ptr<const NerveDistances> distances, std::uint64_t seed,
                               double dt, std::shared_ptr<const std::atomic<float>> current)
    : distances_(std::move(distances)),
      heat_(setup.heat),
      current_(current ? std::move(current)
                       : std::make_shared<std::atomic<float>>(static_cast<float>(setup.current))),
      dt_(dt),
      between_pulses_(1.0 / setup.pulses),
      since_pulse_(between_pulses_) {
  for (const WatchedNerve& nerve : setup.nerves) {
    nerves_.emplace_back(setup.exposure, seed, fmt::format("nerve {}", nerve.name));
  }
}

namespace {

/// Distances from the tool's surface.
NerveDistances::Distances surface_distances(const NerveDistances& nerves,
                                            const ToolAtNerves& tool) noexcept {
  const auto from = [&nerves](const Eigen::Vector3d& centre_B, double radius) {
    NerveDistances::Distances distances = nerves.at(centre_B);
    for (float& distance : distances) {
      distance = distance < NerveDistances::kFar ? distance - static_cast<float>(radius)
                                                 : NerveDistances::kFar;
    }
    return distances;
  };
  NerveDistances::Distances least = from(tool.tip_B, tool.radius);
  for (std::size_t ball = 0; ball < tool.balls; ++ball) {
    const auto other = from(tool.more[ball].centre_B, tool.more[ball].radius);
    for (std::size_t nerve = 0; nerve < least.size(); ++nerve) {
      least[nerve] = std::min(least[nerve], other[nerve]);
    }
  }
  return least;
}

}  // namespace

NerveTick NerveExposures::step(const ToolAtNerves& tool) noexcept {
  using Kind = ToolAtNerves::Kind;
  NerveTick tick;
  const bool works = tool.power > 0.0;
  tick.drilling = works && tool.kind == Kind::kBurr;
  tick.suction = works && tool.kind == Kind::kSuction;
  since_pulse_ += dt_;
  if (works && tool.kind == Kind::kProbe && since_pulse_ >= between_pulses_) {
    since_pulse_ = 0.0;
    tick.current = current_->load(std::memory_order_relaxed);
  }
  Exposure exposure;
  exposure.force = tool.force;
  exposure.speed = tool.speed;
  exposure.drilling = tick.drilling;
  exposure.suction = tick.suction;
  exposure.power = tick.drilling ? heat_ * tool.force * tool.power : 0.0;
  // Whatever carries no burr, tube or probe lies nowhere.
  const bool there = tool.kind != Kind::kOther;
  const NerveDistances::Distances distances = surface_distances(*distances_, tool);
  for (std::size_t i = 0; i < nerves_.size(); ++i) {
    NerveTick::OfNerve& nerve = tick.nerves[i];
    nerve.distance = there ? distances[i] : NerveDistances::kFar;
    exposure.distance = static_cast<double>(nerve.distance);
    const NerveEvents events = nerves_[i].step(exposure, dt_);
    nerve.burst = events.burst;
    nerve.train = events.train;
    nerve.severity = static_cast<float>(events.severity);
    nerve.warmth = static_cast<float>(nerves_[i].warmth());
  }
  return tick;
}

}  // namespace haptrial::nerve
