#pragma once

#include <cstddef>
#include <string_view>

namespace haptrial::analysis {

/// The standard forms F(z), all rising from 0 to 1.
enum class SigmoidForm {
  kNormal,          // Phi(z)
  kLogistic,        // 1 / (1 + exp(-z))
  kGumbel,          // 1 - exp(-exp(z))
  kReversedGumbel,  // exp(-exp(-z))
  kStudent,         // 1/2 + atan(z) / pi: Student's t with one degree of freedom
};

/// Which sigmoid, and what its two parameters mean.
struct SigmoidShape {
  SigmoidForm form{SigmoidForm::kNormal};
  bool logarithmic{false};      // of the level's natural logarithm: Weibull, log-normal
  bool falling{false};          // 1 - F
  double threshold_share{0.5};  // S(threshold), inside (0, 1) [1]
  double width_tail{0.05};      // alpha, inside (0, 0.5) [1]
};

/// The shape by its usual name: norm, gauss, logistic, gumbel, rgumbel, tdist; of the logarithm:
/// logn, Weibull, rWeibull; falling: neg_ before any of these. Upper and lower case are one.
/// @throws std::invalid_argument naming `name`.
SigmoidShape sigmoid_named(std::string_view name);

/// F at one place with what fits need.
struct SigmoidPoint {
  double share{0.0};    // S
  double beyond{0.0};   // 1 - S, right also where S is close to 1
  double density{0.0};  // S' [1/z]
  double bend{0.0};     // S'' [1/z^2]
};

/// The same for eight places at once.
struct SigmoidLanes {
  static constexpr std::size_t kCount = 8;
  double share[kCount];
  double beyond[kCount];
  double density[kCount];
  double bend[kCount];
};

/// S(x; m, w): of shape F, with S(m) = threshold_share, and w the distance over which F goes from
/// alpha to 1 - alpha:
///
///     S(x) = F(q + C (x - m) / w),   F(q) = threshold_share,   C = F^-1(1 - alpha) - F^-1(alpha)
///
/// A falling one is 1 - F with the same S(m) and w. x is the level, or its natural logarithm.
/// Source: Schuett, Harmeling, Macke and Wichmann 2016, Vision Research 122, eq. 2 and appendix A.
/// Every function but the constructor is noexcept and free of allocation.
class Sigmoid {
 public:
  /// @throws std::invalid_argument naming the share that breaks its bound.
  explicit Sigmoid(const SigmoidShape& shape);

  const SigmoidShape& shape() const noexcept { return shape_; }
  double centre() const noexcept { return centre_; }  // q, in z
  double spread() const noexcept { return spread_; }  // C, in z
  /// x of a level; not finite where the logarithm does not exist.
  double coordinate(double level) const noexcept;
  double level(double coordinate) const noexcept;

  /// S with its derivatives by z.
  SigmoidPoint at(double z) const noexcept;
  /// The same at SigmoidLanes::kCount places; the smaller of share and beyond to 1e-11 of itself.
  void at(const double* z, SigmoidLanes& lanes) const noexcept;
  /// S(x); `beyond` gets 1 - S.
  double share(double x, double threshold, double width, double& beyond) const noexcept;
  /// The x with S(x) = share; share inside (0, 1).
  double inverse(double share, double threshold, double width) const noexcept;
  /// dS/dx.
  double slope(double x, double threshold, double width) const noexcept;

 private:
  SigmoidShape shape_;
  double centre_{0.0};
  double spread_{1.0};
};

}  // namespace haptrial::analysis
