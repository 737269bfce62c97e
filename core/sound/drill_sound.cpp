#include "core/sound/drill_sound.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"

namespace haptrial::sound {
namespace {

SpectrumTable checked(SpectrumTable table) {
  check(table);
  return table;
}

double part(double x) { return x >= 0.0 ? std::min(x, 1.0) : 0.0; }  // 0 for what is no number

}  // namespace

double pitch(const ThinBone& thin, const DrillState& drill) noexcept {
  if (!drill.contact || !(drill.thickness < thin.threshold)) {
    return 1.0;
  }
  return 1.0 + thin.rise * (1.0 - std::max(0.0, drill.thickness) / thin.threshold);
}

const Schema<ThinBone>& thin_bone_schema() {
  static const auto schema =
      Schema<ThinBone>()
          .number("thin_threshold", &ThinBone::threshold, {0.0, 0.1, true}, "m",
                  "Thickness of bone below which the drill sounds higher")
          .required()
          .tunable()
          .number("thin_rise", &ThinBone::rise, {0.0, 10.0}, "",
                  "Rise of the drill's pitch, as a share, where no bone is left")
          .required()
          .tunable();
  return schema;
}

DrillSound::DrillSound(SpectrumTable table, const ThinBone& thin, std::uint64_t seed)
    : table_(checked(std::move(table))),
      thin_(thin),
      harmonics_(kRate, RandomStream(seed, "drill sound")) {
  if (!(thin.threshold > 0.0 && thin.rise >= 0.0 && std::isfinite(thin.rise))) {
    throw std::invalid_argument(
        "DrillSound: the threshold must be above 0 m, the rise not below 0");
  }
}

void DrillSound::set(const DrillState& drill) noexcept {
  const double speed = part(drill.speed);
  harmonics_.aim(table_.at(drill.burr, drill.contact, drill.force),
                 speed * pitch(drill.thin.value_or(thin_), drill), speed);
}

float DrillSound::next() noexcept {
  return static_cast<float>(std::clamp(harmonics_.next(), -1.0, 1.0));
}

DrillVibration::DrillVibration(SpectrumTable table, double gain, double rate, std::uint64_t seed)
    : table_(checked(std::move(table))),
      gain_(gain),
      harmonics_(rate, RandomStream(seed, "drill vibration")) {
  if (!(gain >= 0.0 && std::isfinite(gain))) {
    throw std::invalid_argument("DrillVibration: the gain must not be below 0");
  }
}

Eigen::Vector3d DrillVibration::tick(const DrillState& drill, const ToolState& tool) noexcept {
  const double speed = part(drill.speed);
  harmonics_.aim(table_.at(drill.burr, drill.contact, drill.force), speed, speed * gain_);
  const Eigen::Vector3d force = harmonics_.next() * (tool.orientation * Eigen::Vector3d::UnitX());
  return force.allFinite() ? force : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

namespace {

/// Adds to the error the alternative of a drilling session.
[[noreturn]] void offer_file(const RunError& error) {
  throw RunError(std::string(error.what()) +
                 "; the session's sound can be written to a WAV file instead");
}

}  // namespace

SoundOutput::SoundOutput(SpectrumTable table, const ThinBone& thin, std::uint64_t seed,
                         const std::string& device, Mix mix) try
    : sound_(std::move(table), thin, seed),
      mix_(std::move(mix)),
      player_(device, [this](std::span<float> part) { fill(part); }) {
} catch (const RunError& error) {
  offer_file(error);
}

void SoundOutput::fill(std::span<float> part) noexcept {
  if (latest_.read(drill_)) {
    sound_.set(drill_);
  }
  for (float& sample : part) {
    sample = sound_.next();
  }
  if (mix_) {
    mix_(part);
  }
}

}  // namespace haptrial::sound
