// A study of reaches in a curl field, small, by virtual participants whose adaptation is known: the
// whole way from the definition to the report.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/files/csv.h"
#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  ASSERT_NE(text.find(from), std::string::npos) << from;
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// Analysed sessions of six participants, three in the field of each direction.
class ReachingStudyTest : public testing::Test {
 protected:
  void run(bool field, const std::string& more = "") {
    std::string text = file_text(HAPTRIAL_SOURCE_DIR "/experiments/curl_field.toml");
    replace_all(text, "participants = 16", "participants = 6");
    replace_all(text, "clockwise = 8", "clockwise = 3");
    replace_all(text, "trials = 64", "trials = 32");
    replace_all(text, "trials = 192", "trials = 96");
    text += more;
    if (!field) {
      replace_all(text, "field = \"curl\"", "field = \"none\"");
    }
    test::write_text(folder_ / "study.toml", text);
    const std::string place = (folder_ / "sessions").string();
    const auto done =
        test::run_command("haptrial dry-run " + (folder_ / "study.toml").string() +
                          " --subjects 6 --out " + place + " && haptrial analyze " + place);
    ASSERT_EQ(done.status, 0) << done.errors;
    said_ = done.output;
    reaching_ = json::parse(file_text(folder_ / "sessions" / "results.json")).at("reaching");
  }
  fs::path report(const char* name) const { return folder_ / "sessions" / name; }

  json contrast(const std::string& name) const {
    for (const json& each : reaching_.at("contrasts")) {
      if (each.at("name") == name) {
        return each;
      }
    }
    ADD_FAILURE() << name;
    return {};
  }
  double difference(const std::string& name) const {
    return contrast(name).at("test").at("difference").get<double>();
  }
  /// Means of the learning curve, by cycle.
  std::map<int, double> curve(const char* name) const {
    std::map<int, double> means;
    for (const json& point : reaching_.at(name)) {
      means[point.at("cycle").get<int>()] = point.at("mean").get<double>();
    }
    return means;
  }

  /// Every reach is a row, and every picture is in the report.
  void expect_report() const {
    const analysis::CsvTable rows = analysis::CsvTable::load(report("reaches.csv"));
    EXPECT_EQ(rows.rows(), 6u * 160u);
    const std::string markdown = file_text(report("report.md"));
    for (const char* picture :
         {"learning-curve.svg", "force-compensation.svg", "speed-profiles.svg",
          "trajectories-adaptation--first-cycle-.svg", "trajectories-washout--first-cycle-.svg"}) {
      EXPECT_TRUE(fs::exists(report(picture))) << picture;
      EXPECT_THAT(markdown, HasSubstr(picture));
    }
    EXPECT_THAT(markdown, testing::Not(HasSubstr("nan")));
    EXPECT_THAT(markdown, HasSubstr("at the force limit"));
  }

  test::TemporaryFolder folder_;
  std::string said_;
  json reaching_;
};

TEST_F(ReachingStudyTest, AdaptationIsFoundAndItsAftereffectHasTheOppositeSign) {
  ASSERT_NO_FATAL_FAILURE(run(true));
  const std::map<int, double> error = curve("learning_curve");
  ASSERT_EQ(error.size(), 20u) << "4, 12 and 4 cycles of eight trials";
  const double first = error.at(5), last = error.at(16), after = error.at(17);
  const double before =
      reaching_.at("blocks").at(0).at("means").at("maximum_perpendicular_error_m").at("mean");
  EXPECT_LT(std::abs(before), 0.2 * first) << "straight before the field";
  EXPECT_GT(first, 0.005) << "the field pushes to +, whichever way it turns";
  EXPECT_LT(last, 0.75 * first) << "the error falls";
  EXPECT_LT(after, 0.0) << "what was learnt pushes to the other side without the field";
  EXPECT_GT(error.at(20), after) << "until it is forgotten";
  for (const auto& [cycle, mean] : curve("catch_trials")) {
    EXPECT_TRUE(cycle <= 5 || mean < 0.0) << "catch trials show it at once, cycle " << cycle;
  }
  EXPECT_LT(contrast("adaptation: first cycle against its last").at("p_holm").get<double>(), 0.05);
  EXPECT_LT(difference("washout: first cycle against the last of baseline"), 0.0);
  EXPECT_LT(
      contrast("washout: first cycle against 0").at("test").at("difference_high_95").get<double>(),
      0.0);
  EXPECT_THAT(said_, HasSubstr("washout: first cycle against 0"));
  expect_report();
}

TEST_F(ReachingStudyTest, PlannedTestsOfTheDefinitionStandInTheReport) {
  ASSERT_NO_FATAL_FAILURE(
      run(true,
          "\nby = [\"group\", \"block\"]\ntests = [\"washout < adaptation\", \"clockwise != "
          "counterclockwise\"]\nquantities = [\"error\", \"force_compensation\"]\n"
          "cycles = \"first\"\n"));
  const json results = json::parse(file_text(report("results.json")));
  const json& error = results.at("quantities").at(0);
  EXPECT_EQ(error.at("name"), "error");
  EXPECT_EQ(error.at("conditions").size(), 6u) << "two groups, three blocks";
  const std::string tests = error.at("tests").dump();
  EXPECT_THAT(tests, HasSubstr("washout"));
  const std::string text = file_text(report("report.md"));
  EXPECT_THAT(text, HasSubstr("Reaches by condition (simulated)"));
  EXPECT_THAT(text, HasSubstr("| washout &lt; adaptation | 6 pairs |"));
  EXPECT_THAT(text, HasSubstr("| clockwise and counterclockwise | 3 and 3 |"));
  EXPECT_THAT(text, HasSubstr("over its reaches without a probe in the first cycle"));
}

