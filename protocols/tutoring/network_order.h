#pragma once

#include <cstddef>
#include <cstdint>

namespace haptrial::protocols {

/// Which of several networks a trial goes over: every one once in each run of as many trials, in an
/// order that is drawn for it.
/// @param trial  from 0, practice included  @param count  > 0  @param seed  of the session
std::size_t network_of_trial(std::size_t trial, std::size_t count, std::uint64_t seed);

}  // namespace haptrial::protocols
