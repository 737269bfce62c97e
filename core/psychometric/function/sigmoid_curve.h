#pragma once

#include <cmath>

#include "core/psychometric/function/sigmoid.h"

namespace haptrial::psychometric {

/// S(x), a sigmoid with a threshold m and a width w, free of guesses and lapses:
///
///     S(x) = F(z), falling: 1 - F(z)     z = q + C (x - m) / w
///     q = F^-1(share), falling: F^-1(1 - share)     C = F^-1(1 - tail) - F^-1(tail)
///
/// so that S(m) = share, rising or falling. What does not depend on m and w is computed once.
/// Source: Schütt, Harmeling, Macke, Wichmann 2016, Vision Research 122, eq. 2 and appendix A.
class SigmoidCurve {
 public:
  /// @throws std::invalid_argument naming share or tail if it breaks its bound.
  SigmoidCurve(Sigmoid sigmoid, double share, double tail, bool falling);

  double centre() const noexcept { return centre_; }  // q
  double spread() const noexcept { return spread_; }  // C
  bool falling() const noexcept { return falling_; }

  /// S and its derivatives by z.
  SigmoidPoint at(double z) const noexcept;
  void at(const double* z, SigmoidLanes& lanes) const noexcept;
  /// The same at x, derivatives by z; S = 0 at -infinity, where nothing is presented.
  SigmoidPoint at(double x, double threshold, double width) const noexcept {
    return std::isinf(x) ? SigmoidPoint{0.0, 1.0, 0.0, 0.0}
                         : at(centre_ + spread_ * (x - threshold) / width);
  }
  /// z of S(z) = share. @throws std::invalid_argument unless 0 < share < 1
  double z_for(double share) const;

 private:
  Sigmoid sigmoid_;
  bool falling_;
  double centre_;
  double spread_;
};

}  // namespace haptrial::psychometric
