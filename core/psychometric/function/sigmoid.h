#pragma once

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

/// A name that psignifit 4 (Schütt et al. 2016) or QUEST+ (Watson 2017) gives to a sigmoid; those
/// that are logarithmic act on the logarithm of the level: weibull, logn.
struct SigmoidName {
  std::string_view name;
  Sigmoid sigmoid;
  bool logarithmic;
};

std::span<const SigmoidName> sigmoid_names();

/// @throws std::invalid_argument with the names that are allowed
SigmoidName sigmoid_named(std::string_view name);

}  // namespace haptrial::psychometric