constexpr const char* kPingPong = R"(
[experiment]
protocol = "trials"
name = "ping_pong"
[design]
participants = 2
[factors]
distance = [0.03, 0.06]
[variables]
side = "rint($trial / 2) * 2 == $trial ? 1 : -1"
light = "$side > 0 ? 'right' : 'left'"
[places]
start = ["-$side * $distance / 2", 0.0, 0.0]
target = ["$side * $distance / 2", 0.0, 0.0]
[fields.back]
type = "minimum_jerk"
to = "$start"
duration = 0.6
stiffness = 300.0
damping = 20.0
[regions.start]
type = "sphere"
centre = "$start"
radius = 0.008
[regions.target]
type = "sphere"
centre = "$target"
radius = 0.008
[[stages]]
name = "back"
fields = ["back"]
show = ["start", "hand"]
until = { inside = "start", for = 0.3 }
timeout = { after = 5.0, then = "abort" }
[[stages]]
name = "reach"
show = ["target", "hand"]
onset = { speed_above = 0.03 }
until = { inside = "target", speed_below = 0.05, for = 0.1 }
timeout = { after = 3.0, then = "go on" }
[[blocks]]
name = "all"
trials = 12
[observer]
senses = "extent"
[observer.actions]
back = { do = "rest" }
reach = { do = "reach", duration = 0.5 }
[analysis]
kind = "reaching"
by = ["light"]
)";

TEST_F(ReachingStudyTest, PlacesThatDependOnTheTrialAreThoseOfEachTrial) {
  test::write_text(folder_ / "study.toml", kPingPong);
  const std::string place = (folder_ / "sessions").string();
  const auto done = test::run_command("haptrial dry-run " + (folder_ / "study.toml").string() +
                                      " --out " + place + " && haptrial analyze " + place);
  ASSERT_EQ(done.status, 0) << done.errors;
  const analysis::CsvTable rows = analysis::CsvTable::load(report("reaches.csv"));
  ASSERT_EQ(rows.rows(), 24u);
  const std::vector<double> trial = rows.numbers(rows.column("trial"));
  const std::vector<double> start = rows.numbers(rows.column("start_x_m"));
  const std::vector<double> error = rows.numbers(rows.column("endpoint_error_m"));
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    EXPECT_EQ(start[i] < 0.0, static_cast<int>(trial[i]) % 2 == 0) << trial[i];
    EXPECT_LT(error[i], 0.01) << trial[i];
  }
  const json results = json::parse(file_text(report("results.json")));
  EXPECT_EQ(results.at("quantities").at(0).at("conditions").size(), 2u) << "left and right";
}

/// The field of a baseline may be the later one with numbers of zero.
TEST_F(ReachingStudyTest, AFieldOfZerosIsNotTheOneThatIsLearnt) {
  std::string text = kPingPong;
  const auto put = [&text](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  put("[regions.start]",
      "[fields.curl]\ntype = \"matrix_viscous\"\nvelocity_filter = 30.0\n"
      "matrix = [[0.0, 0.0, \"$b\"], [0.0, 0.0, 0.0], [\"-$b\", 0.0, 0.0]]\n[regions.start]");
  put("name = \"reach\"\n", "name = \"reach\"\nfields = [\"curl\"]\n");
  put("name = \"all\"\ntrials = 12\n",
      "name = \"before\"\ntrials = 6\nb = 0.0\n[[blocks]]\nname = \"in\"\ntrials = 6\nb = 8.0\n"
      "[[blocks]]\nname = \"opposite\"\ntrials = 6\nb = -8.0\n");
  test::write_text(folder_ / "study.toml", text);
  const std::string place = (folder_ / "sessions").string();
  const auto done = test::run_command("haptrial dry-run " + (folder_ / "study.toml").string() +
                                      " --out " + place + " && haptrial analyze " + place);
  ASSERT_EQ(done.status, 0) << done.errors;
  const json results = json::parse(file_text(report("results.json")));
  const json& blocks = results.at("reaching").at("blocks");
  EXPECT_DOUBLE_EQ(blocks.at(0).at("perturbation").get<double>(), 0.0);
  EXPECT_DOUBLE_EQ(blocks.at(1).at("perturbation").get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(blocks.at(2).at("perturbation").get<double>(), -1.0);
}

TEST_F(ReachingStudyTest, WithoutAFieldNothingIsFound) {
  ASSERT_NO_FATAL_FAILURE(run(false));
  for (const json& each : reaching_.at("contrasts")) {
    if (each.contains("p_holm")) {
      EXPECT_GT(each.at("p_holm").get<double>(), 0.05) << each.at("name");
    }
  }
  for (const json& block : reaching_.at("blocks")) {
    EXPECT_TRUE(block.at("exponential").contains("not_defined")) << block.at("block");
  }
  EXPECT_TRUE(reaching_.at("two_rate").contains("not_defined"));
}

}  // namespace
}  // namespace haptrial::experiments
