#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace haptrial::psychometric {

/// How often, and in which order, a list of levels is presented.
struct ListParameters {
  std::vector<double> levels;  // finite, at least one [unit of the level]
  int repetitions{1};          // of each level, 1 to 100,000
  bool in_rounds{false};       // every level once before any comes again; else all are shuffled
};

/// The levels in their order: Fisher and Yates with the random stream of `seed` and `name`.
/// @throws std::invalid_argument "WHO: ..." naming the parameter that breaks its bound.
std::vector<double> shuffled(const ListParameters& list, std::uint64_t seed, std::string_view name,
                             const char* who);

}  // namespace haptrial::psychometric
