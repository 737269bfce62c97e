#include "analysis/force_training/score/score_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/base/error.h"

namespace haptrial::analysis::score_parameters_test {
namespace {

using testing::HasSubstr;

const std::string kGood = R"([analysis]
samples = 800
filter_width = 0.05
force_weight = 1.5
slope_weight = 0.25
power = 2
penalty = 0.2
cost_share = 3.0
force_share = 0.0
slope_share = 0.75
)";

std::string with(const std::string& line, const std::string& instead) {
  std::string text = kGood;
  text.replace(text.find(line), line.size(), instead);
  return text;
}

ScoreParameters read(const std::string& text) {
  Table document = Table::parse(text, "test.toml");
  Table analysis = document.table("analysis");
  const ScoreParameters parameters = score_schema().read(analysis);
  document.finish();
  return parameters;
}

std::string problem_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ScoreParametersTest, EveryKeyIsRead) {
  const ScoreParameters p = read(kGood);
  EXPECT_EQ(p.samples, 800);
  EXPECT_EQ(p.filter_width, 0.05);
  EXPECT_EQ(p.alignment.force_weight, 1.5);
  EXPECT_EQ(p.alignment.slope_weight, 0.25);
  EXPECT_EQ(p.alignment.power, 2);
  EXPECT_EQ(p.alignment.penalty, 0.2);
  EXPECT_EQ(p.cost_share, 3.0);
  EXPECT_EQ(p.force_share, 0.0);
  EXPECT_EQ(p.slope_share, 0.75);
}

TEST(ScoreParametersTest, KeysOfOtherFormsMayBeThere) {
  EXPECT_EQ(read(kGood).alignment.pattern, StepPattern::kPublished);
  EXPECT_EQ(read(kGood).window, std::nullopt);
  const ScoreParameters p = read(kGood +
                                 "step_pattern = \"asymmetric\"\nwindow = 0.5\n"
                                 "open_begin = true\nopen_end = true\n");
  EXPECT_EQ(p.alignment.pattern, StepPattern::kAsymmetric);
  EXPECT_EQ(p.window, 0.5);
  EXPECT_TRUE(p.alignment.open_begin && p.alignment.open_end);
  EXPECT_EQ(read(with("power = 2\n", "power = 1.5\n")).alignment.power, 1.5);
  EXPECT_THAT(problem_of(kGood + "step_pattern = \"best\"\n"),
              HasSubstr("analysis.step_pattern is 'best'"));
  EXPECT_THAT(problem_of(kGood + "window = -1.0\n"), HasSubstr("analysis.window is -1"));
  EXPECT_THAT(problem_of(kGood + "open_end = 1\n"), HasSubstr("analysis.open_end"));
  EXPECT_THAT(problem_of(kGood + "step_pattern = \"symmetric2\"\nopen_begin = true\n"),
              HasSubstr("analysis.open_begin is true with the step pattern symmetric2; choose"));
}

TEST(ScoreParametersTest, DescribedInWords) {
  const auto plain = described(ScoreParameters{});
  ScoreParameters p;
  p.alignment.pattern = StepPattern::kAsymmetric;
  p.window = 0.25;
  p.alignment.open_end = true;
  const auto rows = described(p);
  EXPECT_EQ(rows.size(), plain.size() + 3);
  const auto has = [&](const char* name, const char* value) {
    return std::find(rows.begin(), rows.end(), std::pair<std::string, std::string>(name, value)) !=
           rows.end();
  };
  EXPECT_TRUE(has("step pattern", "asymmetric"));
  EXPECT_TRUE(has("window", "0.25 s"));
  EXPECT_TRUE(has("open ends", "end"));
}

TEST(ScoreParametersTest, ProblemsNameTheKey) {
  EXPECT_THAT(problem_of(with("samples = 800\n", "samples = 1\n")), HasSubstr("analysis.samples"));
  EXPECT_THAT(problem_of(with("filter_width = 0.05\n", "filter_width = -1.0\n")),
              HasSubstr("analysis.filter_width"));
  EXPECT_THAT(problem_of(with("power = 2\n", "power = 0.5\n")), HasSubstr("analysis.power"));
  EXPECT_THAT(problem_of(with("penalty = 0.2\n", "")), HasSubstr("analysis.penalty"));
  EXPECT_THAT(problem_of(with("penalty = 0.2\n", "penalty = 0.2\npenalti = 1.0\n")),
              HasSubstr("penalti"));
  std::string no_share = with("cost_share = 3.0\n", "cost_share = 0.0\n");
  no_share.replace(no_share.find("0.75"), 4, "0.0");
  EXPECT_THAT(problem_of(no_share), HasSubstr("set at least one of them above 0"));
}

TEST(ScoreParametersTest, CheckRefusesWhatTheTableRefuses) {
  EXPECT_NO_THROW(check(ScoreParameters{}));
  const auto refused = [](auto change) {
    ScoreParameters p;
    change(p);
    EXPECT_THROW(check(p), std::invalid_argument);
  };
  refused([](auto& p) { p.samples = 1; });
  refused([](auto& p) { p.samples = 10001; });
  refused([](auto& p) { p.filter_width = -0.1; });
  refused([](auto& p) { p.alignment.power = 0; });
  refused([](auto& p) { p.alignment.force_weight = std::nan(""); });
  refused([](auto& p) { p.alignment.slope_weight = -1.0; });
  refused([](auto& p) { p.alignment.penalty = -1.0; });
  refused([](auto& p) { p.window = -1.0; });
  refused([](auto& p) {
    p.window = 1.0;
    p.alignment.window = 10;
  });
  refused([](auto& p) {
    p.alignment.pattern = StepPattern::kSymmetricP1;
    p.alignment.open_begin = true;
  });
  refused([](auto& p) { p.cost_share = -1.0; });
  refused([](auto& p) { p.force_share = 1e7; });
  refused([](auto& p) { p.slope_share = std::nan(""); });
  refused([](auto& p) { p.cost_share = p.force_share = p.slope_share = 0.0; });
}

}  // namespace
}  // namespace haptrial::analysis::score_parameters_test
