#include "core/scene/registered_law.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace haptrial::scene {
namespace {

/// Counts its ticks, and at the third one gives what no force is.
class Counting final : public RegisteredLaw {
 public:
  Eigen::Vector3d force(const Felt&, FieldState& state) noexcept override {
    state.depth = ++ticks_;
    return {ticks_ == 3 ? std::numeric_limits<double>::quiet_NaN() : ticks_, 0.0, 0.0};
  }
  void adopt(const RegisteredLaw& before) noexcept override {
    ticks_ = static_cast<const Counting&>(before).ticks_;
  }

 private:
  double ticks_{0.0};
};

class CountingNumbers final : public RegisteredNumbers {
 public:
  std::unique_ptr<RegisteredLaw> law(const Setting&) const override {
    return std::make_unique<Counting>();
  }
};

class NoLaw final : public RegisteredNumbers {
 public:
  std::unique_ptr<RegisteredLaw> law(const Setting&) const override { return nullptr; }
};

RegisteredField counting(const char* type) {
  return {{type, std::make_shared<CountingNumbers>()}, {}};
}

TEST(RegisteredLawTest, AForceThatIsNotFiniteCountsAsZero) {
  RegisteredField own = counting("count");
  FieldState state;
  EXPECT_EQ(own.force({}, state).x(), 1.0);
  EXPECT_EQ(own.force({}, state).x(), 2.0);
  EXPECT_EQ(own.force({}, state), Eigen::Vector3d::Zero());
  EXPECT_EQ(own.force({}, state).x(), 4.0);
  EXPECT_EQ(state.depth, 4.0);
}

TEST(RegisteredLawTest, GoesOnOnlyWhereALawOfTheSameTypeStood) {
  FieldState state;
  RegisteredField before = counting("count");
  before.force({}, state);
  RegisteredField same = counting("count");
  same.adopt(before);
  EXPECT_EQ(same.force({}, state).x(), 2.0);
  RegisteredField other = counting("another");
  other.adopt(before);
  EXPECT_EQ(other.force({}, state).x(), 1.0);
}

TEST(RegisteredLawTest, WithoutNumbersOrALawIsRefused) {
  EXPECT_THROW(RegisteredField({"none", nullptr}, {}), std::invalid_argument);
  EXPECT_THROW(RegisteredField({"none", std::make_shared<NoLaw>()}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::scene
