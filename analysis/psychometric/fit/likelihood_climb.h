#pragma once

#include <array>

#include "core/psychometric/function/sigmoid.h"

/// How the likelihood of a psychometric function changes with its parameters; for LikelihoodFitter.
namespace haptrial::analysis::climbing {

// Threshold, log width, lapse, guess.
inline constexpr int kPlaces = 4;
using Place = std::array<double, kPlaces>;
using Square = std::array<Place, kPlaces>;

/// Derivatives of the logarithm of the likelihood at a place, for Newton's method.
struct Climb {
  bool possible{true};  // the likelihood is not 0
  Place slope{};
  Square hessian{};  // of minus the logarithm; or Fisher's information
  bool fisher{false};
};

using psychometric::SigmoidCurve;
using psychometric::SigmoidLanes;

inline constexpr std::size_t kLanes = SigmoidLanes::kCount;
using Lanes = double[kLanes];

/// Eight blocks: the coordinate of the level, right and wrong answers; none beyond the last block.
struct Blocks {
  Lanes x, right, wrong;
};

/// A place at which the likelihood is looked at.
struct Spot {
  double threshold, rise, lapse, guess;
  bool tied;    // the guess rate is the lapse rate
  bool fisher;  // Fisher's information is asked for
};

/// Sums over the blocks of what makes a Climb, in terms of z - q = rise (x - threshold).
struct Sums {
  double density{0.0}, far{0.0}, lapse{0.0}, guess{0.0};  // slopes
  double bent{0.0}, bent_far{0.0}, bent_far_far{0.0};
  double lapse_near{0.0}, lapse_far{0.0}, guess_near{0.0}, guess_far{0.0};
  double lapse_lapse{0.0}, lapse_guess{0.0}, guess_guess{0.0};
  double impossible{0.0};

  template <bool Guess>
  void add(const SigmoidCurve& curve, const Blocks& blocks, const Spot& spot) noexcept;
  void put(Climb& climb, double rise) const noexcept;
};

}  // namespace haptrial::analysis::climbing
