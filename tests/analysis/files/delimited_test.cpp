#include "analysis/files/delimited.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <sstream>

#include "core/base/random.h"

namespace haptrial::exchange {
namespace {

TEST(RowTextTest, CsvQuotesWhatNeedsIt) {
  std::string text;
  RowText row(text, Delimited::kCsv);
  row.add("plain").add("a,b").add("say \"x\"").add("two\nlines").add("").add("tab\there").end();
  EXPECT_EQ(text, "plain,\"a,b\",\"say \"\"x\"\"\",\"two\nlines\",,tab\there\n");
}

TEST(RowTextTest, TsvHasNoQuotesAndOneLineForARow) {
  std::string text;
  RowText row(text, Delimited::kTsv);
  row.add("a\tb\nc\r").add("say \"x\"").add("").add_missing().add(3).end();
  row.add(-4).end();
  EXPECT_EQ(text, "a b c \tsay \"x\"\tn/a\tn/a\t3\n-4\n");
}

TEST(RowTextTest, NumbersReadBackToTheSameValue) {
  RandomStream random(3, "numbers");
  std::string text;
  RowText row(text, Delimited::kCsv);
  for (int i = 0; i < 20000; ++i) {
    const double value = random.normal() * std::pow(10.0, random.uniform(-30.0, 30.0));
    const float narrow = static_cast<float>(value);
    text.clear();
    row.add(value).add(narrow).end();
    char* rest = nullptr;
    EXPECT_EQ(std::strtod(text.c_str(), &rest), value) << text;
    EXPECT_EQ(std::strtof(rest + 1, nullptr), narrow) << text;
    EXPECT_EQ(text.find('e'), std::string::npos) << text;
  }
}

TEST(RowTextTest, WhatIsNoFiniteNumberIsMissing) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::string text;
  RowText row(text, Delimited::kTsv);
  row.add(std::nan("")).add(-kInfinity).add(std::numeric_limits<float>::infinity()).end();
  EXPECT_EQ(text, "n/a\tn/a\tn/a\n");
  text.clear();
  RowText csv(text, Delimited::kCsv);
  csv.add(1).add(std::nan("")).add(std::numeric_limits<std::uint64_t>::max()).end();
  EXPECT_EQ(text, "1,,18446744073709551615\n");
}

TEST(RowTextTest, SecondsAreExact) {
  std::string text;
  RowText row(text, Delimited::kCsv);
  row.add_seconds(0).add_seconds(1'500'000'000).add_seconds(1).add_seconds(-20).end();
  row.add_seconds(std::numeric_limits<std::int64_t>::max()).add_seconds(-3'000'000'000).end();
  EXPECT_EQ(text, "0,1.5,0.000000001,-0.00000002\n9223372036.854775807,-3\n");
}

}  // namespace
}  // namespace haptrial::exchange
