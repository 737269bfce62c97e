#include "core/base/definition/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include <cmath>
#include <map>

#include "core/base/error.h"

namespace haptrial {
namespace {

double value_of(const std::string& text, const std::map<std::string, double>& values = {}) {
  Labels labels;
  return Expression(text, labels).value([&](const std::string& name) { return values.at(name); });
}

std::string complaint_about(const std::string& text) {
  try {
    value_of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ExpressionTest, ComputesAsWritten) {
  EXPECT_EQ(value_of("1 + 2 * 3 ^ 2"), 19.0);
  EXPECT_EQ(value_of("(1 + 2) * -3"), -9.0);
  EXPECT_EQ(value_of("2 > 1 ? 5 : 7"), 5.0);
  EXPECT_EQ(value_of("max(1, 4, 2) - min(3, -1)"), 5.0);
  EXPECT_NEAR(value_of("sin(0.5)^2 + cos(0.5)^2"), 1.0, 1e-15);
  EXPECT_NEAR(value_of("exp(ln(2.5)) + log10(1000)"), 5.5, 1e-12);
}

TEST(ExpressionTest, NamesMayHaveADollarAndDots) {
  Labels labels;
  const Expression e("standards.height - $conflict / 2", labels);
  EXPECT_THAT(e.names(), testing::ElementsAre("conflict", "standards.height"));
  EXPECT_EQ(value_of("standards.height - $conflict / 2",
                     {{"standards.height", 0.055}, {"conflict", 0.006}}),
            0.055 - 0.006 / 2);
  EXPECT_EQ(value_of("$b", {{"b", -13.0}}), -13.0);
  EXPECT_EQ(value_of("-$b", {{"b", -13.0}}), 13.0);
}

TEST(ExpressionTest, ConditionsAreOneOrZero) {
  for (const double a : {0.0, 1.0}) {
    for (const double b : {0.0, 1.0}) {
      const std::map<std::string, double> values{{"a", a}, {"b", b}};
      EXPECT_EQ(value_of("a and b", values), a * b);
      EXPECT_EQ(value_of("a or b", values), std::max(a, b));
      EXPECT_EQ(value_of("not(a)", values), 1.0 - a);
    }
  }
  EXPECT_EQ(value_of("between(0.4, 0.35, 0.55) and 1 < 2"), 1.0);
  EXPECT_EQ(value_of("between(0.34, 0.35, 0.55)"), 0.0);
}

TEST(ExpressionTest, WordsAreComparedAsWords) {
  Labels labels;
  const Expression e("modality != 'visual' and level > 300", labels);
  const auto with = [&](const char* modality) {
    const double number = labels.number_of(modality);
    return e.value([&](const std::string& name) { return name == "level" ? 301.0 : number; });
  };
  EXPECT_EQ(with("haptic"), 1.0);
  EXPECT_EQ(with("visual"), 0.0);
  EXPECT_EQ(labels.word_of(labels.number_of("visual")), "visual");
  EXPECT_FALSE(labels.word_of(300.0));
}

TEST(ExpressionTest, ACopyHasItsOwnVariables) {
  Labels labels;
  const Expression one("2 * x", labels);
  const Expression other = one;
  EXPECT_EQ(one.value([](const std::string&) { return 1.0; }), 2.0);
  EXPECT_EQ(other.value([](const std::string&) { return 5.0; }), 10.0);
  EXPECT_EQ(one.value([](const std::string&) { return 3.0; }), 6.0);
}

TEST(ExpressionTest, MistakesGetTheirSentence) {
  EXPECT_EQ(complaint_about("300 +"), "\"300 +\" ends too early");
  EXPECT_EQ(complaint_about("(300"), "\"(300\" has parentheses that do not match");
  EXPECT_EQ(complaint_about("sqrt(1, 2)"),
            "\"sqrt(1, 2)\" gives a function another number of values than it takes");
  EXPECT_EQ(complaint_about("a == 'visual"), "\"a == 'visual\" has a word without its closing '");
  EXPECT_EQ(complaint_about("1 / 0"), "\"1 / 0\" is inf; allowed: a finite number");
  EXPECT_EQ(complaint_about("3 4"), "\"3 4\" cannot be read at '4'");
  EXPECT_EQ(complaint_about(""), "an empty text is no formula");
}

// The parser that is used keeps its decimal point in a static variable.
TEST(ExpressionTest, AreMadeInSeveralThreadsAtOnce) {
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&wrong] {
      Labels labels;
      for (int i = 0; i < 2000; ++i) {
        const Expression formula("0.5 * $x + 1.25", labels);
        wrong += formula.value([](const std::string&) { return 3.0; }) == 2.75 ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace haptrial
