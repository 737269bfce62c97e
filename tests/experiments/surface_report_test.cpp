// A QUEST+ over two variables from its definition to the report, with virtual participants who
// feel the size of a force in the plane.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::surface_report_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kPlane = R"toml([experiment]
protocol = "trials"
name = "plane"
[design]
participants = 3
[fields.pull]
type = "constant"
force = ["$x", "-$y", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.4 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "quest_plus"
unit = "N"
probability = "normcdf((sqrt($x ^ 2 + $y ^ 2) - $threshold) / $spread)"
counts = "$answer == 1"
stop = { trials = 60 }
[procedure.stimulus]
x = { from = 0.0, to = 2.0, count = 9, resolution = 0.1 }
y = { from = 0.0, to = 2.0, count = 9 }
[procedure.parameters]
threshold = { from = 0.2, to = 1.8, count = 33 }
spread = [0.05, 0.1, 0.2, 0.4]
[observer]
decides = "yes"
criterion = 0.8
force_floor = 0.1
force_weber = 0.05
lapse = 0.0
[observer.actions]
feel = { do = "hold" }
)toml";

class SurfaceReportTest : public testing::Test {
 protected:
  nlohmann::json report_of(const std::string& definition) {
    write_text(folder_ / "study.toml", definition);
    const std::string at = "'" + folder_.path().string() + "/";
    const auto ran = test::run_command("set -e; haptrial dry-run " + at + "study.toml' --out " +
                                       at + "out'; haptrial analyze " + at + "out'");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    return nlohmann::json::parse(file_text(folder_ / "out/results.json"));
  }
  test::TemporaryFolder folder_;
};

TEST_F(SurfaceReportTest, TheFunctionIsFittedOverBothVariables) {
  const nlohmann::json results = report_of(kPlane);
  ASSERT_EQ(results["surfaces"].size(), 3u);
  for (const nlohmann::json& one : results["surfaces"]) {
    const nlohmann::json& threshold = one["parameters"][0];
    EXPECT_EQ(threshold["name"], "threshold");
    const double mean = threshold["mean"], deviation = threshold["standard_deviation"];
    EXPECT_NEAR(mean, 0.8, 3.5 * deviation) << "the criterion of the virtual participants";
    EXPECT_LT(deviation, 0.1);
    // The contour of this formula is a circle.
    for (const nlohmann::json& point : one["threshold"]) {
      const double x = point["first"];
      if (x < 0.9 * mean) {
        ASSERT_EQ(point["second"].size(), 1u);
        EXPECT_NEAR(std::hypot(x, point["second"][0].get<double>()), mean, 0.02);
        EXPECT_LT(point["low_95"].get<double>(), point["second"][0].get<double>());
        EXPECT_GT(point["high_95"].get<double>(), point["second"][0].get<double>());
      }
    }
  }
  const std::string report = file_text(folder_ / "out/report.md");
  EXPECT_THAT(report, HasSubstr("Functions of several variables (simulated)"));
  EXPECT_THAT(report, HasSubstr("The threshold over both variables"));
  EXPECT_THAT(report, HasSubstr(" | x = 0.25\u00a0N | y | "));
  EXPECT_THAT(report, HasSubstr("level \\[95 %\\] (N)"));
  EXPECT_THAT(report, HasSubstr("surface-S01-"));
  EXPECT_THAT(report, Not(HasSubstr("Every participant's function\n")))
      << "a function of x alone would be of trials with every y";
  EXPECT_THAT(file_text(folder_ / "out/surfaces.csv"), HasSubstr("\nS01,"));
}

/// Without a formula, the threshold of x over y is a quarter of a circle.
TEST_F(SurfaceReportTest, AThresholdWithoutAFormula) {
  std::string text = kPlane;
  const auto from = text.find("kind = \"quest_plus\""), to = text.find("[observer]");
  text.replace(from, to - from, R"toml(kind = "surface"
unit = "N"
counts = "$answer == 1"
guess = 0.0
lapse = 0.01
rising = ["y"]
present = "$x + $y <= 2.5"
stop = { trials = 90 }
[procedure.stimulus]
x = { from = 0.0, to = 2.0, count = 21, resolution = 0.1 }
y = { from = 0.0, to = 1.2, count = 9 }
)toml");
  const nlohmann::json results = report_of(text);
  ASSERT_EQ(results["surfaces"].size(), 3u);
  int points = 0;
  for (const nlohmann::json& one : results["surfaces"]) {
    EXPECT_EQ(one["variables"], nlohmann::json({"y", "x"})) << "x over y";
    for (const nlohmann::json& point : one["threshold"]) {
      const double y = point["first"];
      if (y > 0.5 || point["second"].empty()) {
        continue;
      }
      EXPECT_NEAR(std::hypot(y, point["second"][0].get<double>()), 0.8, 0.15) << "the criterion";
      EXPECT_LT(point["low_95"].get<double>(), point["second"][0].get<double>());
      ++points;
    }
  }
  EXPECT_GE(points, 9);
  const std::string report = file_text(folder_ / "out/report.md");
  EXPECT_THAT(report, HasSubstr("No formula is assumed"));
  EXPECT_THAT(report, HasSubstr("threshold of x at y 0.3"));
  EXPECT_THAT(report, Not(HasSubstr("inf")));
  EXPECT_THAT(report, HasSubstr("surface-S01-"));
  EXPECT_THAT(file_text(folder_ / "out/estimates.csv"), HasSubstr("threshold of x at y 0.6"));
}

/// Whoever looks for a lump says yes or no: d' over all trials, and which lumps are found.
TEST_F(SurfaceReportTest, ADetectionHasItToo) {
  const std::string definition = std::string(HAPTRIAL_SOURCE_DIR) + "/experiments/lump_search.toml";
  const std::string out = (folder_ / "lumps").string();
  ASSERT_EQ(
      test::run_command("haptrial dry-run " + definition + " --subjects 1 --trials 15 --out " + out)
          .status,
      0);
  ASSERT_EQ(test::run_command("haptrial analyze " + out).status, 0);
  const auto results = nlohmann::json::parse(file_text(out + "/results.json"));
  const nlohmann::json& surface = results["surfaces"][0];
  EXPECT_EQ(surface["parameters"][0]["name"], "smallest");
  EXPECT_FALSE(surface.contains("no_contour_because"));
  const std::string report = file_text(out + "/report.md");
  EXPECT_THAT(report, HasSubstr("Sensitivity d'"));
  EXPECT_THAT(report, HasSubstr("surface-S01-"));
}

TEST_F(SurfaceReportTest, WithoutAContourTheReportSaysWhy) {
  std::string text = kPlane;
  const auto put = [&text](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  put("participants = 3", "participants = 1");
  put("force = [\"$x\", \"-$y\", 0.0]", "force = [\"$x\", \"-$y\", \"$z\"]");
  put("y = { from = 0.0, to = 2.0, count = 9 }",
      "y = { from = 0.0, to = 2.0, count = 5 }\nz = [0.0, 1.0]");
  put("sqrt($x ^ 2 + $y ^ 2)", "sqrt($x ^ 2 + $y ^ 2 + $z ^ 2)");
  const nlohmann::json results = report_of(text);
  EXPECT_EQ(results["surfaces"][0]["no_contour_because"],
            "it is drawn over two variables, and the stimulus has 3");
  EXPECT_EQ(results["surfaces"][0]["parameters"].size(), 2u);
  EXPECT_THAT(file_text(folder_ / "out/report.md"),
              HasSubstr("there is no threshold contour, because it is drawn over two variables"));
}

}  // namespace
}  // namespace haptrial::surface_report_test
