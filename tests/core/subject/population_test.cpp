#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/subject/population.h"
#include "core/subject/subject_parameters.h"

namespace haptrial::subject {
namespace {

constexpr const char* kKeys[] = {"visual_weber",        "haptic_weber", "visual_memory_noise",
                                 "haptic_memory_noise", "haptic_bias",  "bar_misjudgement",
                                 "calibration_loss",    "forgetting",   "memory_correlation",
                                 "production_bias",     "timing_error", "timing_correlation",
                                 "visual_delay",        "haptic_delay", "force_noise",
                                 "force_noise_time",    "tremor",       "tremor_frequency"};

std::string definition(double median, double spread, const std::string& replaced_key = "",
                       const std::string& replacement = "") {
  std::string text;
  for (const char* key : kKeys) {
    text += key == replaced_key ? replacement + "\n"
                                : std::string(key) + " = { median = " + std::to_string(median) +
                                      ", spread = " + std::to_string(spread) + " }\n";
  }
  return text;
}

Population<SubjectParameters> population(const std::string& text) {
  Table table = Table::parse(text, "people.toml");
  const auto read = subject_schema().read(table);
  table.finish();
  return read;
}

TEST(PopulationTest, WithoutSpreadEverybodyIsTheMedian) {
  const SubjectParameters person = population(definition(0.25, 0.0)).draw(99);
  EXPECT_EQ(person.visual_weber, 0.25);
  EXPECT_EQ(person.tremor_frequency, 0.25);
}

TEST(PopulationTest, ANumberIsTheSameForEverybody) {
  const auto people = population(definition(0.1, 0.3, "tremor", "tremor = 0.02"));
  EXPECT_EQ(people.draw(1).tremor, 0.02);
  EXPECT_EQ(people.draw(2).tremor, 0.02);
  EXPECT_NE(people.draw(1).haptic_weber, people.draw(2).haptic_weber);
  EXPECT_EQ(people.draw(3).haptic_weber, draw({0.1, 0.3}, 3, "haptic_weber"));
}

TEST(PopulationTest, AShiftIsAddedAndCanBeNegative) {
  Table table = Table::parse("bias = { median = -0.1, spread = 0.2 }", "people.toml");
  const Variation bias = read_shift(table, "bias", {-1.0, 1.0}, "");
  table.finish();
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kPeople = 20000;
  for (int i = 0; i < kPeople; ++i) {
    const double x = draw(bias, static_cast<std::uint64_t>(i), "bias") + 0.1;
    sum += x / kPeople;
    squares += x * x / kPeople;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 * 0.2 / std::sqrt(kPeople));
  EXPECT_NEAR(std::sqrt(squares), 0.2, 4.0 * 0.2 / std::sqrt(2.0 * kPeople));
  EXPECT_EQ(draw({0.5, 2.0, true}, 1, "bias", {0.49, 0.51}),
            draw({0.5, 1e9, true}, 1, "bias", {0.49, 0.51}))
      << "stays within its bounds";
}

TEST(PopulationTest, SpreadIsThatOfTheLogarithm) {
  const auto people = population(definition(0.1, 0.3));
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kPeople = 20000;
  for (int i = 0; i < kPeople; ++i) {
    const double x = std::log(people.draw(static_cast<std::uint64_t>(i)).haptic_weber / 0.1);
    sum += x / kPeople;
    squares += x * x / kPeople;
  }
  EXPECT_NEAR(sum, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(squares), 0.3, 0.01);
}

TEST(PopulationTest, ParametersVaryIndependentlyAndRepeatably) {
  const auto people = population(definition(0.1, 0.3));
  double product = 0.0;
  constexpr int kPeople = 20000;
  for (int i = 0; i < kPeople; ++i) {
    const SubjectParameters p = people.draw(static_cast<std::uint64_t>(i));
    product += std::log(p.haptic_weber / 0.1) * std::log(p.visual_weber / 0.1) / kPeople / 0.09;
    EXPECT_EQ(p.haptic_weber, people.draw(static_cast<std::uint64_t>(i)).haptic_weber);
  }
  EXPECT_NEAR(product, 0.0, 4.0 / std::sqrt(kPeople));
}

TEST(PopulationTest, BadValuesAreNamed) {
  const auto expect_named = [](const std::string& entry, const std::string& what) {
    const std::string key = entry.substr(0, entry.find(' '));
    try {
      population(definition(0.1, 0.1, key, entry));
      FAIL() << entry << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  expect_named("haptic_weber = { median = -0.1, spread = 0.1 }", "haptic_weber.median is -0.1");
  expect_named("haptic_weber = { median = 0.1, spread = nan }", "haptic_weber.spread is nan");
  expect_named("haptic_weber = -0.1", "haptic_weber is -0.1; allowed: a number of");
  expect_named("haptic_weber = \"low\"", "haptic_weber is 'low'; allowed: a number of");
  expect_named("tremor_frequency = { median = 0.0, spread = 0.1 }", "tremor_frequency.median is 0");
  expect_named("visual_delay = { median = 2.0, spread = 0.1 }", "visual_delay.median is 2");
}

}  // namespace
}  // namespace haptrial::subject
