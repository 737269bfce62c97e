#include "core/subject/perceiver/palpation.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace haptrial::subject {
namespace {

Palpate two_places() {
  Palpate palpate;
  palpate.places[0] = {0.01, 0.02, 0.0};
  palpate.places[1] = {-0.01, 0.02, 0.0};
  palpate.count = 2;
  palpate.move = 0.4;
  palpate.press = 0.8;
  return palpate;
}

TEST(PalpationTest, GoesToEachPlacePressesAndEnds) {
  const Palpate palpate = two_places();
  EXPECT_EQ(palpation_at(palpate, 0.0).place, 0u);
  EXPECT_DOUBLE_EQ(palpation_at(palpate, 0.2).moved, 0.5);
  EXPECT_FALSE(palpation_at(palpate, 0.39).pressing);
  EXPECT_TRUE(palpation_at(palpate, 0.41).pressing);
  EXPECT_NEAR(palpation_at(palpate, 0.6).pressed, 0.5, 1e-12) << "half of the rise";
  EXPECT_DOUBLE_EQ(palpation_at(palpate, 0.9).pressed, 1.0);
  EXPECT_NEAR(palpation_at(palpate, 1.1).pressed, 0.5, 1e-12) << "half of the fall";
  EXPECT_EQ(palpation_at(palpate, 1.3).place, 1u);
  EXPECT_FALSE(palpation_at(palpate, 1.3).pressing);
  EXPECT_TRUE(palpation_at(palpate, 2.5).over);
  EXPECT_EQ(palpation_at(palpate, 2.5).pressed, 0.0);
}

TEST(PalpationTest, BadParametersAreRefused) {
  Palpate none = two_places();
  none.count = 0;
  EXPECT_THROW(check(none), std::invalid_argument);
  Palpate many = two_places();
  many.count = Palpate::kMost + 1;
  EXPECT_THROW(check(many), std::invalid_argument);
  Palpate weak = two_places();
  weak.force = 0.0;
  EXPECT_THROW(check(weak), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::subject
