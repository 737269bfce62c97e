// Files in results/ are those that the program gives.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
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

bool every_study() { return std::getenv("HAPTRIAL_EVERY_STUDY") != nullptr; }

/// Runs the commands of a manifest again.
class Results : public testing::TestWithParam<fs::path> {
 protected:
  /// @param people  how many of the study's first participants; they do not depend on those after
  /// them
  ///   them; 0, and with HAPTRIAL_EVERY_STUDY set: all
  void make_again(int people = 0) {
    people_ = every_study() ? 0 : people;
    std::string script = "set -e; cd '" + kSource.string() + "'\n";
    for (const std::string command : manifest_["commands"]) {
      script += replaced(for_few(command), " OUT", " '" + (out_ / "study").string() + "'") + "\n";
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
    EXPECT_EQ(without_versions(test::read_text(out_ / "study" / name)),
              without_versions(test::read_text(folder_ / name)))
        << name << " is not what the manifest gives; results/regenerate.sh makes it anew";
  }
  /// A table whose rows begin with a participant: the rows of those who were made again.
  void expect_the_same_rows(const std::string& name) const {
    std::istringstream kept(test::read_text(folder_ / name));
    std::string rows;
    for (std::string line; std::getline(kept, line);) {
      const bool head = rows.empty();
      if (head || people_ == 0 || std::stoi(line.substr(1)) <= people_) {  // S01,...
        rows += line + "\n";
      }
    }
    EXPECT_EQ(test::read_text(out_ / "study" / name), rows)
        << name << " is not what the manifest gives; results/regenerate.sh makes it anew";
  }
  const fs::path folder_ = GetParam();
  const nlohmann::json manifest_ =
      nlohmann::json::parse(test::read_text(folder_ / "manifest.json"));
  const test::TemporaryFolder out_;
  int people_{0};  // made again; 0: all

 private:
  /// The numbers are the same, whichever commit made them.
  static std::string without_versions(const std::string& text) {
    static const std::regex versions("haptrial [0-9.]+ \\([0-9a-f]+\\)");
    return std::regex_replace(text, versions, "haptrial");
  }
  std::string for_few(std::string command) const {
    if (people_ == 0 || !command.starts_with("haptrial dry-run")) {
      return command;
    }
    command = std::regex_replace(command, std::regex(" --subjects [0-9]+"), "");
    return command + " --subjects " + std::to_string(people_);
  }
};

/// Studies of force curves.
class ScoredResults : public Results {};

TEST_P(ScoredResults, Reproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "whole studies take too long under a sanitizer";
  }
  ASSERT_NO_FATAL_FAILURE(make_again(3));
  expect_the_same_rows("scores.csv");
  EXPECT_EQ(sum_of(folder_ / "scores.csv"), manifest_["scores_sha256"]);
  EXPECT_TRUE(manifest_["simulated"].get<bool>());
  EXPECT_FALSE(fs::exists(folder_ / "S01.h5")) << "session files stay out";
}

INSTANTIATE_TEST_SUITE_P(Shipped, ScoredResults, testing::ValuesIn(results_with("scores.csv")),
                         study_of);

/// Comparison of two kept studies, from their kept files.
TEST(ComparedResults, Reproduce) {
  const std::vector<fs::path> compared = results_with("comparison.json");
  ASSERT_EQ(compared.size(), 1u);
  const test::TemporaryFolder out;
  const auto run = test::run_command(
      "cd '" + (kSource / "results").string() + "' && haptrial compare force_training " +
      compared.front().filename().string() + " --out '" + (out / "compared").string() + "'");
  ASSERT_EQ(run.status, 0) << run.errors;
  for (const char* name : {"comparison.json", "comparison.html", "comparison.svg"}) {
    if (fs::exists(compared.front() / name)) {
      EXPECT_EQ(test::read_text(out / "compared" / name), test::read_text(compared.front() / name))
          << name;
    }
  }
}

/// Experiments that their definitions state whole: what virtual participants were estimated to be.
class EstimatedResults : public Results {};

