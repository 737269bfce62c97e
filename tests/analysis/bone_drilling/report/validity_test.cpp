#include "analysis/bone_drilling/report/validity.h"
#include "analysis/bone_drilling/report/validity_study.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "analysis/bone_drilling/report/validity_figures.h"
#include "analysis/bone_drilling/report/validity_json.h"
#include "analysis/bone_drilling/report/validity_report.h"
#include "analysis/bone_drilling/report/validity_summary.h"
#include "analysis/bone_drilling/report/validity_table.h"
#include "analysis/statistics/design/wording.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::drilling::validity_test {
namespace {

using test::message_of;

using testing::HasSubstr;
using testing::Not;

const ValidityPlan kPlan{{"surgeons", "residents", "novices"}, {"surgeons", "residents"}};

struct Study {
  std::vector<ProcedureSummary> procedures;
  std::vector<RegionScores> regions;
  std::vector<Rating> ratings;

  Validity validity() const { return drilling::validity(procedures, regions, ratings, kPlan); }
};

// 4 surgeons, 4 residents, 7 novices, two procedures each. Experts are rated `effect` points
// higher; people differ by `people`, procedures by 0.4 points. The first metric follows the rating
// with some noise, the others are noise.
Study made(std::uint64_t seed, double effect, double people, int raters = 1) {
  RandomStream random(seed, "validity study");
  const std::vector<MetricKind> kinds = metric_kinds();
  Study study;
  for (int person = 0; person < 15; ++person) {
    const double level = people * random.normal();
    for (const int number : {1, 2}) {
      ProcedureSummary p;
      p.session = p.participant = fmt::format("S{:02}", person + 1);
      p.group = person < 4 ? "surgeons" : person < 8 ? "residents" : "novices";
      p.number = number;
      p.simulated = false;
      const double merit = 3.0 + level + (person < 8 ? effect : 0.0) + 0.4 * random.normal();
      for (std::size_t m = 0; m < kinds.size(); ++m) {
        p.values.emplace_back(m == 0 ? merit + 0.3 * random.normal() : random.normal());
      }
      for (int r = 0; r < raters; ++r) {
        const double score = std::clamp(merit + 0.2 * random.normal(), 1.0, 5.0);
        study.ratings.push_back({p.session, number, fmt::format("rater{}", r), score, "", false});
      }
      study.procedures.push_back(std::move(p));
    }
  }
  study.regions.resize(study.procedures.size());
  return study;
}

ValidityResult result_of(const Study& study) {
  return {"A study", study.procedures, {}, "", study.validity(), {}, {}, {}};
}

// Each part is the general procedure on the numbers that belong to it, picked out here by hand.
TEST(ValidityTest, ComparesExpertsWithNovices) {
  const Study study = made(1, 1.2, 0.3);
  const Validity v = study.validity();
  std::vector<double> experts, novices, expert_means, novice_means;
  for (std::size_t i = 0; i < study.ratings.size(); i += 2) {
    const double a = study.ratings[i].score, b = study.ratings[i + 1].score;
    auto& side = i < 16 ? experts : novices;
    side.insert(side.end(), {a, b});
    (i < 16 ? expert_means : novice_means).push_back((a + b) / 2.0);
  }
  const auto pooled = student_t_test(experts, novices, Tail::kGreater);
  EXPECT_EQ(v.rating_contrast.pooled->df, 28.0);
  EXPECT_NEAR(v.rating_contrast.pooled->t, pooled->t, 1e-12);
  EXPECT_NEAR(v.rating_contrast.pooled->p, pooled->p, 1e-15);
  EXPECT_NEAR(v.rating_contrast.means->t,
              welch_t_test(expert_means, novice_means, Tail::kGreater)->t, 1e-12);
  ASSERT_EQ(v.rating_groups.size(), 5u);
  EXPECT_EQ(v.rating_groups[0].procedures, 8u);
  EXPECT_EQ(v.rating_groups[3].participants, 8u);
  EXPECT_NEAR(v.rating_groups[3].pooled->mean, mean_interval(experts)->mean, 1e-12);
  EXPECT_NEAR(v.rating_groups[4].participant_means->high, mean_interval(novice_means)->high, 1e-12);
}

// For balanced data the mixed model's contrast is the difference of means, and its t that of the
// participants' means with equal variances.
TEST(ValidityTest, TheMixedModelOfBalancedDataIsTheTTestOfMeans) {
  const Study study = made(2, 0.8, 0.8);
  const Contrast c = study.validity().rating_contrast;
  ASSERT_TRUE(c.mixed);
  ASSERT_FALSE(c.mixed->at_boundary);
  std::vector<double> expert_means, novice_means;
  for (std::size_t i = 0; i < study.ratings.size(); i += 2) {
    (i < 16 ? expert_means : novice_means)
        .push_back((study.ratings[i].score + study.ratings[i + 1].score) / 2.0);
  }
  const auto student = student_t_test(expert_means, novice_means, Tail::kGreater);
  EXPECT_NEAR(c.mixed->coefficients[1].estimate, student->difference, 1e-10);
  EXPECT_NEAR(c.mixed->coefficients[1].t, student->t, 1e-6);
  EXPECT_NEAR(c.mixed->coefficients[1].df, 13.0, 1e-4);
  EXPECT_NEAR(*c.mixed_p, student->p, 1e-6);
}

// If nothing differs the published test, which takes a participant's procedures as independent,
// finds a difference far more often than in 5 % of studies; the mixed model does not.
TEST(ValidityTest, NullStudiesFindADifferenceAsOftenAsTheyMay) {
  RandomStream random(12, "null studies");
  int pooled = 0, mixed = 0;
  constexpr int kStudies = 1000;
  for (int run = 0; run < kStudies; ++run) {
    ValueTable table;
    for (std::size_t person = 0; person < 15; ++person) {
      const double level = 0.8 * random.normal();
      for (const double number : {1.0, 2.0}) {
        table.rows.push_back({level + 0.4 * random.normal(), person, "", person < 8, number});
      }
    }
    const Contrast c = contrast(table, Expected::kHigher);
    pooled += c.pooled->p < 0.05 ? 1 : 0;
    mixed += *c.mixed_p < 0.05 ? 1 : 0;
  }
  EXPECT_GT(pooled, 0.08 * kStudies);
  EXPECT_NEAR(mixed, 0.05 * kStudies, 0.021 * kStudies);  // three standard errors
}

// Among many metrics that say nothing, one or more pass Holm's limit in at most 5 % of studies.
TEST(ValidityTest, ManyMetricsDoNotFindMoreByChance) {
  int found = 0;
  constexpr int kStudies = 60;
  for (std::uint64_t seed = 0; seed < kStudies; ++seed) {
    Study study = made(1000 + seed, 0.0, 0.0);
    study.ratings.clear();
    const Validity v = study.validity();
    found += std::any_of(v.metrics.begin(), v.metrics.end(), [](const MetricValidity& m) {
      return m.contrast_holm && *m.contrast_holm < 0.05;
    });
  }
  EXPECT_LT(found, 0.15 * kStudies);  // more has a chance of 1 in 300 where 5 % is true
}

// The region's scores share their training, so their own test takes the place of Welch's.
TEST(ValidityTest, TheRegionIsTestedByPermutedLabels) {
  const Study study = made(13, 1.0, 0.5);
  const auto region_in = [](const Validity& v) { return *metric_of(v, kRegionMetric); };
  EXPECT_FALSE(region_in(study.validity()).contrast_p);
  const Validity v = validity(study.procedures, study.regions, study.ratings, kPlan,
                              RegionLabelTest{1.0, 0.001, 999});
  EXPECT_EQ(*region_in(v).contrast_p, 0.001);
  EXPECT_EQ(*metric_of(v, "visible_share")->contrast_p,
            metric_of(v, "visible_share")->contrast.means->p);
  EXPECT_GE(*region_in(v).contrast_holm, 0.001);
}

TEST(ValidityTest, RelatesMetricsToRatings) {
  const Study study = made(3, 1.0, 0.5);
  const Validity v = study.validity();
  const MetricValidity& follows = v.metrics[0];
  EXPECT_GT(follows.relation.pooled->r, 0.7);
  EXPECT_EQ(follows.relation.pooled->count, 30u);
  EXPECT_EQ(follows.relation.means->count, 15u);
  EXPECT_GT(follows.relation.line->coefficients[1].estimate, 0.6);
  EXPECT_LT(*follows.relation_holm, 0.01);
  EXPECT_GE(*follows.relation_holm, follows.relation.means->p);
  int others = 0;
  for (std::size_t m = 1; m < v.metrics.size(); ++m) {
    others += *v.metrics[m].relation_holm < 0.05 ? 1 : 0;
  }
  EXPECT_EQ(others, 0);
  EXPECT_GT(v.combined.fit->resubstitution.r ? *v.combined.fit->resubstitution.r : 0.0,
            *v.combined.fit->validated.r);
}

// For experts expected lower, an area above 1/2 says that they are lower.
TEST(ValidityTest, AnAreaIsThatOfTheExpectation) {
  Study study = made(4, 1.0, 0.3);
  const std::vector<MetricKind> kinds = metric_kinds();
  std::size_t lower = 0;
  while (kinds[lower].experts != Expected::kLower) {
    ++lower;
  }
  for (std::size_t i = 0; i < study.procedures.size(); ++i) {
    study.procedures[i].values[lower] = i < 16 ? static_cast<double>(i % 3) : 10.0;
  }
  const Validity v = study.validity();
  EXPECT_EQ(v.metrics[lower].contrast.roc->area, 1.0);
  EXPECT_LT(*v.metrics[lower].contrast.mixed_p, 1e-6);
}

TEST(ValidityTest, AveragesRatersAndSaysHowTheyAgree) {
  const Study study = made(5, 1.0, 0.5, 3);
  const Validity v = study.validity();
  EXPECT_EQ(v.raters.size(), 3u);
  ASSERT_TRUE(v.agreement);
  EXPECT_EQ(v.agreement->targets, 30u);
  EXPECT_GT(v.agreement->random_raters->value, 0.7);
  EXPECT_NEAR(*v.rating[0],
              (study.ratings[0].score + study.ratings[1].score + study.ratings[2].score) / 3.0,
              1e-14);
  EXPECT_FALSE(made(5, 1.0, 0.5).validity().agreement);
}

// A strict rater of novices alone makes experts of whoever that rater did not see.
TEST(ValidityTest, RatersOfDifferentProceduresAreNamed) {
  Study study = made(5, 1.0, 0.5, 2);
  const std::string whole = to_markdown(validity_report(result_of(study), {}));
  EXPECT_THAT(whole, Not(HasSubstr("Not every rater")));
  std::erase_if(study.ratings, [](const Rating& rating) {
    return rating.rater == "rater1" && rating.session < "S09";
  });
  const std::string sentence =
      "Not every rater scored all of the 30 rated procedures (rater0 30, rater1 14), so a "
      "difference of ratings may be one of raters";
  EXPECT_THAT(to_markdown(validity_report(result_of(study), {})), HasSubstr(sentence));
  EXPECT_THAT(summary_lines(result_of(study)), testing::Contains(HasSubstr(sentence)));
}

TEST(ValidityTest, WorksWithoutRatingsAndWithHoles) {
  Study study = made(6, 1.0, 0.5);
  study.ratings.clear();
  study.procedures[4].values[2] = std::nullopt;
  const Validity v = study.validity();
  EXPECT_EQ(v.rated, 0u);
  EXPECT_EQ(v.metrics[2].defined, 29u);
  EXPECT_TRUE(v.metrics[2].contrast.mixed_p);
  ASSERT_FALSE(v.combined.fit);
  EXPECT_EQ(v.combined.fit.because(), "nothing is rated") << "there are people enough";
  const std::string report = to_markdown(validity_report(result_of(study), {}));
  EXPECT_THAT(report, HasSubstr("Nothing is rated yet"));
}

TEST(ValidityTest, AMetricWithHolesIsLeftOutOfTheCombination) {
  Study study = made(7, 1.0, 0.5);
  study.procedures[4].values[2] = std::nullopt;
  const Combined c = study.validity().combined;
  EXPECT_THAT(c.left_out, testing::ElementsAre(metric_kinds()[2].name));
  EXPECT_EQ(c.metrics.size(), metric_kinds().size() - 1);
  EXPECT_EQ(c.rows.size(), 30u);
}

TEST(ValidityTest, RefusesWhatDoesNotFitThePlan) {
  Study study = made(8, 1.0, 0.5);
  study.procedures[1].group = "nurses";
  EXPECT_THAT(message_of([&] { study.validity(); }), HasSubstr("group 'nurses'"));
  study.procedures[1].group = "novices";
  EXPECT_THAT(message_of([&] { study.validity(); }), HasSubstr("and in"));
  study = made(8, 1.0, 0.5);
  study.ratings[3].procedure = 9;
  EXPECT_THAT(message_of([&] { study.validity(); }), HasSubstr("procedure 9 of S02"));
  study = made(8, 1.0, 0.5);
  const ValidityPlan wrong{{"surgeons", "residents", "novices"}, {"chiefs"}};
  EXPECT_THAT(message_of([&] { validity(study.procedures, study.regions, {}, wrong); }),
              HasSubstr("'chiefs'"));
}

// A simulated study says so: participants or raters are enough.
TEST(ValidityTest, ASimulatedStudySaysSoEverywhere) {
  Study study = made(9, 1.0, 0.5, 2);
  const std::string real = to_markdown(validity_report(result_of(study), {}));
  EXPECT_THAT(real, Not(HasSubstr("imulated")));
  EXPECT_THAT(real, Not(HasSubstr("SIMULATED")));
  for (const bool rater : {false, true}) {
    Study simulated = study;
    (rater ? simulated.ratings[0].simulated : simulated.procedures[0].simulated) = true;
    const ValidityResult result = result_of(simulated);
    const Document document = validity_report(result, {});
    EXPECT_TRUE(document.simulated);
    const std::string report = to_markdown(document);
    EXPECT_THAT(report, HasSubstr("proves nothing about people"));
    for (const auto& block : document.blocks) {
      if (const auto* heading = std::get_if<Document::Heading>(&block);
          heading != nullptr && heading->level == 2) {
        EXPECT_THAT(heading->text, HasSubstr("simulated"));
      }
    }
    for (const Figure& figure : validity_figures(result)) {
      EXPECT_TRUE(figure.simulated) << figure.name;
    }
    EXPECT_THAT(summary_lines(result).back(), HasSubstr("nothing about people"));
    EXPECT_TRUE(
        nlohmann::json::parse(validity_json(result.validity, result.procedures))["simulated"]
            .get<bool>());
  }
}

// The first lines rest on participants' means and adjusted p values; pooled procedures stay below.
TEST(ValidityTest, LeadsWithParticipantsAsTheUnit) {
  const ValidityResult result = result_of(made(1, 1.2, 0.3));
  const Validity& v = result.validity;
  const std::vector<std::string> lines = summary_lines(result);
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_THAT(lines[0], HasSubstr(mean_with_interval(v.rating_groups[3].participant_means) +
                                  " (8 participants, 16 procedures)"));
  EXPECT_THAT(lines[1],
              HasSubstr("significant; difference " + number(v.rating_contrast.means->difference)));
  EXPECT_THAT(lines[1], HasSubstr(p_value(v.rating_contrast.means->p)));
  EXPECT_THAT(lines[2], HasSubstr("after Holm's adjustment over 20 metrics"));
  EXPECT_THAT(lines[3], HasSubstr(fmt::format("R = {:.2f} ({} after Holm's adjustment over 21",
                                              v.metrics[0].relation.means->r,
                                              p_value(*v.metrics[0].relation_holm))));
  EXPECT_THAT(lines[3], HasSubstr("over the means of 15 participants"));
  EXPECT_THAT(lines[5], HasSubstr("participants left out"));
  EXPECT_THAT(lines[5], Not(HasSubstr("fitted")));
  const std::string report = to_markdown(validity_report(result, {}));
  const std::size_t published = report.find("## As published");
  ASSERT_NE(published, report.npos);
  EXPECT_LT(published, report.find("over procedures"));
  EXPECT_LT(published, report.find("Student's t"));
  EXPECT_GT(report.find("all procedures are independent"), published);
}

TEST(ValidityTest, CountsWhatThereIsAndListsEveryGroupOnce) {
  Study study = made(14, 1.0, 0.5);
  const auto occurrences = [](const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) {
      ++count;
    }
    return count;
  };
  std::string report = to_markdown(validity_report(result_of(study), {}));
  EXPECT_THAT(report, HasSubstr("30 procedures (30 rated) by 15 participants in 3 groups."));
  EXPECT_EQ(occurrences(report, "\n| novices | 7 | 14 |"), 1);
  EXPECT_EQ(occurrences(report, "\n| all experts | 8 | 16 |"), 1);
  EXPECT_THAT(report, HasSubstr("1 rater scored from 1 to 5"));
  EXPECT_THAT(report, Not(HasSubstr("mean over its raters"))) << "there is one";
  // One procedure of one surgeon and one of one novice: no residents took part.
  const std::size_t kept[] = {0, 16};
  Study small;
  for (const std::size_t i : kept) {
    small.procedures.push_back(study.procedures[i]);
    small.ratings.push_back(study.ratings[i]);
  }
  small.regions.resize(2);
  report = to_markdown(validity_report(result_of(small), {}));
  EXPECT_THAT(report, HasSubstr("2 procedures (2 rated) by 2 participants in 2 groups."));
  EXPECT_THAT(summary_lines(result_of(small))[0], HasSubstr("(1 participant, 1 procedure)"));
  EXPECT_THAT(report, Not(testing::ContainsRegex("[^0-9]1 (participants|procedures|metrics)")));
}

