#include "core/subject/virtual_subject.h"
#include "tests/core/subject/noiseless_subject.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace haptrial::subject::virtual_subject_test {
namespace {

using stimulus::Instruction;
using stimulus::Presentation;

constexpr double kStep = 1e-3;
constexpr double kDuration = 8.0;

/// Records what the subject asks of its hand.
class ListeningHand final : public HandModel {
 public:
  void command(const HandCommand& command) noexcept override { last = command; }
  PointState step(const Eigen::Vector3d&, double) noexcept override { return {}; }
  PointState state() const noexcept override { return {}; }
  HandCommand last;
};

double pattern(double t) { return 5.0 - 4.0 * std::cos(2.0 * M_PI * 0.25 * t); }

class VirtualSubjectTest : public testing::Test {
 protected:
  VirtualSubject subject(const SubjectParameters& person, std::uint64_t seed = 1) {
    return VirtualSubject(person, HandParameters{}, hand_, seed, kStep);
  }
  /// Presents one pass and returns the motor command over it.
  std::vector<double> present(VirtualSubject& s, Instruction instruction, int block = 1) {
    std::vector<double> press;
    const int ticks = static_cast<int>(kDuration / kStep);
    for (int i = 0; i <= ticks + 10; ++i) {
      const double t = i * kStep;
      Presentation seen;
      seen.show_trajectory = true;
      seen.block = block;
      seen.pass_duration = kDuration;
      seen.progress = std::min(1.0, t / kDuration);
      seen.instruction = instruction;
      const bool shown = instruction == Instruction::kWatch || instruction == Instruction::kMatch;
      seen.target_force = pattern(t);
      seen.applied_force = pattern(t);
      seen.show_target_bar = shown;
      seen.show_applied_bar = instruction == Instruction::kMatch;
      const bool felt =
          instruction == Instruction::kHoldPlane || instruction == Instruction::kMatch;
      s.observe(seen, Eigen::Vector3d(0.0, felt ? pattern(t) : 0.0, 0.0), kStep);
      press.push_back(hand_.last.press);
    }
    return press;
  }
  double recall_error(VirtualSubject& s, int block = 1) {
    const auto press = present(s, Instruction::kRecall, block);
    const double lag = HandParameters{}.excitation_time + HandParameters{}.activation_time;
    double squares = 0.0;
    int count = 0;
    for (std::size_t i = 500; i + 500 < press.size(); ++i, ++count) {
      squares += std::pow(press[i] - pattern(static_cast<double>(i) * kStep + lag), 2);
    }
    return std::sqrt(squares / count);
  }
  ListeningHand hand_;
};

TEST_F(VirtualSubjectTest, DoesNothingBeforeItHasLearnt) {
  VirtualSubject s = subject(noiseless_subject());
  for (const double press : present(s, Instruction::kRecall)) {
    EXPECT_EQ(press, 0.0);
  }
}

TEST_F(VirtualSubjectTest, RecallsWithoutErrorWhatItLearntWithoutNoise) {
  for (const Instruction way :
       {Instruction::kHoldPlane, Instruction::kWatch, Instruction::kMatch}) {
    VirtualSubject s = subject(noiseless_subject());
    present(s, way);
    EXPECT_LT(recall_error(s), 0.05);
  }
}

TEST_F(VirtualSubjectTest, AnotherBlockIsAnotherPattern) {
  VirtualSubject s = subject(noiseless_subject());
  present(s, Instruction::kWatch, 1);
  for (const double press : present(s, Instruction::kRecall, 2)) {
    EXPECT_EQ(press, 0.0);
  }
}

TEST_F(VirtualSubjectTest, WatchingAsksNothingOfTheHand) {
  VirtualSubject s = subject(noiseless_subject());
  for (const double press : present(s, Instruction::kWatch)) {
    EXPECT_EQ(press, 0.0);
  }
}

TEST_F(VirtualSubjectTest, OpposesWhatItFeltADelayAgo) {
  SubjectParameters person = noiseless_subject();
  person.haptic_delay = 0.15;
  VirtualSubject s = subject(person);
  const auto press = present(s, Instruction::kHoldPlane);
  for (std::size_t i = 1000; i < 7000; i += 500) {
    EXPECT_NEAR(press[i], pattern(static_cast<double>(i) * kStep - 0.15), 0.01);
  }
  EXPECT_TRUE(hand_.last.holds_posture == false) << "after the pass";
}

TEST_F(VirtualSubjectTest, RepetitionsReduceTheErrorOfANoisyMemory) {
  SubjectParameters person = noiseless_subject();
  person.haptic_memory_noise = 1.5;
  double first = 0.0;
  double third = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    VirtualSubject s = subject(person, seed);
    present(s, Instruction::kHoldPlane);
    first += recall_error(s) / 40;
    present(s, Instruction::kHoldPlane);
    present(s, Instruction::kHoldPlane);
    third += recall_error(s) / 40;
  }
  EXPECT_NEAR(third / first, 1.0 / std::sqrt(3.0), 0.1);
}

TEST_F(VirtualSubjectTest, EasesOffWhereTheDeviceSaturates) {
  VirtualSubject s = subject(noiseless_subject());
  Presentation seen;
  seen.show_trajectory = true;
  seen.block = 1;
  seen.pass_duration = kDuration;
  seen.instruction = Instruction::kHoldPlane;
  double before = 0.0;
  for (int i = 1; i < 4000; ++i) {
    seen.progress = i * kStep / kDuration;
    seen.show_saturation = i > 2000 && i < 2500;
    s.observe(seen, Eigen::Vector3d(0.0, 10.0, 0.0), kStep);
    before = i == 2000 ? hand_.last.press : before;
    if (i == 2400) {
      EXPECT_LT(hand_.last.press, 0.2 * before);
    }
  }
  EXPECT_GT(hand_.last.press, 0.99 * before) << "and trusts again";
}

TEST_F(VirtualSubjectTest, RestsInTheMiddleWhenNobodyGuides) {
  VirtualSubject s = subject(noiseless_subject());
  Presentation seen;
  seen.tool = {0.02, -0.01, 0.03};
  s.observe(seen, Eigen::Vector3d(Eigen::Vector3d::Zero()), kStep);
  EXPECT_LT(hand_.last.force.dot(seen.tool), 0.0);
}

TEST_F(VirtualSubjectTest, SameSeedSameBehaviour) {
  const SubjectParameters person;
  VirtualSubject a = subject(person, 5);
  VirtualSubject b = subject(person, 5);
  VirtualSubject c = subject(person, 6);
  const auto x = present(a, Instruction::kHoldPlane);
  EXPECT_EQ(x, present(b, Instruction::kHoldPlane));
  EXPECT_NE(x, present(c, Instruction::kHoldPlane));
}

TEST_F(VirtualSubjectTest, ObserveDoesNotAllocate) {
  VirtualSubject s = subject(SubjectParameters{});
  Presentation seen;
  seen.show_trajectory = true;
  seen.show_target_bar = true;
  seen.pass_duration = 1.0;
  const test::AllocationGuard guard;
  for (const Instruction way :
       {Instruction::kHoldPlane, Instruction::kWatch, Instruction::kMatch, Instruction::kRecall}) {
    seen.instruction = way;
    ++seen.block;
    for (int i = 0; i <= 1000; ++i) {
      seen.progress = i * 1e-3;
      s.observe(seen, Eigen::Vector3d(0.0, 3.0, 0.0), kStep);
    }
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::subject::virtual_subject_test
