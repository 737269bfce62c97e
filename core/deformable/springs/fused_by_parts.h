#pragma once

// a b + c rounded once, for processors that have no instruction for it (x86-64 before 2013).
namespace haptrial::deformable {

typedef double TwoLanes __attribute__((vector_size(16)));
typedef long long TwoFlags __attribute__((vector_size(16)));  // -1 or 0

/// A number and what was rounded off it.
struct Exact {
  TwoLanes rounded, rest;
};

inline Exact exact_sum(const TwoLanes& a, const TwoLanes& b) {
  const TwoLanes sum = a + b;
  const TwoLanes part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

inline Exact halves(const TwoLanes& a) {
  const TwoLanes scaled = 134217729.0 * a;  // 2^27 + 1
  const TwoLanes high = scaled - (scaled - a);
  return {high, a - high};
}

inline Exact exact_product(const TwoLanes& a, const TwoLanes& b) {
  const TwoLanes product = a * b;
  const Exact x = halves(a), y = halves(b);
  return {product, ((x.rounded * y.rounded - product) + x.rounded * y.rest + x.rest * y.rounded) +
                       x.rest * y.rest};
}

/// a + b, rounded to the neighbour with an odd last bit unless it is exact, so that rounding once
/// more is as if it were the first time.
inline TwoLanes odd_sum(const TwoLanes& a, const TwoLanes& b) {
  const Exact sum = exact_sum(a, b);
  const TwoFlags bits = (TwoFlags)sum.rounded;
  const TwoFlags inexact_even = (sum.rest != TwoLanes{}) & ((bits & 1) == TwoFlags{});
  const TwoFlags away = (sum.rest > TwoLanes{}) == (sum.rounded > TwoLanes{});  // -1: from zero
  return (TwoLanes)(bits + (inexact_even & ((away & 2) - 1)));
}

/// Boldo and Melquiond 2008, Emulation of FMA and correctly rounded sums. The same bits as
/// std::fma() where no part overflows or falls below the normal numbers.
inline TwoLanes fused_by_parts(const TwoLanes& a, const TwoLanes& b, const TwoLanes& c) {
  const Exact product = exact_product(a, b);
  const Exact low = exact_sum(c, product.rest);
  const Exact high = exact_sum(product.rounded, low.rounded);
  return high.rounded + odd_sum(high.rest, low.rest);
}

}  // namespace haptrial::deformable
