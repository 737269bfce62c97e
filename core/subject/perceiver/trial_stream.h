#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/random.h"

namespace haptrial::subject {

/// The stream "NAME TRIAL" of a seed. A trial draws all of its noise from streams of its own, so
/// that a trial that is repeated or comes after a resumed session has the same noise.
/// @param name  of at most 40 characters; the rest is cut off
/// Servo thread: no allocation, lock, I/O or throw.
RandomStream trial_stream(std::uint64_t seed, std::string_view name, int trial) noexcept;

}  // namespace haptrial::subject
