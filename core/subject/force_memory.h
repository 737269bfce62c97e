#pragma once

#include <array>

#include "core/base/random.h"

namespace haptrial::subject {

/// A person's memory of a curve of forces: an estimate and its variance at each knot. Knots are
/// equally spaced over the pass.
struct ForceProfile {
  static constexpr int kKnots = 256;
  std::array<double, kKnots> force{};     // [N]
  std::array<double, kKnots> variance{};  // [N^2]
};

/// The remembered force pattern of the present block.
///
/// Each exposure is merged by the Kalman rule, m += K (z - m), K = s^2 / (s^2 + sigma^2), so that
/// repetitions refine it; between passes it drifts and its variance grows.
class ForceMemory {
 public:
  void clear() noexcept { known_ = false; }
  bool empty() const noexcept { return !known_; }
  void learn(const ForceProfile& exposure) noexcept;

  /// @param drift  standard deviation [N]
  /// @param correlation  over which the drift is alike, as a fraction of the pass > 0
  void drift(double drift, double correlation, RandomStream& random) noexcept;

  /// The force remembered at `progress` (0 to 1, held outside); 0 where nothing is remembered [N].
  double at(double progress) const noexcept;

 private:
  ForceProfile profile_;
  bool known_{false};
};

}  // namespace haptrial::subject
