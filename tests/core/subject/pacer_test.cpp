#include "core/subject/pacer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/subject/hand.h"
#include "core/subject/population.h"
#include "core/subject/virtual_subject.h"
#include "tests/core/subject/noiseless_subject.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::subject::pacer_test {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;

/// Moves a hand along a circle (radius 0: a line in x), held on it by a stiff spring, and returns
/// its speed along it at every tick.
std::vector<double> speeds(const PaceParameters& person, double radius, double seconds,
                           std::uint64_t seed = 1) {
  const HandParameters parameters;
  const Vector3d start(radius, 0.0, 0.0);
  Hand hand(parameters, kStep, start);
  Pacer pacer(person, parameters, RandomStream(seed, "pace"), kStep);
  pacer.begin();
  std::vector<double> result;
  for (double t = 0.0; t < seconds; t += kStep) {
    const PointState now = hand.state();
    Vector3d along = Vector3d::UnitX();
    Vector3d held = {0.0, -2000.0 * now.position.y(), -2000.0 * now.position.z()};
    if (radius > 0.0) {
      const Vector3d out = Vector3d(now.position.x(), 0.0, now.position.z()).normalized();
      along = {-out.z(), 0.0, out.x()};
      held = 2000.0 * (radius * out - now.position);
    }
    const double speed = now.velocity.dot(along);
    HandCommand command;
    command.force = pacer.drive(along, speed);
    hand.command(command);
    hand.step(held, kStep);
    result.push_back(speed);
  }
  return result;
}

double mean_after(const std::vector<double>& values, double seconds) {
  double sum = 0.0;
  const auto from = static_cast<std::size_t>(seconds / kStep);
  for (std::size_t i = from; i < values.size(); ++i) {
    sum += values[i];
  }
  return sum / static_cast<double>(values.size() - from);
}

TEST(PacerTest, MovesAtItsPaceWhereThePathBendsAsTheReference) {
  PaceParameters person;
  person.variability = 0.0;
  for (const double pace : {0.008, 0.016, 0.03}) {
    person.pace = pace;
    EXPECT_NEAR(mean_after(speeds(person, 0.01, 6.0), 3.0), pace, 0.02 * pace);
  }
}

TEST(PacerTest, FollowsTheTwoThirdsPowerLaw) {
  PaceParameters person;
  person.variability = 0.0;
  // Speed goes with the cube root of the radius.
  const double narrow = mean_after(speeds(person, 0.005, 6.0), 3.0);
  const double wide = mean_after(speeds(person, 0.04, 6.0), 3.0);
  EXPECT_NEAR(wide / narrow, 2.0, 0.06);
  EXPECT_NEAR(mean_after(speeds(person, 0.0, 6.0), 3.0), 2.0 * person.pace, 0.02 * person.pace)
      << "and is bounded on a straight line";
}

TEST(PacerTest, VariesWithinAPassAsItIsTold) {
  PaceParameters person;
  person.variability = 0.2;
  double mean = 0.0;
  double square = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto v = speeds(person, 0.01, 12.0, seed);
    for (std::size_t i = 3000; i < v.size(); i += 100, ++count) {
      mean += std::log(v[i]);
      square += std::log(v[i]) * std::log(v[i]);
    }
  }
  mean /= count;
  EXPECT_NEAR(std::sqrt(square / count - mean * mean), 0.2, 0.04);
  EXPECT_NE(speeds(person, 0.01, 2.0, 1), speeds(person, 0.01, 2.0, 2));
  EXPECT_EQ(speeds(person, 0.01, 2.0, 1), speeds(person, 0.01, 2.0, 1));
}