TEST(ValidityTest, AMeanOfValuesThatDoNotVaryHasNoInterval) {
  Study study = made(5, 1.0, 0.5);
  for (Rating& rating : study.ratings) {
    rating.score = rating.session < "S09" ? 4.5 : rating.score;
  }
  const ValidityResult result = result_of(study);
  EXPECT_THAT(summary_lines(result)[0],
              HasSubstr("with experience 4.500 without an interval, because the values do not vary "
                        "(8 participants, 16 procedures)"));
  EXPECT_THAT(to_markdown(validity_report(result, {})),
              HasSubstr("| all experts | 8 | 16 | 4.500 |"));
}

/// A trainee's first osteotomy: the figures of one participant have no interval, and are known.
TEST(ValidityTest, TheMeanOfOneParticipantIsShownWithoutAnInterval) {
  const Study all = made(12, 1.0, 0.5);
  Study one;
  one.procedures = {all.procedures[0]};
  FragmentFit fit;
  fit.came_off = true;
  fit.gap = 0.56e-3;
  fit.screws = 4;
  fit.screws_in_bone = 2;
  one.procedures[0].achieved.fragment = fit;
  one.regions.resize(1);
  const std::string report = to_markdown(validity_report(result_of(one), {}));
  EXPECT_THAT(report,
              HasSubstr("gap left at the cut against the plan \\[mm\\] | 0.5600 | – | – |"));
  EXPECT_THAT(report, HasSubstr("holding in the fragment \\[screws\\] | 2.000 | – | – |"));
}

