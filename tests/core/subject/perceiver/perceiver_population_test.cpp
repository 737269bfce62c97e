#include "core/subject/perceiver/perceiver_population.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace haptrial::subject {
namespace {

using testing::HasSubstr;

PerceiverPopulation read(const std::string& text, bool logarithmic = true) {
  Table table = Table::parse(text, "people.toml");
  PerceiverPopulation people(table, logarithmic);
  table.finish();
  return people;
}

TEST(PerceiverPopulationTest, WhatIsLeftOutIsTheDefault) {
  const PerceiverPopulation people = read("lapse = 0.02\n");
  const SenseParameters senses = people.draw_senses(5);
  const SenseParameters defaults;
  EXPECT_EQ(senses.force_weber, defaults.force_weber);
  EXPECT_EQ(senses.moving_speed, defaults.moving_speed);
  EXPECT_EQ(people.draw_judgement(5).lapse, 0.02);
  EXPECT_EQ(people.draw_judgement(5).criterion, JudgementParameters{}.criterion);
  EXPECT_NO_THROW(check(senses));
}

TEST(PerceiverPopulationTest, PeopleVaryAsStated) {
  const PerceiverPopulation people = read(
      "force_weber = { median = 0.08, spread = 0.3 }\n"
      "bias_first = { median = -0.02, spread = 0.05 }\n");
  EXPECT_TRUE(people.varies());
  EXPECT_EQ(people.draw_senses(3).force_weber, draw({0.08, 0.3}, 3, "observer force_weber"));
  constexpr int kPeople = 10000;
  double logs = 0.0;
  double log_squares = 0.0;
  double bias = 0.0;
  double together = 0.0;
  for (int i = 0; i < kPeople; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const double x = std::log(people.draw_senses(seed).force_weber / 0.08) / 0.3;
    const double b = (people.draw_judgement(seed).bias_first + 0.02) / 0.05;
    logs += x / kPeople;
    log_squares += x * x / kPeople;
    bias += b / kPeople;
    together += x * b / kPeople;
  }
  const double error = 4.0 / std::sqrt(kPeople);
  EXPECT_NEAR(logs, 0.0, error);
  EXPECT_NEAR(log_squares, 1.0, error * std::sqrt(2.0));
  EXPECT_NEAR(bias, 0.0, error);
  EXPECT_NEAR(together, 0.0, error) << "independent";
}

TEST(PerceiverPopulationTest, ALinearCriterionCanBeAnywhere) {
  EXPECT_EQ(read("criterion = -0.01\n", false).draw_judgement(1).criterion, -0.01);
  EXPECT_FALSE(read("lapse = 0.0\n", false).draw_judgement(1).logarithmic);
}

TEST(PerceiverPopulationTest, BadValuesAreNamed) {
  const auto message = [](const std::string& text) {
    return haptrial::test::message_of<InputError>([&] { read(text); });
  };
  EXPECT_THAT(message("force_weber = -0.1\n"), HasSubstr("force_weber is -0.1; allowed:"));
  EXPECT_THAT(message("lapse = { median = 2.0, spread = 0.1 }\n"), HasSubstr("lapse.median is 2"));
  EXPECT_THAT(message("displacement_bias = 1.0\n"), HasSubstr("displacement_bias is 1"));
  EXPECT_THAT(message("criterion = 0.0\n"), HasSubstr("criterion is 0"));
  EXPECT_THAT(message("drift = \"up\"\n"), HasSubstr("drift is 'up'; allowed: a number"));
}

}  // namespace
}  // namespace haptrial::subject
