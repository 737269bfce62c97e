#include "core/subject/perceiver/level_observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/subject/perceiver/trial_stream.h"

namespace haptrial::subject {

LevelObserver::LevelObserver(const SenseParameters& senses, Quantity quantity,
                             const Exploration& exploration, const JudgementParameters& judgement,
                             std::uint64_t session_seed)
    : senses_(senses),
      quantity_(quantity),
      exploration_(exploration),
      judgement_(judgement),
      seed_(session_seed),
      judge_(judgement, session_seed) {
  check(senses);
  const bool good = std::isfinite(exploration.press) && exploration.press > 0.0 &&
                    std::isfinite(exploration.depth) && exploration.depth >= 0.0 &&
                    std::isfinite(exploration.speed) && exploration.speed > 0.0;
  if (!good) {
    throw std::invalid_argument("LevelObserver: press and speed must be above 0, depth at least 0");
  }
}

ContactEpisode LevelObserver::met(double level) const noexcept {
  const auto spring = [this](double stiffness) {
    const bool fixed = exploration_.depth > 0.0;
    return ContactEpisode{stiffness, fixed ? stiffness * exploration_.depth : exploration_.press};
  };
  switch (quantity_) {
    case Quantity::kStiffness:
      return spring(level);
    case Quantity::kCompliance:
      return spring(1.0 / level);
    case Quantity::kViscosity:
      return {level, level * exploration_.speed};
    default:
      break;
  }
  return {level, level};
}

double LevelObserver::percept(double level, const FeltNoise& noise) const noexcept {
  return felt(senses_, quantity_, met(level), noise);
}

Decision LevelObserver::between(int trial, std::span<const double> levels,
                                Extreme extreme) noexcept {
  std::array<double, 16> percepts{};
  const std::size_t count = std::min(levels.size(), percepts.size());
  RandomStream random = trial_stream(seed_, "sense", trial);
  for (std::size_t i = 0; i < count; ++i) {
    percepts[i] = percept(levels[i], draw_noise(random));
  }
  judge_.begin_trial(trial);
  const Decision decision = judge_.between({percepts.data(), count}, extreme);
  judge_.set_previous(decision.answer);
  return decision;
}

Decision LevelObserver::yes_no(int trial, double level) noexcept {
  RandomStream random = trial_stream(seed_, "sense", trial);
  const double felt_level = percept(level, draw_noise(random));
  judge_.begin_trial(trial);
  const Decision decision = judge_.yes_no(felt_level);
  judge_.set_previous(decision.answer);
  return decision;
}

double LevelObserver::weber(double level) const noexcept {
  const auto root = [](double a, double b, double c) { return std::sqrt(a * a + b * b + c * c); };
  if (const auto at_once = weber_at_once(senses_, quantity_)) {
    return *at_once;
  }
  const double force = met(level).force;
  const double floor = force > 0.0 ? senses_.force_floor / force : 0.0;
  if (quantity_ == Quantity::kContrast) {
    return std::numbers::sqrt2 * senses_.force_weber / (1.0 - senses_.displacement_bias);
  }
  if (quantity_ == Quantity::kStiffness || quantity_ == Quantity::kCompliance) {
    const double all = root(senses_.force_weber, floor, senses_.displacement_weber);
    return exploration_.depth > 0.0 ? all : all / (1.0 - senses_.displacement_bias);
  }
  return root(senses_.force_weber, floor,
              quantity_ == Quantity::kViscosity ? senses_.speed_weber : 0.0);
}

psychometric::PsychometricParameters LevelObserver::discrimination(double reference) const {
  // The decision's own noise acts on the percept, whose log changes less than that of the level.
  const bool spring = quantity_ == Quantity::kStiffness || quantity_ == Quantity::kCompliance;
  const double share =
      spring && !(exploration_.depth > 0.0) ? 1.0 - senses_.displacement_bias : 1.0;
  const double sigma = std::numbers::sqrt2 * std::hypot(weber(reference), judgement_.noise / share);
  psychometric::PsychometricParameters p;
  p.sigmoid = psychometric::Sigmoid::kGaussian;
  p.axis = {psychometric::Scale::kLog10, 0.0};
  p.threshold = reference;
  p.width = psychometric::width_of_rate(p.sigmoid, std::numbers::ln10 / sigma);
  p.guess = 0.5 * judgement_.lapse;
  p.lapse = 0.5 * judgement_.lapse;
  return p;
}

}  // namespace haptrial::subject