TEST(ValidityTest, SoftTissueThatToreIsListed) {
  Study study = made(14, 1.0, 0.5);
  EXPECT_THAT(to_markdown(validity_report(result_of(study), {})),
              Not(HasSubstr("Soft tissue that was torn")));
  Injury injury;
  injury.structure = "sigmoid sinus and dura";
  injury.tears = 3;
  injury.first_tear = FirstTear{12.34, 1.52, false, {0.001, 0.0, -0.0025}};
  study.procedures[4].injuries.push_back(injury);
  const std::string report = to_markdown(validity_report(result_of(study), {}));
  EXPECT_THAT(report, HasSubstr("Soft tissue that was torn"));
  EXPECT_THAT(report, HasSubstr(fmt::format(
                          "| {} | {} | sigmoid sinus and dura | 3 | 12.3 | 1.52 | (1.0, 0.0, -2.5)",
                          study.procedures[4].participant, study.procedures[4].number)));
}

TEST(ValidityTest, CaptionsSayOnlyWhatIsDrawn) {
  Study study = made(15, 1.0, 0.5);
  const auto caption_of = [](const Study& of, const std::string& name) {
    for (const Figure& figure : validity_figures(result_of(of))) {
      if (figure.name == name) {
        return figure.caption;
      }
    }
    return std::string();
  };
  EXPECT_THAT(caption_of(study, "roc-experts-novices"), HasSubstr("the rating;"));
  EXPECT_THAT(caption_of(study, "figure-16-ratings"), HasSubstr("then by group"));
  EXPECT_THAT(caption_of(study, "figure-19-visibility"),
              testing::ContainsRegex("Over participants' means R = .* after Holm's adjustment"));
  study.ratings.clear();
  const std::string without = caption_of(study, "roc-experts-novices");
  EXPECT_THAT(without, HasSubstr("the share of voxels removed in sight"));
  EXPECT_THAT(without, Not(HasSubstr("the rating")));
  EXPECT_THAT(without, Not(HasSubstr("all metrics")));
}

