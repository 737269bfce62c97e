#include "core/deformable/elements/material.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/message_of.h"

namespace haptrial::deformable {
namespace {

std::string refusal(const Material& material) {
  return test::message_of([&] { check_material(material, "material 0"); });
}

TEST(MaterialTest, ModuliAreThoseOfTheHandbook) {
  const Moduli steel = moduli({210e9, 0.3, 7850});
  EXPECT_NEAR(steel.shear, 80.769230769e9, 1);
  EXPECT_NEAR(steel.bulk, 175e9, 1e-3);
}

TEST(MaterialTest, WhatCannotBeIsRefused) {
  EXPECT_EQ(refusal({0, 0.3, 1000}), "material 0: Young's modulus is 0 Pa; allowed: above 0");
  EXPECT_EQ(refusal({-1, 0.3, 1000}), "material 0: Young's modulus is -1 Pa; allowed: above 0");
  EXPECT_EQ(refusal({1e4, 0.5, 1000}),
            "material 0: Poisson's ratio is 0.5; allowed: above -1 and below 0.5");
  EXPECT_EQ(refusal({1e4, -1, 1000}),
            "material 0: Poisson's ratio is -1; allowed: above -1 and below 0.5");
  EXPECT_EQ(refusal({1e4, std::numeric_limits<double>::quiet_NaN(), 1000}),
            "material 0: Poisson's ratio is nan; allowed: above -1 and below 0.5");
  EXPECT_EQ(refusal({1e4, 0.3, 0}), "material 0: the density is 0 kg/m³; allowed: above 0");
  EXPECT_EQ(refusal({1e4, 0.499, 980}), "nothing was thrown");
}

TEST(MaterialTest, LawsHaveNames) {
  for (const Law law : {Law::kLinear, Law::kCorotational, Law::kNeoHookean}) {
    EXPECT_EQ(law_named(name_of(law)), law);
  }
  EXPECT_EQ(test::message_of([] { law_named("ogden"); }),
            "the law is 'ogden'; allowed: linear, corotational, neo-hookean");
}

}  // namespace
}  // namespace haptrial::deformable
