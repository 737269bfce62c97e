#pragma once

#include <complex>
#include <numbers>
#include <vector>

namespace haptrial::test {

/// Amplitudes of `signal` at whole hertz up to half the rate, of one second under a Hann window.
inline std::vector<double> spectrum(const std::vector<double>& signal) {
  const std::size_t n = signal.size();
  std::vector<double> amplitude(n / 2);
  for (std::size_t k = 0; k < n / 2; ++k) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < n; ++i) {
      const double turn =
          2.0 * std::numbers::pi * static_cast<double>(k * i % n) / static_cast<double>(n);
      const double window =
          1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
      sum += window * signal[i] * std::polar(1.0, -turn);
    }
    amplitude[k] = 2.0 * std::abs(sum) / static_cast<double>(n);
  }
  return amplitude;
}

}  // namespace haptrial::test
