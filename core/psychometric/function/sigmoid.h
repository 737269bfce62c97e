#pragma once

#include <cstddef>

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

}  // namespace haptrial::psychometric
