#include "protocols/psychophysics/definition/measurement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "protocols/psychophysics/definition/every_value.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols::measurement_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using Q = MeasuredQuantity;
using S = MeasuredStatistic;

constexpr double kRate = 1000.0;

Measure measure_of(Q quantity, S statistic, double last = 0.0) {
  Measure measure;
  measure.quantity = quantity;
  measure.statistic = statistic;
  measure.last = last;
  return measure;
}

/// Two turns of a circle of 10 mm in two seconds: y, or the way.
double of_circle(const Measure& measure) {
  Measurement taken(measure, kRate);
  taken.add(5.0);  // of a stage before
  taken.begin();
  for (int i = 0; i < 2000; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kRate;
    const Eigen::Vector3d place(0.01 * std::cos(angle), 0.01 * std::sin(angle), 0.0);
    measure.is_summed() ? taken.add_place(place) : taken.add(place.y());
  }
  return taken.value();
}

TEST(MeasurementTest, ACircleHasItsOwnNumbers) {
  EXPECT_NEAR(of_circle(measure_of(Q::kY, S::kMean)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(of_circle(measure_of(Q::kY, S::kPeak))), 0.01, 1e-12);
  EXPECT_NEAR(of_circle(measure_of(Q::kY, S::kEnd)),
              -0.01 * std::sin(2.0 * std::numbers::pi / kRate), 1e-12);
  EXPECT_NEAR(of_circle(measure_of(Q::kY, S::kDeviation)), 0.01 / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(of_circle(measure_of(Q::kPath, S::kMean)), 4.0 * std::numbers::pi * 0.01, 1e-4);
}

/// The last half turn: mean of a half sine below 0, half a circle of way.
TEST(MeasurementTest, TheEndOfAStageCountsAlone) {
  EXPECT_NEAR(of_circle(measure_of(Q::kY, S::kMean, 0.5)), -0.02 / std::numbers::pi, 1e-5);
  EXPECT_NEAR(of_circle(measure_of(Q::kPath, S::kMean, 0.5)), std::numbers::pi * 0.01, 1e-4);
  EXPECT_NEAR(of_circle(measure_of(Q::kY, S::kDeviation, 60.0)), 0.01 / std::numbers::sqrt2, 1e-12)
      << "longer than the stage: all of it";
}

TEST(MeasurementTest, WithoutATickThereIsNoValue) {
  for (const double last : {0.0, 0.1}) {
    for (const Q quantity : {Q::kY, Q::kTime}) {
      Measurement taken(measure_of(quantity, S::kMean, last), kRate);
      taken.begin();
      taken.add(std::nan(""));
      EXPECT_TRUE(std::isnan(taken.value()));
    }
  }
}

/// Samples 0, 1, 2, … 99 of place 1, ten at a time, on every tenth tick; the first five are of the
/// stage before.
TEST(MeasurementTest, EverySampleThatWasMeasuredInTheStageAndCameBeforeItsEndCounts) {
  const auto of_bundles = [](S statistic, double last) {
    Measurement taken(measure_of(Q::kChannel, statistic, last), kRate);
    taken.begin();
    for (int tick = 0; tick < 96; ++tick) {
      std::vector<device::ArrivedValue> arrived;
      for (int i = tick + 5 - 10; tick % 10 == 5 && i < tick + 5; ++i) {
        arrived.push_back({0, 1e3, 0.0});
        arrived.push_back({1, static_cast<double>(i), 1e-3 * (tick + 5 - i)});
      }
      taken.add_samples(arrived, 1, 7.0, 1e-3 * tick);
    }
    return taken.value();
  };
  // 5 … 99 are 95 numbers: their mean is 52, their variance (95² - 1) / 12.
  EXPECT_NEAR(of_bundles(S::kMean, 0.0), 52.0, 1e-12);
  EXPECT_NEAR(of_bundles(S::kDeviation, 0.0), std::sqrt((95.0 * 95.0 - 1.0) / 12.0), 1e-12);
  EXPECT_EQ(of_bundles(S::kPeak, 0.0), 99.0);
  EXPECT_EQ(of_bundles(S::kEnd, 0.0), 99.0);
  EXPECT_NEAR(of_bundles(S::kMean, 0.02), 89.5, 1e-12) << "80 … 99";
  EXPECT_NEAR(of_bundles(S::kDeviation, 0.02), std::sqrt((20.0 * 20.0 - 1.0) / 12.0), 1e-12);
}

TEST(MeasurementTest, AStageWithoutASampleHasTheNewestValue) {
  for (const double last : {0.0, 0.1}) {
    Measurement taken(measure_of(Q::kChannel, S::kPeak, last), kRate);
    taken.begin();
    const device::ArrivedValue before{0, 9.0, 0.5};
    taken.add_samples({&before, 1}, 0, 2.5, 0.0);
    EXPECT_EQ(taken.value(), 2.5);
    taken.begin();
    taken.add_samples({}, 0, std::nan(""), 0.0);
    EXPECT_TRUE(std::isnan(taken.value())) << "the channel is lost";
  }
}

TEST(MeasurementTest, DoesNotAllocate) {
  Measurement taken(measure_of(Q::kY, S::kMean, 0.5), kRate);
  const test::AllocationGuard guard;
  taken.begin();
  for (int i = 0; i < 1000; ++i) {
    taken.add(i);
    EXPECT_TRUE(std::isfinite(taken.value()));
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(MeasureTest, PeopleReadMillimetres) {
  Measure measure;
  measure.text = "You went {} far.";
  measure.unit = "m";
  EXPECT_EQ(told_value(measure, 0.01234), "You went 12.3 mm far.");
  measure.unit = "N";
  EXPECT_EQ(told_value(measure, 1.2345), "You went 1.23 N far.");
}

std::string measuring(const std::string& more) { return small_trials(kSmallStaircase, more); }

TEST(MeasureTest, MeasuresAreReadWithTheirUnits) {
  TrialsDefinition d;
  read_small(measuring("[measures.pressed]\nfield = \"floor\"\nwithin = [\"0.5 * $trial\", 2.0]\n"
                       "[measures.way]\nquantity = \"path\"\ninterval = \"reference\"\n"
                       "[measures.near]\nquantity = \"distance\"\nto = \"spot\"\n"
                       "[places]\nspot = [0.0, 0.01, 0.0]\n"),
             d);
  ASSERT_EQ(d.measures.size(), 3U);
  EXPECT_EQ(d.measures[0].unit, "N");
  EXPECT_EQ(d.measures[0].field, 0);
  EXPECT_EQ(d.measures[0].low, 0.5);
  EXPECT_EQ(d.measures[1].unit, "m");
  EXPECT_EQ(d.measures[1].interval, 0);
  EXPECT_EQ(d.measures[2].place.y(), 0.01);
  EXPECT_EQ(words_of(d.measures[0]), "mean force");
}

TEST(MeasureTest, MistakesAreNamed) {
  const auto problems = [](const std::string& more) {
    return problems_of_trials(measuring("[measures.m]\n" + more));
  };
  EXPECT_THAT(problems("stage = \"press\"\n"), IsEmpty());
  EXPECT_THAT(problems("stage = \"pres\"\n"), Contains(HasSubstr("one of: press")));
  EXPECT_THAT(problems("quantity = \"depth\"\n"), Contains(HasSubstr("needs field")));
  EXPECT_THAT(problems("quantity = \"speed\"\nfield = \"floor\"\n"),
              Contains(HasSubstr("only a force or depth is of a field")));
  EXPECT_THAT(problems("quantity = \"distance\"\nto = \"nowhere\"\n"),
              Contains(HasSubstr("a place or of a moving target")));
  EXPECT_THAT(problems("quantity = \"time\"\nstatistic = \"peak\"\n"),
              Contains(HasSubstr("a path or a time is one number")));
  EXPECT_THAT(problems("within = [2.0, 1.0]\n"), Contains(HasSubstr("[lowest, highest]")));
  EXPECT_THAT(problems("text = \"{}\"\n"), Contains(HasSubstr("add feedback")));
  EXPECT_THAT(problems_of_trials(measuring("[measures.answer]\n")),
              Contains(HasSubstr("give the measure another name")));
  EXPECT_THAT(problems_of_trials(measuring("[measures.\"a b\"]\n")),
              Contains(HasSubstr("letters, digits and _")));
}

TEST(MeasureTest, AStageRequiresAMeasureOfItsOwn) {
  const auto problems = [](const std::string& require, const std::string& more) {
    std::string text = measuring(more);
    const std::string until = "until = { time = 0.2 }\n";
    return problems_of_trials(text.replace(text.find(until), until.size(), until + require));
  };
  const std::string require = "require = { measure = \"m\", at_least = 1.0, else = \"go on\" }\n";
  EXPECT_THAT(problems(require, "[measures.m]\n"), IsEmpty());
  EXPECT_THAT(problems(require, ""), Contains(HasSubstr("measure")));
  EXPECT_THAT(
      problems("require = { measure = \"m\", at_least = 2, at_most = 1, else = \"abort\" }\n",
               "[measures.m]\n"),
      Contains(HasSubstr("at most at_most")));
  EXPECT_THAT(problems("require = { measure = \"m\", else = \"abort\" }\n", "[measures.m]\n"),
              Contains(HasSubstr("at_least is missing")));
  EXPECT_THAT(problems("require = { at_least = 1.0, else = \"abort\" }\n", ""),
              Contains(HasSubstr("max_of is missing; state it or measure")));
  EXPECT_THAT(problems(require,
                       "[[stages]]\nname = \"more\"\nuntil = { time = 0.1 }\n"
                       "[measures.m]\nstage = \"more\"\n"),
              Contains(HasSubstr("a measure of this stage")));
}

}  // namespace
}  // namespace haptrial::protocols::measurement_test