TEST_P(EstimatedResults, Reproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "whole studies take too long under a sanitizer";
  }
  const bool long_one =
      folder_.filename() == "size_by_eye_and_hand" || folder_.filename() == "lump_search";
  if (long_one && !every_study()) {
    GTEST_SKIP() << "its trials take minutes; set HAPTRIAL_EVERY_STUDY=1 to make them anew";
  }
  const std::string estimates = test::read_text(folder_ / "estimates.csv");
  const bool of_people = std::count(estimates.begin(), estimates.end(), '\n') > 1;
  ASSERT_NO_FATAL_FAILURE(make_again(of_people ? 2 : 0));
  expect_the_same_rows("estimates.csv");
  if (!of_people) {  // reaching movements: all is in the results of the group
    expect_the_same("results.json");
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, EstimatedResults,
                         testing::ValuesIn(results_with("estimates.csv")), study_of);

/// The source's tables on a simulated duck.
class ContactResults : public Results {};

TEST_P(ContactResults, Reproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "renderings take too long under a sanitizer";
  }
  ASSERT_NO_FATAL_FAILURE(make_again());
  for (const char* name :
       {"table-4.csv", "table-5.csv", "table-6.csv", "failures.csv", "operations.csv"}) {
    expect_the_same(name);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, ContactResults, testing::ValuesIn(results_with("table-6.csv")),
                         study_of);

/// Power by simulation: what does not depend on full sessions.
class PowerResults : public Results {};

TEST_P(PowerResults, Reproduce) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "thousands of studies take too long under a sanitizer";
  }
  const std::string question = "docs/worked/power/" +
                               folder_.filename().string().substr(std::string("power_").size()) +
                               ".toml";
  EXPECT_EQ(sum_of(kSource / question), manifest_["question_sha256"]);
  EXPECT_EQ(sum_of(folder_ / "power.csv"), manifest_["power_sha256"]);
  if (!every_study()) {
    GTEST_SKIP() << "it takes minutes; set HAPTRIAL_EVERY_STUDY=1 to make it anew";
  }
  ASSERT_NO_FATAL_FAILURE(make_again());
  expect_the_same("power.csv");
}

INSTANTIATE_TEST_SUITE_P(Shipped, PowerResults, testing::ValuesIn(results_with("power.csv")),
                         study_of);

/// A row of a table whose texts may be quoted.
std::vector<std::string> fields_of(const std::string& row) {
  std::vector<std::string> fields{""};
  bool quoted = false;
  for (const char c : row) {
    quoted = quoted != (c == '"');
    if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '"') {
      fields.back() += c;
    }
  }
  return fields;
}

/// Whether the tests of shipped reports keep their level; the guide names those that do not.
TEST(NullResults, AreOfTheShippedQuestionsAndInTheGuide) {
  const fs::path folder = kSource / "results/power_null";
  const auto manifest = nlohmann::json::parse(test::read_text(folder / "manifest.json"));
  EXPECT_EQ(sum_of(folder / "null.csv"), manifest["null_sha256"]);
  const auto questions =
      test::run_command("cat '" + kSource.string() + "'/docs/worked/power/null/*.toml | sha256sum");
  EXPECT_EQ(questions.output.substr(0, 64), manifest["questions_sha256"]);
  const std::string guide = test::read_text(kSource / "docs/guide-power.md");
  std::istringstream rows(test::read_text(folder / "null.csv"));
  std::string row;
  std::getline(rows, row);
  int tests = 0;
  for (; std::getline(rows, row); ++tests) {
    // definition, participants, test, made, rejected, share, band_low, band_high, keeps_level
    const std::vector<std::string> fields = fields_of(row);
    ASSERT_EQ(fields.size(), 9u) << row;
    EXPECT_GE(std::stoi(fields[3]), 1850) << row;
    if (fields[8] == "no") {
      EXPECT_NE(guide.find(fields[2] + " | " + fields[4] + " |"), std::string::npos) << row;
    }
  }
  EXPECT_EQ(tests, 4 * 2 + 2 * 26);
}

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
  std::istringstream shipped(test::read_text(kSource / "results/calibration/gear.csv"));
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
  for (const char* name : {"gear.toml", "cube.toml", "gear.ply", "summary.csv", "scan.csv"}) {
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
