// What stands in results/ is what the program gives.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

TEST(ResultsTest, ManifestsReproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "whole studies take too long here; other builds make them anew";
  }
  int studies = 0;
  int comparisons = 0;
  const fs::path source = HAPTRIAL_SOURCE_DIR;
  for (const auto& entry : fs::directory_iterator(source / "results")) {
    if (!entry.is_directory()) {
      continue;
    }
    const fs::path folder = entry.path();
    const auto manifest = nlohmann::json::parse(test::read_text(folder / "manifest.json"));
    if (!manifest.contains("scores_sha256")) {
      continue;  // a study of drillings: ValidityResultsTest
    }
    const test::TemporaryFolder out;
    std::string script = "set -e; cd '" + source.string() + "'\n";
    for (const std::string command : manifest["commands"]) {
      script += replaced(command, " OUT", " '" + (out / "study").string() + "'") + "\n";
    }
    const test::CommandResult result = test::run_command(script);
    ASSERT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(test::read_text(out / "study" / "scores.csv"), test::read_text(folder / "scores.csv"))
        << folder << " is not what its manifest gives; results/regenerate.sh makes it anew";
    for (const char* name : {"comparison.json", "comparison.html", "comparison.svg"}) {
      if (fs::exists(folder / name)) {
        EXPECT_EQ(test::read_text(out / "study" / name), test::read_text(folder / name)) << name;
        ++comparisons;
      }
    }
    const auto sum = [](const fs::path& file) {
      return test::run_command("sha256sum < '" + file.string() + "'").output.substr(0, 64);
    };
    EXPECT_EQ(sum(folder / "scores.csv"), manifest["scores_sha256"]);
    const std::string definition = manifest["study"].get<std::string>() + ".toml";
    EXPECT_EQ(sum(source / "experiments" / definition), manifest["definition_sha256"]);
    EXPECT_TRUE(manifest["simulated"].get<bool>());
    EXPECT_THAT(test::read_text(folder / "report.html"), testing::HasSubstr("SIMULATED"));
    EXPECT_FALSE(fs::exists(folder / "S01.h5")) << "session files stay out";
    ++studies;
  }
  EXPECT_GE(studies, 2);
  EXPECT_EQ(comparisons, 3);
}

/// Runs the commands of a manifest again and compares the estimates.
void expect_the_same(const fs::path& folder) {
  const fs::path source = HAPTRIAL_SOURCE_DIR;
  const auto manifest = nlohmann::json::parse(test::read_text(folder / "manifest.json"));
  const test::TemporaryFolder out;
  std::string script = "set -e; cd '" + source.string() + "'\n";
  for (const std::string command : manifest["commands"]) {
    script += replaced(command, " OUT", " '" + (out / "study").string() + "'") + "\n";
  }
  const test::CommandResult result = test::run_command(script);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(test::read_text(out / "study/estimates.csv"), test::read_text(folder / "estimates.csv"))
      << folder << " is not what its manifest gives; results/regenerate.sh makes it anew";
  const auto sum = [](const fs::path& file) {
    return test::run_command("sha256sum < '" + file.string() + "'").output.substr(0, 64);
  };
  const std::string definition = manifest["study"].get<std::string>() + ".toml";
  EXPECT_EQ(sum(source / "experiments" / definition), manifest["definition_sha256"]);
  EXPECT_THAT(test::read_text(folder / "report.html"), testing::HasSubstr("SIMULATED"));
}

constexpr const char* kLongest = "size_by_eye_and_hand";

// Experiments that their definitions state whole: what virtual participants were estimated to be.
TEST(ResultsTest, EstimatesOfOwnExperimentsReproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "whole studies take too long here; other builds make them anew";
  }
  int studies = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / "results")) {
    if (fs::exists(entry.path() / "estimates.csv") && entry.path().filename() != kLongest) {
      expect_the_same(entry.path());
      ++studies;
    }
  }
  EXPECT_GE(studies, 7);
}

TEST(ResultsTest, EstimatesOfTheLongestReproduce) {
  if (std::getenv("HAPTRIAL_EVERY_STUDY") == nullptr) {
    GTEST_SKIP() << "8,568 trials take minutes; set HAPTRIAL_EVERY_STUDY=1 to make them anew";
  }
  expect_the_same(fs::path(HAPTRIAL_SOURCE_DIR) / "results" / kLongest);
}

}  // namespace
}  // namespace haptrial
