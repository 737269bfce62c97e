#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "core/base/random.h"

namespace haptrial::analysis {

/// How often to resample, and from which random numbers.
struct Resampling {
  std::uint64_t seed{1};  // of the study
  std::string stream;     // name of the stream: what is resampled
  std::size_t count{9999};
  int threads{1};
};

/// Calls draw(random, first, last) for consecutive parts of 0 .. count. Each part has a random
/// stream of its own, so that the result does not depend on the number of threads; several parts
/// run at once. Rethrows what a part threw.
void for_each_part(
    const Resampling& resampling,
    const std::function<void(RandomStream& random, std::size_t first, std::size_t last)>& draw);

}  // namespace haptrial::analysis
