// Every shipped definition has every part of a preview, whatever its protocol; films and views to
// turn have the data of the trial.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/preview/film.h"
#include "experiments/preview/preview.h"
#include "experiments/preview/virtual_trial.h"
#include "experiments/studies/experiment.h"
#include "protocols/force_training/guided_passes.h"

namespace haptrial::experiments::preview_kinds_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::HasSubstr;
using testing::Not;

Experiment shipped(const std::string& name) {
  return load_experiment(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments" / name);
}

class PreviewKindsTest : public testing::TestWithParam<const char*> {};

TEST_P(PreviewKindsTest, HaveEveryPart) {
  const Experiment experiment = shipped(GetParam());
  const std::string page = preview_of(experiment, {}).html();
  for (const char* part : {">Checks<", ">One trial, stage by stage<", ">What the participant sees<",
                           ">What is felt<", ">What the certified device presents<",
                           ">Trials of the study<", ">The trial of a virtual participant<"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_THAT(page, HasSubstr("data:image/png"));
  EXPECT_THAT(page, HasSubstr("<metadata class=\"film\">"));
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  }
  EXPECT_THROW(preview_of(experiment, {.trial = 100'000}), InputError);
}

INSTANTIATE_TEST_SUITE_P(Shipped, PreviewKindsTest,
                         testing::Values("force_training.toml", "force_training_curve.toml",
                                         "tutoring_study.toml", "first_drilling.toml",
                                         "shape_recognition.toml"));

TEST(PreviewWordsTest, HeadingsAreGermanAndSaySo) {
  const Experiment experiment = shipped("wall_detection.toml");
  PreviewRequest request;
  request.language = "de";
  const std::string page = preview_of(experiment, request).html();
  EXPECT_THAT(page, HasSubstr("<span lang=\"de\">Was zu fühlen ist</span></h2>"));
  EXPECT_THAT(page, HasSubstr("Abspielen"));
  for (const char* english : {">What is felt</h2>", ">Checks</h2>", ">Trials of the study</h2>"}) {
    EXPECT_THAT(page, Not(HasSubstr(english)));
  }
}

/// The data that a picture carries for the page's script.
nlohmann::json data_in(std::string svg, const std::string& name) {
  const std::string opening = "<metadata class=\"" + name + "\">";
  const auto begin = svg.find(opening) + opening.size();
  std::string text = svg.substr(begin, svg.find("</metadata>") - begin);
  for (auto at = text.find("&quot;"); at != text.npos; at = text.find("&quot;", at)) {
    text.replace(at, 6, "\"");
  }
  return nlohmann::json::parse(text);
}

TEST(FilmTest, HasTheSamplesOfTheTrial) {
  VirtualTrial trial;
  for (int i = 0; i < 100; ++i) {
    trial.times.push_back(1e-3 * i);
    trial.positions.emplace_back(1e-3 * i, -1e-4 * i, 0.0);
    trial.velocities.emplace_back(Vector3d::Zero());
    trial.forces.emplace_back(0.0, i == 70 ? 5.0 : 1.0, 0.0);
  }
  trial.stages = {{"wait <here>", 1, 0.0, 0.05}, {"press", 1, 0.05, 0.1}};
  const std::string svg =
      film_svg(trial, {{"floor", 0, {{Vector3d(-0.01, 0.0, 0.0), Vector3d(0.01, 0.0, 0.0)}}}});
  EXPECT_THAT(svg, HasSubstr("0.07 s, press: 5.00 N"));
  EXPECT_THAT(svg, Not(HasSubstr("<here>")));
  const nlohmann::json data = data_in(svg, "film");
  const auto frames = data["frames"].get<std::vector<double>>();
  ASSERT_EQ(700u, frames.size());
  for (std::size_t i = 0; i < trial.times.size(); ++i) {
    EXPECT_NEAR(trial.times[i], frames[7 * i], 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = 7 * i + 1 + static_cast<std::size_t>(axis);
      EXPECT_NEAR(trial.positions[i][axis], frames[at], 0.6e-5);
      EXPECT_NEAR(trial.forces[i][axis], frames[at + 3], 0.6e-3);
    }
  }
  EXPECT_EQ("press", data["stages"][1]["name"]);
  EXPECT_EQ(0.07, data["begin"]);
}

TEST(SpaceObjectsTest, AMeshIsThinnedAndAShapeHasItsSize) {
  const auto edges =
      lines_of(scene::Shape(scene::Box{Vector3d(0.01, 0.0, 0.0), {0.02, 0.04, 0.06}}));
  ASSERT_EQ(12u, edges.size());
  double length = 0.0;
  for (const auto& [from, to] : edges) {
    length += (to - from).norm();
  }
  EXPECT_NEAR(4.0 * (0.02 + 0.04 + 0.06), length, 1e-12);
  for (const auto& [from, to] :
       lines_of(scene::Shape(scene::Sphere{Vector3d(0.0, 0.01, 0.0), 0.02}))) {
    EXPECT_NEAR(0.02, (from - Vector3d(0.0, 0.01, 0.0)).norm(), 1e-12);
  }
  geometry::Mesh sheet;  // 60 x 60 squares of two triangles
  constexpr int kSide = 61;
  for (int i = 0; i < kSide * kSide; ++i) {
    sheet.vertices.emplace_back(1e-3 * (i % kSide), 0.0, 1e-3 * (i / kSide));
  }
  for (int row = 0; row + 1 < kSide; ++row) {
    for (int column = 0; column + 1 < kSide; ++column) {
      const int a = row * kSide + column;
      sheet.triangles.push_back({a, a + 1, a + kSide});
      sheet.triangles.push_back({a + 1, a + kSide + 1, a + kSide});
    }
  }
  EXPECT_LE(lines_of(sheet, 500).size(), 1500u);
  EXPECT_EQ(3u * 60u * 60u + 120u, lines_of(sheet, 10'000).size());
}

TEST(ForcePreviewTest, StagesAreThoseOfARehearsedTrial) {
  const Experiment experiment = shipped("force_training.toml");
  const auto& d = dynamic_cast<const protocols::ForceDefinition&>(*experiment.definition);
  const protocols::GuidedTrial guided = protocols::guided_trial(d, previewed_session(1), 1);
  const VirtualTrial rehearsed =
      virtual_trial(experiment.study->protocol(), d, previewed_session(1), 1, 60.0);
  ASSERT_TRUE(rehearsed.completed) << rehearsed.why;
  std::vector<std::string> expected, found;
  for (const protocols::GuidedPass& pass : guided.passes) {
    for (const char* stage : {"approach", "wait", "run", "return"}) {
      expected.push_back(std::string(record::name_of(pass.phase)) + ": " + stage);
    }
  }
  for (const VirtualStage& stage : rehearsed.stages) {
    found.push_back(stage.name);
    const bool runs = stage.name.ends_with(": run");
    const auto& pass = guided.passes[stage.name.starts_with("test") ? 1 : 0];
    if (runs) {  // the path's time, whoever follows it
      EXPECT_NEAR(pass.lasts(record::Stage::kRun, d.rate), stage.end - stage.begin, 1.5 / d.rate);
    }
    if (stage.name.ends_with(": wait")) {
      EXPECT_GE(stage.end - stage.begin, pass.lasts(record::Stage::kWait, d.rate) - 1.5 / d.rate);
    }
  }
  EXPECT_EQ(expected, found);
}

}  // namespace
}  // namespace haptrial::experiments::preview_kinds_test
