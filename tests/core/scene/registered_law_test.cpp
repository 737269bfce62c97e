#include "core/scene/registered_law.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>

#include "core/scene/needed_damping.h"

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

/// Numbers that state how steep their force is, and claim that other fields may lie on it.
class Steep final : public RegisteredNumbers {
 public:
  std::unique_ptr<RegisteredLaw> law(const Setting&) const override { return nullptr; }
  StiffnessBound bound() const override { return {true, 700.0, 3.0}; }
  FieldTraits traits() const override { return {.surface = true, .yields = true}; }
};

TEST(RegisteredLawTest, StatesItsSteepnessButIsNoSurface) {
  Field own;
  own.kind = RegisteredParameters{"steep", std::make_shared<Steep>()};
  const StiffnessBound bound = stiffness_bound({own}, 0);
  EXPECT_TRUE(bound.passive);
  EXPECT_EQ(bound.stiffness, 700.0);
  EXPECT_EQ(bound.damping, 3.0);
  EXPECT_TRUE(traits_of(own).yields);
  EXPECT_FALSE(traits_of(own).surface);
  own.kind = RegisteredParameters{"count", std::make_shared<CountingNumbers>()};
  EXPECT_FALSE(stiffness_bound({own}, 0).passive) << "nothing is known of it";
  EXPECT_FALSE(traits_of(own).yields);
}

TEST(RegisteredLawTest, WithoutNumbersOrALawIsRefused) {
  EXPECT_THROW(RegisteredField({"none", nullptr}, {}), std::invalid_argument);
  EXPECT_THROW(RegisteredField({"none", std::make_shared<NoLaw>()}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::scene
