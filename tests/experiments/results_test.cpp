// What stands in results/ is what the program gives.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

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

const fs::path kSource = HAPTRIAL_SOURCE_DIR;

std::string sum_of(const fs::path& file) {
  return test::run_command("sha256sum < '" + file.string() + "'").output.substr(0, 64);
}

/// The folders of results/ that hold a file.
std::vector<fs::path> results_with(const char* name) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(kSource / "results")) {
    if (fs::exists(entry.path() / name)) {
      folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::string study_of(const testing::TestParamInfo<fs::path>& folder) {
  return folder.param.filename().string();
}

/// Runs the commands of a manifest again.
class Results : public testing::TestWithParam<fs::path> {
 protected:
  void make_again() {
    std::string script = "set -e; cd '" + kSource.string() + "'\n";
    for (const std::string command : manifest_["commands"]) {
      script += replaced(command, " OUT", " '" + (out_ / "study").string() + "'") + "\n";
    }
    const test::CommandResult result = test::run_command(script);
    ASSERT_EQ(result.status, 0) << result.errors;
    if (manifest_.contains("definition_sha256")) {
      const std::string definition = manifest_["study"].get<std::string>() + ".toml";
      EXPECT_EQ(sum_of(kSource / "experiments" / definition), manifest_["definition_sha256"]);
    }
    EXPECT_THAT(test::read_text(folder_ / "report.html"), testing::HasSubstr("SIMULATED"));
  }
  void expect_the_same(const std::string& name) const {
    EXPECT_EQ(test::read_text(out_ / "study" / name), test::read_text(folder_ / name))
        << name << " is not what the manifest gives; results/regenerate.sh makes it anew";
  }
  const fs::path folder_ = GetParam();
  const nlohmann::json manifest_ =
      nlohmann::json::parse(test::read_text(folder_ / "manifest.json"));
  const test::TemporaryFolder out_;
};

/// Studies of force curves.
class ScoredResults : public Results {};

TEST_P(ScoredResults, Reproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "whole studies take too long here; other builds make them anew";
  }
  ASSERT_NO_FATAL_FAILURE(make_again());
  expect_the_same("scores.csv");
  for (const char* name : {"comparison.json", "comparison.html", "comparison.svg"}) {
    if (fs::exists(folder_ / name)) {
      expect_the_same(name);
    }
  }
  EXPECT_EQ(sum_of(folder_ / "scores.csv"), manifest_["scores_sha256"]);
  EXPECT_TRUE(manifest_["simulated"].get<bool>());
  EXPECT_FALSE(fs::exists(folder_ / "S01.h5")) << "session files stay out";
}

INSTANTIATE_TEST_SUITE_P(Shipped, ScoredResults, testing::ValuesIn(results_with("scores.csv")),
                         study_of);

/// Experiments that their definitions state whole: what virtual participants were estimated to be.
class EstimatedResults : public Results {};

TEST_P(EstimatedResults, Reproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "whole studies take too long here; other builds make them anew";
  }
  const bool long_one =
      folder_.filename() == "size_by_eye_and_hand" || folder_.filename() == "lump_search";
  if (long_one && std::getenv("HAPTRIAL_EVERY_STUDY") == nullptr) {
    GTEST_SKIP() << "its trials take minutes; set HAPTRIAL_EVERY_STUDY=1 to make them anew";
  }
  ASSERT_NO_FATAL_FAILURE(make_again());
  expect_the_same("estimates.csv");
}

INSTANTIATE_TEST_SUITE_P(Shipped, EstimatedResults,
                         testing::ValuesIn(results_with("estimates.csv")), study_of);

/// The source's tables on a simulated duck.
class ContactResults : public Results {};

TEST_P(ContactResults, Reproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "renderings take too long here; other builds make them anew";
  }
  ASSERT_NO_FATAL_FAILURE(make_again());
  for (const char* name :
       {"table-4.csv", "table-5.csv", "table-6.csv", "operations.csv", "failures.csv"}) {
    expect_the_same(name);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, ContactResults, testing::ValuesIn(results_with("table-6.csv")),
                         study_of);

/// Springs calibrated to elements: the first evaluations of the shortest search.
TEST(CalibrationResults, BeginAsTheyAreShipped) {
  constexpr std::size_t kRows = 12;
  constexpr double kSame = 1e-3;  // relative: libraries round in their own ways
  const test::TemporaryFolder out;
  const std::string folder = (out / "run").string();
  const auto run = test::run_command("cd '" + kSource.string() +
                                     "'\nhaptrial deform calibrate results/calibration/gear.toml "
                                     "--evaluations 12 --out '" +
                                     folder + "'");
  ASSERT_EQ(run.status, 0) << run.errors;
  std::istringstream found(test::read_text(folder + "/evaluations.csv"));
  std::istringstream shipped(test::read_text(kSource / "results/calibration/gear-descent.csv"));
  std::string a, b;
  for (std::size_t row = 0; row <= kRows; ++row) {
    ASSERT_TRUE(std::getline(found, a) && std::getline(shipped, b)) << row;
    if (row > 0) {  // evaluation, error, ...
      const double expected = std::stod(b.substr(b.find(',') + 1));
      EXPECT_NEAR(std::stod(a.substr(a.find(',') + 1)), expected, kSame * expected) << row;
    }
  }
  const auto manifest =
      nlohmann::json::parse(test::read_text(kSource / "results/calibration/manifest.json"));
  for (const char* name : {"gear.toml", "cube.toml", "gear.ply", "summary.csv"}) {
    EXPECT_EQ(sum_of(kSource / "results/calibration" / name), manifest["sha256"][name]) << name;
  }
}

TEST(ResultsTest, EveryStudyIsThere) {
  EXPECT_EQ(results_with("table-6.csv").size(), 1u);
  EXPECT_GE(results_with("scores.csv").size(), 2u);
  EXPECT_EQ(results_with("estimates.csv").size(), 9u);
  EXPECT_EQ(results_with("comparison.json").size(), 1u);
}

}  // namespace
}  // namespace haptrial
