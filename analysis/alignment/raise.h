#pragma once

// |x|^p for rows of x, written so that compilers put it into vector lanes. Included by the kernel
// files after their target pragma: the operations and their order are the same in each, and so are
// the bits.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace haptrial::analysis::kernel {
namespace {

struct Exponentiation {
  /// 2^y = 2^k 2^f, |f| <= 1/2, and 2^f by its series.
  [[gnu::always_inline]] static inline double exp2(double y) {
    constexpr double kToWhole =
        6755399441055744.0;  // 1.5 x 2^52: adding it rounds to whole numbers
    const double shifted = y + kToWhole;
    const double f = 0.6931471805599453 * (y - (shifted - kToWhole));
    const double f2 = f * f;  // even and odd terms apart: two short chains in place of a long one
    double even = 1.0 / 479001600.0, odd = 1.0 / 6227020800.0;
    even = even * f2 + 1.0 / 3628800.0;
    odd = odd * f2 + 1.0 / 39916800.0;
    even = even * f2 + 1.0 / 40320.0;
    odd = odd * f2 + 1.0 / 362880.0;
    even = even * f2 + 1.0 / 720.0;
    odd = odd * f2 + 1.0 / 5040.0;
    even = even * f2 + 1.0 / 24.0;
    odd = odd * f2 + 1.0 / 120.0;
    even = even * f2 + 0.5;
    odd = odd * f2 + 1.0 / 6.0;
    even = even * f2 + 1.0;
    odd = odd * f2 + 1.0;
    const double sum = even + odd * f;
    const std::uint64_t k = std::bit_cast<std::uint64_t>(shifted) << 52;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(sum) + k);
  }

  /// x = 2^k m with m from sqrt(1/2) to sqrt(2); log2 m = 2 artanh(s) / ln 2, s = (m-1)/(m+1).
  [[gnu::always_inline]] static inline double log2(double x) {
    constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcdu, kBias = std::uint64_t{1024} << 52;
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t k = (bits - kRootOfHalf + kBias) >> 52;  // + 1024
    const double m = std::bit_cast<double>(bits - (k << 52) + kBias);
    const double whole = std::bit_cast<double>(k | 0x4330000000000000u) - (0x1p52 + 1024.0);
    const double s = (m - 1.0) / (m + 1.0), z = s * s;
    const double z2 = z * z;
    double even = 1.0 / 21.0, odd = 1.0 / 19.0;
    even = even * z2 + 1.0 / 17.0;
    odd = odd * z2 + 1.0 / 15.0;
    even = even * z2 + 1.0 / 13.0;
    odd = odd * z2 + 1.0 / 11.0;
    even = even * z2 + 1.0 / 9.0;
    odd = odd * z2 + 1.0 / 7.0;
    even = even * z2 + 1.0 / 5.0;
    odd = odd * z2 + 1.0 / 3.0;
    even = even * z2 + 1.0;
    const double sum = even + odd * z;
    return whole + 2.8853900817779268 * s * sum;
  }
};

/// Powers below 2^-1000, that of 0 among them, become 0, by masks and not by branches.
void raise(double* values, std::size_t count, double power) {
  constexpr double kLeast = -1000.0, kNotZero = 0x1p-1000;
  for (std::size_t k = 0; k < count; ++k) {
    const double y = power * Exponentiation::log2(std::abs(values[k]) + kNotZero);
    const std::uint64_t is_below = std::bit_cast<std::uint64_t>(y - kLeast) >> 63;
    const std::uint64_t kept = is_below - 1;  // all bits or none
    const double clean = std::bit_cast<double>(std::bit_cast<std::uint64_t>(y) & kept);
    const double raised = Exponentiation::exp2(clean);
    values[k] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(raised) & kept);
  }
}

}  // namespace
}  // namespace haptrial::analysis::kernel
