// The trial of a virtual participant in a preview is that of a dry run with the same seed.

#include "experiments/preview/virtual_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/preview/preview.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/study_run.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

class VirtualTrialTest : public testing::TestWithParam<const char*> {};

TEST_P(VirtualTrialTest, IsThatOfADryRun) {
  const Experiment experiment =
      load_experiment(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments" / GetParam());
  const protocols::Protocol& protocol = experiment.study->protocol();
  const VirtualTrial trial =
      virtual_trial(protocol, *experiment.definition, previewed_session(1), 1, 60.0);
  ASSERT_TRUE(trial.completed) << trial.why;
  const test::TemporaryFolder folder;
  DryRun dry;
  dry.participants = 1;
  dry.max_trials = 1;
  dry.folder = folder / "dry";
  run_dry(protocol, *experiment.definition, dry);
  const record::SessionReader file(dry.folder / "S01.h5");
  const record::PassRow first = file.passes().front();
  const auto samples = file.samples(first.first_sample, first.last_sample - first.first_sample + 1);
  ASSERT_GE(trial.times.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_LT((samples[i].position - trial.positions[i]).norm(), 1e-6) << i;
    ASSERT_LT((samples[i].force - trial.forces[i]).norm(), 1e-3) << i;
  }
  std::vector<std::string> recorded, shown;
  for (const record::StageRow& row : file.rows<record::StageRow>()) {
    if (row.pass == 0) {
      recorded.push_back(row.stage);
    }
  }
  for (const VirtualStage& stage : trial.stages) {
    shown.push_back(stage.name);
  }
  if (!recorded.empty()) {  // else the samples have them (ForcePreviewTest)
    EXPECT_EQ(recorded, shown);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, VirtualTrialTest,
                         testing::Values("stiffness_discrimination.toml", "curl_field.toml",
                                         "size_by_eye_and_hand.toml", "force_training.toml"));

TEST(PreviewPageTest, NeedsNothingElseAndSaysWhatIsSimulated) {
  const Experiment experiment =
      load_experiment(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/curl_field.toml");
  const std::string page = preview_of(experiment, {}).html();
  for (const char* part : {"<title>SIMULATED: Preview of curl_field", "One trial, stage by stage",
                           "What the participant sees", "What is felt", "Trials of the study",
                           "SIMULATED: nobody did this trial", "lang=\"en\"", "13"}) {
    EXPECT_THAT(page, testing::HasSubstr(part));
  }
  for (const char* outside : {"<script src", "src=\"http", "href=\"http", "@import", "url(http"}) {
    EXPECT_THAT(page, testing::Not(testing::HasSubstr(outside)));
  }
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = page.find("<svg", at)) != std::string::npos; ++at) {
    EXPECT_EQ(at, page.find("<svg role=\"img\" aria-label=\"", at)) << "a picture without words";
    ++pictures;
  }
  EXPECT_GT(pictures, 6U);
}

TEST(PreviewPageTest, WhatADefinitionSaysIsText) {
  std::string name = "<script>alert(1)</script>";
  Preview preview;
  preview.document.heading(name);
  analysis::Figure figure;
  figure.name = "a";
  figure.title = name;
  preview.add(figure, "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>");
  EXPECT_THAT(preview.html(), testing::Not(testing::HasSubstr("<script>")));
}

TEST(PreviewPageTest, ATrialBeyondTheSessionGetsASentence) {
  const Experiment experiment =
      load_experiment(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/curl_field.toml");
  EXPECT_THROW(preview_of(experiment, {.trial = 321}), InputError);
}

}  // namespace
}  // namespace haptrial::experiments
