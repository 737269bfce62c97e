#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

namespace haptrial::psychometric {

/// Standard forms F(z), each rising from 0 to 1.
enum class Sigmoid {
  kLogistic,        // 1 / (1 + exp(-z))
  kGaussian,        // cumulative Gaussian
  kGumbel,          // 1 - exp(-exp(z)); on a logarithmic axis the Weibull function
  kReversedGumbel,  // exp(-exp(-z))
  kCauchy           // 1/2 + atan(z) / pi; Student's t with one degree of freedom, heavy tails
};

double sigmoid(Sigmoid kind, double z) noexcept;          // F(z)
double sigmoid_above(Sigmoid kind, double z) noexcept;    // 1 - F(z), without cancellation
double sigmoid_density(Sigmoid kind, double z) noexcept;  // dF/dz

/// z of F(z) = p. @throws std::invalid_argument unless 0 < p < 1
double sigmoid_quantile(Sigmoid kind, double p);

/// A sigmoid at one place, as fits need it.
struct SigmoidPoint {
  double share{0.0};    // F
  double beyond{0.0};   // 1 - F, without cancellation
  double density{0.0};  // dF/dz
  double bend{0.0};     // d2F/dz2
};
SigmoidPoint sigmoid_point(Sigmoid kind, double z) noexcept;

/// The same for eight places at once.
struct SigmoidLanes {
  static constexpr std::size_t kCount = 8;
  double share[kCount];
  double beyond[kCount];
  double density[kCount];
  double bend[kCount];
};
/// Values of a sigmoid at z[0] to z[7]; the smaller of share and beyond is right to 1e-11 of
/// itself.
void sigmoid_lanes(Sigmoid kind, const double* z, SigmoidLanes& lanes) noexcept;

/// Form of a psychometric function that a name stands for.
struct SigmoidForm {
  Sigmoid sigmoid{Sigmoid::kLogistic};
  bool logarithmic{false};  // acts on the logarithm of the level: weibull, logn
  bool falling{false};      // 1 - F
};

/// A name that psignifit 4 (Schütt et al. 2016) or QUEST+ (Watson 2017) gives to a sigmoid.
struct SigmoidName {
  std::string_view name;  // in small letters
  SigmoidForm form;
};

std::span<const SigmoidName> sigmoid_names();

/// The form by its name; capital and small letters are the same, and "neg_" before a name makes the
/// function fall.
/// @throws std::invalid_argument with the names that are allowed
SigmoidForm sigmoid_named(std::string_view name);

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
