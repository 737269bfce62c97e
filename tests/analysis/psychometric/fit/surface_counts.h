#pragma once

#include <array>

#include "core/psychometric/procedure/quest_tables.h"

namespace haptrial::test {

/// Felt if the size of (x, gain y) is above a threshold; with a slope.
psychometric::QuestDefinition ellipse();

/// How often the 95 % intervals of functions of two variables hold the truth.
struct SurfaceCounts {
  int observers{0};
  std::array<int, 3> held{};      // threshold, gain, spread
  std::array<double, 3> error{};  // mean
  int contours{0};                // that end within the range where the first variable is 0
  int contours_held{0};
};

/// Virtual observers with an ellipse drawn from the prior answer 120 trials of QUEST+ each.
/// @param observers  numbers 0 .. observers - 1, each with its own random stream
SurfaceCounts count_surfaces(int observers, int threads);

}  // namespace haptrial::test
