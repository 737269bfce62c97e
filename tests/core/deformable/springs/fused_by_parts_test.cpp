#include "core/deformable/springs/fused_by_parts.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/base/random.h"

namespace haptrial::deformable {
namespace {

/// Numbers whose last bits are often 0, so that products are often exact or half way between two.
double number(RandomStream& random, int exponents) {
  const auto kept = static_cast<int>(random.uniform(1, 54));
  const double whole = std::floor(std::ldexp(random.uniform(1, 2), kept));
  const double size = std::ldexp(whole, static_cast<int>(random.uniform(-exponents, exponents)));
  return random.uniform(0, 1) < 0.5 ? -size : size;
}

/// Addend of a product: anything, one that cancels it to its last bits, or far smaller parts.
double addend(RandomStream& random, double product) {
  switch (static_cast<int>(random.uniform(0, 4))) {
    case 0:
      return number(random, 80);
    case 1:
      return -product;
    case 2:
      return -product * (1 + std::ldexp(std::floor(random.uniform(-50, 50)), -52));
    default:
      return std::ldexp(number(random, 2) * product, static_cast<int>(random.uniform(-110, 10)));
  }
}

TEST(FusedByPartsTest, IsWhatOneRoundingGives) {
  RandomStream random(1, "fused");
  int other_than_two_roundings = 0;
  for (int i = 0; i < 2'000'000; ++i) {
    const double a = number(random, 40), b = number(random, 40);
    const double c = addend(random, a * b);
    const TwoLanes found = fused_by_parts(TwoLanes{a, 1}, TwoLanes{b, a}, TwoLanes{c, b});
    ASSERT_EQ(std::bit_cast<std::uint64_t>(found[0]),
              std::bit_cast<std::uint64_t>(std::fma(a, b, c)))
        << a << " * " << b << " + " << c;
    ASSERT_EQ(found[1], std::fma(1.0, a, b));
    other_than_two_roundings += found[0] != a * b + c ? 1 : 0;
  }
  EXPECT_GT(other_than_two_roundings, 200'000);
}

}  // namespace
}  // namespace haptrial::deformable
