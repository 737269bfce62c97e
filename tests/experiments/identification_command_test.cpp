// One of several shapes is felt and named: from a definition to the report.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/psychometric/models/detection.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using testing::HasSubstr;
using testing::Not;

/// shape_recognition with four answers in place of two; briefer.
std::string four_shapes() {
  std::string text =
      test::read_text(test::shipped_definition().parent_path() / "shape_recognition.toml");
  const auto replace = [&](const std::string& from, const std::string& to, const std::string& by) {
    const std::size_t begin = text.find(from), end = text.find(to, begin);
    EXPECT_NE(begin, std::string::npos) << from;
    EXPECT_NE(end, std::string::npos) << to;
    text.replace(begin, end - begin, by);
  };
  replace("[[responses]]\nname = \"sphere\"", "[[responses]]\nname = \"confidence\"",
          R"([[responses]]
name = "shape"
question = "What was it?"
choices = [{ value = "sphere" }, { value = "egg" }, { value = "cube" }, { value = "cylinder" }]
correct = "$shape"
)");
  replace("decides = \"yes\"", "decision_noise",
          "decides = \"nearest\"\nprototypes = [0.0009, 0.0015, 0.0029, 0.0033]  # [m]\n");
  replace("trials = 48", "\n", "trials = 16");
  replace("participants = 10", "\n", "participants = 2");
  replace("kind = \"detection\"", "\n", "kind = \"identification\"\nstimulus = \"shape\"");
  return text;
}

class IdentificationCommandTest : public testing::Test {
 protected:
  test::CommandResult run(const std::string& line) {
    return test::run_command("cd '" + folder_.path().string() + "'\n" + line);
  }
  test::TemporaryFolder folder_;
};

/// A sphere and a cylinder are far apart for whoever feels how uneven a thing is; nobody who feels
/// only this mistakes one for the other.
TEST_F(IdentificationCommandTest, ShapesAreNamedAndTheirConfusionsReported) {
  test::write_text(folder_ / "shapes.toml", four_shapes());
  const auto rehearsed = run("haptrial dry-run shapes.toml --out study");
  ASSERT_EQ(rehearsed.status, 0) << rehearsed.errors;
  const auto analysed = run("haptrial analyze study");
  ASSERT_EQ(analysed.status, 0) << analysed.errors;
  EXPECT_THAT(analysed.output, HasSubstr("Share of right answers"));
  const auto json = nlohmann::json::parse(test::read_text(folder_ / "study/results.json"));
  EXPECT_EQ(json["choices"], (nlohmann::json{"sphere", "egg", "cube", "cylinder"}));
  ASSERT_EQ(json["identification"].size(), 2U);
  int all_right = 0;
  for (const auto& one : json["identification"]) {
    ASSERT_EQ(one["stimuli"], json["choices"]);
    int total = 0, right = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const int count = one["answers"][i][j];
        total += count;
        right += i == j ? count : 0;
      }
    }
    EXPECT_EQ(total, 16);
    EXPECT_EQ(one["right"], right);
    all_right += right;
    EXPECT_EQ(one["answers"][0][3], 0) << "a sphere is no cylinder";
    EXPECT_EQ(one["answers"][3][0], 0);
    EXPECT_GT(one["d_prime"].get<double>(), 0.2);
  }
  EXPECT_GT(all_right, 14) << "of 32, far above the 8 of chance";
  const std::string report = test::read_text(folder_ / "study/report.html");
  EXPECT_THAT(report, HasSubstr("Shares of the answers to each stimulus"));
  EXPECT_THAT(report, HasSubstr("Chance is 0.250"));
  EXPECT_THAT(test::read_text(folder_ / "study/estimates.csv"), HasSubstr("share_right"));
}

/// The same answers, taken for those of another task.
TEST_F(IdentificationCommandTest, DPrimeIsThatOfTheTask) {
  test::write_text(folder_ / "odd.toml", four_shapes() + "task = \"oddity\"\n");
  const auto analysed =
      run("haptrial dry-run odd.toml --out study >&2 && haptrial analyze study >&2");
  ASSERT_EQ(analysed.status, 0) << analysed.errors;
  const auto json = nlohmann::json::parse(test::read_text(folder_ / "study/results.json"));
  for (const auto& one : json["identification"]) {
    const double share = one["right"].get<double>() / 16.0;
    EXPECT_NEAR(one["d_prime"].get<double>(),
                *analysis::task_d_prime(analysis::DiscriminationTask::kOddity, share, 3), 1e-9);
  }
  EXPECT_THAT(test::read_text(folder_ / "study/report.html"), HasSubstr("the odd one of three"));
}

/// Two things that are felt one after the other may be two stages of one interval.
TEST_F(IdentificationCommandTest, StagesThatMayPresentTwoStimuliNeedATask) {
  const auto validated = [&](const std::string& rest, const std::string& task) {
    std::string text =
        test::read_text(test::shipped_definition().parent_path() / "shape_recognition.toml");
    const std::string kind = "kind = \"detection\"", fields = "fields = [\"guide\"]\n";
    text.replace(text.find(fields), fields.size(), rest);
    text.replace(text.find(kind), kind.size(), "kind = \"identification\"" + task);
    test::write_text(folder_ / "two.toml", text);
    const auto result = run("haptrial validate two.toml");
    EXPECT_EQ(result.status, 0) << result.errors;
    return result.output + result.errors;
  };
  const std::string warning = "stages of a trial have different fields";
  EXPECT_THAT(validated("fields = \"guide\"\n", ""), HasSubstr(warning));
  EXPECT_THAT(validated("", ""), Not(HasSubstr(warning)));
  EXPECT_THAT(validated("fields = \"guide\"\n", "\ntask = \"one interval\""),
              Not(HasSubstr(warning)));
}

TEST_F(IdentificationCommandTest, MistakesOfADefinitionGetASentence) {
  const auto told = [&](const std::string& from, const std::string& by) {
    std::string text = four_shapes();
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), by);
    test::write_text(folder_ / "wrong.toml", text);
    const auto result = run("haptrial validate wrong.toml");
    EXPECT_NE(result.status, 0);
    return result.errors + result.output;
  };
  EXPECT_THAT(told("0.0029, 0.0033]", "0.0029]"),
              HasSubstr("4 numbers, one for each choice of the response"));
  EXPECT_THAT(told("stimulus = \"shape\"", "stimulus = \"form\""),
              HasSubstr("the factor that says what was presented"));
}

}  // namespace
}  // namespace haptrial