TEST(PacerTest, ADriveDoesNotAllocate) {
  Pacer pacer({}, {}, RandomStream(1, "pace"), kStep);
  const test::AllocationGuard guard;
  pacer.begin();
  for (int i = 0; i < 1000; ++i) {
    pacer.drive(Vector3d::UnitX(), 0.01);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(PaceSchemaTest, PeopleDifferAndAreReadWithTheirBounds) {
  const std::string text =
      "pace = { median = 0.02, spread = 0.2 }\nvariability = { median = 0.1, spread = 0.0 }\n"
      "correlation = { median = 1.0, spread = 0.0 }\n";
  Table table = Table::parse(text, "f.toml");
  const Population<PaceParameters> people = pace_schema().read(table);
  EXPECT_NO_THROW(table.finish());
  double sum = 0.0;
  double square = 0.0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const PaceParameters p = people.draw(seed);
    EXPECT_EQ(p.variability, 0.1);
    sum += std::log(p.pace / 0.02) / 2000;
    square += std::pow(std::log(p.pace / 0.02), 2) / 2000;
  }
  EXPECT_NEAR(sum, 0.0, 0.02);
  EXPECT_NEAR(std::sqrt(square), 0.2, 0.01);
  EXPECT_EQ(people.draw(7).pace, draw({0.02, 0.2}, 7, "pace"));
  Table varied = Table::parse(
      "pace = 0.02\nvariability = { median = 0.1, spread = 0.4 }\ncorrelation = 1.0\n", "f.toml");
  EXPECT_EQ(pace_schema().read(varied).draw(7).variability,
            draw({0.1, 0.4}, 7, "pace variability"));
  Table bad = Table::parse("pace = { median = 0.0, spread = 0.2 }\n", "f.toml");
  pace_schema().read(bad);
  EXPECT_THROW(bad.finish(), InputError);
}

/// A subject that is led along a straight path, 0.12 m long, by what it does itself.
class SelfPacedSubjectTest : public testing::Test {
 protected:
  static double pattern(double progress) { return 5.0 - 4.0 * std::cos(4.0 * M_PI * progress); }

  /// @returns (progress, press) at every tick of one pass
  std::vector<std::pair<double, double>> present(VirtualSubject& subject, Hand& hand,
                                                 stimulus::Instruction instruction,
                                                 double seconds = 60.0) {
    std::vector<std::pair<double, double>> moments;
    const double from = hand.state().position.x();
    for (double t = 0.0; t < seconds; t += kStep) {
      const PointState now = hand.state();
      stimulus::Presentation seen;
      seen.tool = now.position;
      seen.show_trajectory = true;
      seen.block = 1;
      seen.pass_duration = 8.0;
      seen.progress = std::min(1.0, std::max(0.0, now.position.x() - from) / 0.12);
      if (seen.progress >= 1.0) {
        subject.observe(seen, Vector3d(Vector3d::Zero()), kStep);
        return moments;
      }
      seen.self_paced = true;
      seen.direction = Vector3d::UnitX();
      seen.instruction = instruction;
      seen.show_target_bar = instruction == stimulus::Instruction::kWatch;
      seen.target_force = seen.show_target_bar ? pattern(seen.progress) : 0.0;
      const Vector3d device(0.0, -2000.0 * now.position.y(), -2000.0 * now.position.z());
      subject.observe(seen, device, kStep);
      moments.emplace_back(seen.progress, device.y());
      hand.step(device, kStep);
    }
    return moments;
  }
};

TEST_F(SelfPacedSubjectTest, GoesToTheEndByItselfAndRecallsByPlace) {
  for (const double pace : {0.006, 0.015}) {  // twice that on a straight path
    PaceParameters habits;
    habits.pace = pace;
    habits.variability = 0.15;
    Hand hand({}, kStep, Vector3d::Zero());
    VirtualSubject subject(noiseless_subject(), {}, hand, 4, kStep, habits);
    const auto watched = present(subject, hand, stimulus::Instruction::kWatch);
    ASSERT_GT(watched.back().first, 0.99);
    EXPECT_NEAR(static_cast<double>(watched.size()) * kStep, 0.12 / (2.0 * pace),
                0.06 / pace * 0.4);
    const auto recalled = present(subject, hand, stimulus::Instruction::kRecall);
    double squares = 0.0;
    int count = 0;
    for (const auto& [progress, press] : recalled) {
      if (progress > 0.1 && progress < 0.95) {
        squares += std::pow(press - pattern(progress), 2);
        ++count;
      }
    }
    // Less than its muscle's lag of 70 ms would cost, at the pattern's slope in this hand's time.
    const double duration = static_cast<double>(recalled.size()) * kStep;
    const double slope = 4.0 * 4.0 * M_PI / duration / std::sqrt(2.0);
    EXPECT_LT(std::sqrt(squares / count), 0.07 * slope) << pace;
  }
}

TEST_F(SelfPacedSubjectTest, WithoutHabitsItWaits) {
  Hand hand({}, kStep, Vector3d::Zero());
  VirtualSubject subject(noiseless_subject(), {}, hand, 4, kStep);
  const auto moments = present(subject, hand, stimulus::Instruction::kWatch, 3.0);
  EXPECT_LT(moments.back().first, 0.01);
}

}  // namespace
}  // namespace haptrial::subject::pacer_test
