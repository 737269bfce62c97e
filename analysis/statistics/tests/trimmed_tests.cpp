#include "analysis/statistics/tests/trimmed_tests.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

constexpr const char* kFewLeft = "trimming leaves fewer than two values";

/// A sample with its tails pulled in to the last values that are kept.
struct Winsorized {
  std::vector<double> values;  // as many and in the order of the sample
  double kept{0.0};            // number of values that trimming leaves
  double trimmed_mean{0.0};
};

Winsorized winsorized(std::span<const double> sample, double share) {
  std::vector<double> sorted(sample.begin(), sample.end());
  std::ranges::sort(sorted);
  const auto cut = static_cast<std::size_t>(share * static_cast<double>(sample.size()));
  const std::size_t kept = sample.size() - 2 * cut;
  Winsorized made{{sample.begin(), sample.end()}, static_cast<double>(kept), 0.0};
  const std::span<const double> middle(sorted.data() + cut, kept);
  const double low = middle.front(), high = middle.back();
  for (double& value : made.values) {
    value = std::clamp(value, low, high);
  }
  for (const double value : middle) {
    made.trimmed_mean += (value - low) / made.kept;
  }
  made.trimmed_mean += low;
  return made;
}

/// Sum of products of deviations from the means.
double products(const std::vector<double>& a, const Moments& of_a, const std::vector<double>& b,
                const Moments& of_b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - of_a.origin - of_a.offset) * (b[i] - of_b.origin - of_b.offset);
  }
  return sum;
}

}  // namespace

Defined<TTest> yuen_test(std::span<const double> a, std::span<const double> b, double share,
                         Tail tail, double level) {
  if (const auto ma = moments(a), mb = moments(b); !ma || !mb) {
    return Undefined{!ma ? ma.because() : mb.because()};
  }
  const Winsorized wa = winsorized(a, share), wb = winsorized(b, share);
  if (wa.kept < 2.0 || wb.kept < 2.0) {
    return Undefined{kFewLeft};
  }
  const double va = moments(wa.values)->squares / (wa.kept * (wa.kept - 1.0));
  const double vb = moments(wb.values)->squares / (wb.kept * (wb.kept - 1.0));
  if (va + vb == 0.0) {
    return Undefined{"the values that trimming leaves do not vary within either sample"};
  }
  const double df = (va + vb) * (va + vb) / (va * va / (wa.kept - 1.0) + vb * vb / (wb.kept - 1.0));
  return t_test_of(wa.trimmed_mean - wb.trimmed_mean, std::sqrt(va + vb), df, tail, level);
}

Defined<TTest> paired_yuen_test(std::span<const double> a, std::span<const double> b, double share,
                                Tail tail, double level) {
  if (a.size() != b.size()) {
    throw std::invalid_argument("paired_yuen_test: the samples differ in length");
  }
  if (const auto ma = moments(a), mb = moments(b); !ma || !mb) {
    return Undefined{!ma ? ma.because() : mb.because()};
  }
  const Winsorized wa = winsorized(a, share), wb = winsorized(b, share);
  if (wa.kept < 2.0) {
    return Undefined{kFewLeft};
  }
  const Moments ma = *moments(wa.values), mb = *moments(wb.values);
  const double squares = ma.squares + mb.squares - 2.0 * products(wa.values, ma, wb.values, mb);
  if (!(squares > 1e-14 * (ma.squares + mb.squares))) {
    return Undefined{"the differences that trimming leaves do not vary"};
  }
  return t_test_of(wa.trimmed_mean - wb.trimmed_mean,
                   std::sqrt(squares / (wa.kept * (wa.kept - 1.0))), wa.kept - 1.0, tail, level);
}

}  // namespace haptrial::analysis
