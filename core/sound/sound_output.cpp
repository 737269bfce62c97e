#include "core/sound/sound_output.h"

#include <span>
#include <utility>

#include "core/base/error.h"

namespace haptrial::sound {
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
