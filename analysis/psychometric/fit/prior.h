#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace haptrial::analysis {

/// The five parameters as dimensions of a grid.
enum Dimension : std::size_t { kThreshold, kWidth, kLapse, kGuess, kEta };
inline constexpr std::size_t kDimensions = 5;

/// Levels that could be presented, on the axis of the function.
struct StimulusRange {
  double low{0.0};
  double high{1.0};     // > low
  double spacing{0.1};  // smallest distance of two levels, > 0
};

/// Fall from 1 at 0 down to 0 at 1, as a cosine; 1 below and 0 above.
double cosine_fall(double part) noexcept;

/// The range of the finite levels. @throws std::invalid_argument when there are not two of them.
StimulusRange stimulus_range(std::span<const double> coordinates);

/// Densities of the priors, with s = high - low and d = spacing:
///
///     threshold   1 between low and high, cosine down to 0 at s / 2 beyond
///     width       0 at d, cosine up to 1 at 2 d, 1 until s, cosine down to 0 at 3 s
///     lapse       Beta(1, b), on [0, 1/2]; guess likewise
///     eta         Beta(1, b)
///
/// each divided by its integral. For a width of other tails than 0.05, d and s of the width are
/// scaled so that the prior of the slope stays.
/// Source: Schuett, Harmeling, Macke and Wichmann 2016, Vision Research 122, part 2.3.
class PsychometricPrior {
 public:
  /// @param width_scale  width of this definition / width with tails of 0.05.
  /// @param beta         b >= 1. @throws std::invalid_argument naming it.
  PsychometricPrior(const StimulusRange& range, double width_scale, double beta);

  /// Range in which the density can be above 0.
  struct Border {
    double low{0.0};
    double high{1.0};
  };
  Border border(Dimension dimension) const noexcept { return borders_[dimension]; }
  double density(Dimension dimension, double value) const noexcept;

 private:
  double threshold(double value) const noexcept;
  double width(double value) const noexcept;
  double rate(double value, const Border& border) const noexcept;

  StimulusRange range_;
  double smallest_width_, largest_width_;
  double beta_;
  std::array<Border, kDimensions> borders_;
};

}  // namespace haptrial::analysis
