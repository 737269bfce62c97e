#pragma once

#include <array>

#include "core/base/random.h"
#include "core/subject/force_memory.h"
#include "core/subject/subject_parameters.h"

namespace haptrial::subject {

/// A person's scale from bar height to newtons: a belief about the logarithm of the scale, 0 if it
/// is right. Only force felt while a bar is seen calibrates it.
class BarCalibration {
 public:
  BarCalibration(const SubjectParameters& person, RandomStream& random) noexcept;
  double gain() const noexcept;  // believed newtons per true newton of the bar
  double variance() const noexcept { return variance_; }
  /// @param observed  log of felt over seen; @param spread  standard deviation of it
  void calibrate(double observed, double spread) noexcept;
  /// A block later, `share` of what was calibrated is gone.
  void relax(double share) noexcept;

 private:
  double first_belief_;
  double first_variance_;
  double belief_;
  double variance_;
};

/// One exposure to a force pattern, gathered tick by tick and turned into a profile at its end.
///
/// Each sense c that took part gives an estimate z_c with variance sigma_c^2; they combine by
/// maximum likelihood (Ernst and Banks 2002): z = sum(z_c / sigma_c^2) / sum(1 / sigma_c^2).
class Exposure {
 public:
  void clear() noexcept;
  /// @param progress  0 to 1
  void see(double progress, double target_height) noexcept;  // bar heights in newtons of its scale
  /// @param mismatch  target bar minus applied bar where both are seen, else 0 [N of the scale]
  void feel(double progress, double force, double mismatch) noexcept;

  bool empty() const noexcept;
  /// @param correlation  of encoding errors, as a fraction of the pass > 0
  ForceProfile perceived(const SubjectParameters& person, BarCalibration& bar, double correlation,
                         RandomStream& random) noexcept;

 private:
  struct Bin {
    double sum{0.0};
    double extra{0.0};
    int count{0};
  };
  using Bins = std::array<Bin, ForceProfile::kKnots>;
  Bins seen_;
  Bins felt_;
  int seen_ticks_{0};
  int felt_ticks_{0};
};

}  // namespace haptrial::subject
