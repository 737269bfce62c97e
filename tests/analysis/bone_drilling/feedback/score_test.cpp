// A score for the next trainee: its interval, its parts, and when it is refused.

#include "analysis/bone_drilling/feedback/score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/analysis/bone_drilling/hand_made.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::drilling::score_test {
namespace {

using testing::HasSubstr;

const std::map<std::string, std::string> kRules{{"cavity", "none"}, {"time limit", "60 s"}};

/// Rated people whose metrics and ratings follow a known law; ratings are not bounded.
class SimulatedStudy {
 public:
  explicit SimulatedStudy(std::uint64_t seed)
      : random_(seed, "score"),
        bone_(std::make_shared<const bone::BoneModel>(test::block(3, 3, 3))) {}

  /// Procedures of one person.
  std::vector<RatedSummary> person(const std::string& name, int procedures) {
    const double skill = random_.normal();
    const double liked = 0.25 * random_.normal();  // by raters, whatever the metrics say
    std::vector<RatedSummary> rated;
    for (int n = 1; n <= procedures; ++n) {
      RatedSummary each;
      each.summary.participant = name;
      each.summary.number = n;
      each.summary.bone = bone_;
      each.summary.values.resize(metric_kinds().size());
      double own = skill + 0.4 * random_.normal();
      for (std::size_t m = 0; m < kMetrics; ++m) {
        each.summary.values[m == 3 ? 6 : m] = static_cast<double>(m) + 0.5 * own + random_.normal();
      }
      each.rating = 3.0 + 0.6 * own + liked + 0.3 * random_.normal();
      rated.push_back(std::move(each));
    }
    return rated;
  }

  ScoreModel learned(int people) {
    std::vector<RatedSummary> study;
    for (int n = 0; n < people; ++n) {
      for (RatedSummary& each : person("P" + std::to_string(n), 2)) {
        study.push_back(std::move(each));
      }
    }
    ScoreModel model = *learn_score(study);
    model.bones = {bone_digest(*bone_)};
    model.rules = kRules;
    return model;
  }

 private:
  static constexpr std::size_t kMetrics = 5;
  RandomStream random_;
  std::shared_ptr<const bone::BoneModel> bone_;
};

TEST(ScoreTest, TheIntervalHoldsTheRatingOfTheNextTrainee) {
  constexpr int kStudies = 1000;
  int held = 0;
  for (int n = 0; n < kStudies; ++n) {
    SimulatedStudy study(static_cast<std::uint64_t>(n) + 1);
    const ScoreModel model = study.learned(15);
    const RatedSummary next = study.person("next", 1).front();
    // The score itself is kept within the raters' scale, the law is not.
    double score = model.intercept;
    const Defined<Score> given = score_of(model, next.summary, kRules);
    for (const ScorePart& part : given->parts) {
      score += part.points;
    }
    held += std::abs(next.rating - score) <= model.half_width ? 1 : 0;
  }
  RecordProperty("held", held);
  EXPECT_GE(held, 930);
  EXPECT_LE(held, 970);
}

TEST(ScoreTest, PartsAddUpAndTheWorstComesFirst) {
  SimulatedStudy study(7);
  const ScoreModel model = study.learned(12);
  const Score score = *score_of(model, study.person("next", 1).front().summary, kRules);
  double sum = model.intercept;
  for (const ScorePart& part : score.parts) {
    sum += part.points;
  }
  EXPECT_NEAR(score.value, std::clamp(sum, 1.0, 5.0), 1e-12);
  EXPECT_TRUE(std::is_sorted(score.parts.begin(), score.parts.end(),
                             [](const auto& a, const auto& b) { return a.points < b.points; }));
  EXPECT_THAT(score_section(model, score), HasSubstr("points of 5, 95 % interval"));
}

TEST(ScoreTest, AnotherCaseIsRefusedInASentence) {
  SimulatedStudy study(7);
  ScoreModel model = study.learned(12);
  RatedSummary next = study.person("next", 1).front();
  const auto refusal = [&](const std::map<std::string, std::string>& rules) {
    const auto score = score_of(model, next.summary, rules);
    EXPECT_THAT(score_section(model, score), HasSubstr("There is no score"));
    return score ? std::string() : std::string(score.because());
  };
  EXPECT_EQ(refusal({{"cavity", "none"}, {"time limit", "90 s"}}),
            "it was learned with another time limit (60 s; here 90 s)");
  std::map<std::string, std::string> more = kRules;
  more["forbidden.margin"] = "0.001";
  EXPECT_EQ(refusal(more), "it was learned with another forbidden.margin (none; here 0.001)");
  ++model.version;
  EXPECT_THAT(refusal(kRules), HasSubstr("its metrics are of version"));
  --model.version;
  next.summary.values[0] = std::nullopt;
  EXPECT_EQ(refusal(kRules), "this procedure has no value of \"share of voxels removed in sight\"");
  next.summary.values[0] = 0.5;
  next.summary.bone = std::make_shared<const bone::BoneModel>(test::block(3, 3, 4));
  EXPECT_EQ(refusal(kRules), "it was learned on another bone");
  bone::BoneModel soft = test::block(3, 3, 4), soft_structure = soft;
  soft.density.assign(soft.labels.size(), 0.5F);
  soft_structure.structures.at(1).hardness *= 0.5;
  const std::set<std::string> digests{bone_digest(test::block(3, 3, 4)), bone_digest(soft),
                                      bone_digest(soft_structure)};
  EXPECT_EQ(digests.size(), 3u) << "the same labels, another bone";
}

TEST(ScoreTest, AMetricThatDiffersByRoundingAloneTeachesNothing) {
  SimulatedStudy study(7);
  const auto kinds = metric_kinds();
  const auto at = std::find_if(kinds.begin(), kinds.end(),
                               [](const MetricKind& k) { return k.name == "burr_diameter"; });
  const auto diameter = static_cast<std::size_t>(at - kinds.begin());
  std::vector<RatedSummary> rated;
  for (int n = 0; n < 12; ++n) {
    for (RatedSummary& each : study.person("P" + std::to_string(n), 2)) {
      each.summary.values[diameter] = std::nextafter(6.0, rated.size() % 3 == 0 ? 7.0 : 5.0);
      rated.push_back(std::move(each));
    }
  }
  const ScoreModel model = *learn_score(rated);
  EXPECT_TRUE(std::none_of(model.metrics.begin(), model.metrics.end(),
                           [](const ScoreMetric& m) { return m.name == "burr_diameter"; }));
}

TEST(ScoreTest, AFileGivesTheSameScore) {
  SimulatedStudy study(3);
  ScoreModel model = study.learned(12);
  model.study = "a \"study\"";
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "score.json";
  std::ofstream(file) << score_model_text(model);
  const ScoreModel read = read_score_model(file);
  const ProcedureSummary next = study.person("next", 1).front().summary;
  EXPECT_EQ(score_of(read, next, kRules)->value, score_of(model, next, kRules)->value);
  EXPECT_EQ(read.half_width, model.half_width);
  EXPECT_EQ(read.study, model.study);
  for (const char* text : {"", "{}", "{\"kind\": \"haptrial score of drillings\"}", "[1]"}) {
    std::ofstream(file) << text;
    EXPECT_THROW(read_score_model(file), InputError) << text;
  }
}

TEST(ScoreTest, TooFewPeopleGiveNone) {
  SimulatedStudy study(3);
  const auto none = learn_score(study.person("P1", 5));
  ASSERT_FALSE(none);
  EXPECT_THAT(std::string(none.because()), HasSubstr("at least four"));
}

}  // namespace
}  // namespace haptrial::analysis::drilling::score_test