TEST(ValidityTest, JsonHoldsWhatTheReportPrints) {
  const Study study = made(10, 1.0, 0.5, 2);
  const Validity v = study.validity();
  const auto json = nlohmann::json::parse(validity_json(v, study.procedures));
  EXPECT_EQ(json["ratings"]["contrast"]["student_over_procedures"]["p"].get<double>(),
            v.rating_contrast.pooled->p);
  EXPECT_EQ(json["ratings"]["contrast"]["mixed_model"]["participants"], 15);
  EXPECT_EQ(json["metrics"][0]["contrast_p"].get<double>(), *v.metrics[0].contrast_p);
  EXPECT_EQ(json["metrics"][0]["rating_spearman_p_holm"].get<double>(), *v.metrics[0].ranks_holm);
  EXPECT_EQ(json["agreement_between_raters"]["icc_2_1"]["value"].get<double>(),
            v.agreement->random_raters->value);
  EXPECT_EQ(json["combined"]["fit"]["cross_validated"]["r"].get<double>(),
            *v.combined.fit->validated.r);
  EXPECT_EQ(json["metrics"].size(), metric_kinds().size());
  EXPECT_EQ(json["procedures"].size(), 30u);
  EXPECT_THAT(json.dump(), Not(HasSubstr("null")));
}

TEST(ValidityTest, WritesReportFiguresAndTables) {
  const test::TemporaryFolder folder;
  write_validity(result_of(made(11, 1.0, 0.5, 2)), folder / "out");
  for (const char* name :
       {"report.html", "report.md", "statistics.json", "metrics.csv", "figure-16-ratings.svg",
        "figure-19-visibility.svg", "figure-21-region.svg", "roc-experts-novices.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
  }
}

}  // namespace
}  // namespace haptrial::analysis::drilling::validity_test
