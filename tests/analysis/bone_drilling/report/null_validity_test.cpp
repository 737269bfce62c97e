// Every test that the construct-validity report leads with keeps its level; pooled procedures do
// not.
#include "tests/analysis/bone_drilling/report/null_validity.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.h"

namespace haptrial::analysis::drilling::null_validity_test {
namespace {

using test::NullLabels;
using test::NullLevel;

// A test with a level of 0.05 leaves the band once in ten million times.
const std::size_t kStudies = test::null_studies(100);

std::size_t most() { return test::binomial_band(kStudies, 1.0 - 1e-7).high; }

test::RatedStudy shipped() {
  return test::read_rated_study(std::filesystem::path(HAPTRIAL_SOURCE_DIR) /
                                "results/construct_validity");
}

/// Six surgeons and six novices, 12 procedures each: people differ more than their procedures do.
test::RatedStudy many_procedures() {
  RandomStream random(7, "many procedures");
  test::RatedStudy study;
  study.plan = {{"surgeons", "novices"}, {"surgeons"}};
  const std::size_t metrics = metric_kinds().size();
  for (int person = 0; person < 12; ++person) {
    std::vector<double> levels(metrics + 1);
    std::generate(levels.begin(), levels.end(), [&] { return 0.6 * random.normal(); });
    for (int number = 1; number <= 12; ++number) {
      ProcedureSummary p;
      p.session = p.participant = fmt::format("S{:02}", person + 1);
      p.group = person < 6 ? "surgeons" : "novices";
      p.number = number;
      for (std::size_t m = 0; m < metrics; ++m) {
        p.values.emplace_back(levels[m] + 0.2 * random.normal());
      }
      const double score = std::clamp(3.0 + levels[metrics] + 0.2 * random.normal(), 1.0, 5.0);
      study.ratings.push_back({p.session, number, "rater", score, "", false});
      study.procedures.push_back(std::move(p));
    }
  }
  return study;
}

void expect_level(const std::vector<NullLevel>& levels, std::size_t leading) {
  std::size_t leads = 0;
  for (const NullLevel& level : levels) {
    fmt::print("{}: {} of {}{}\n", level.test, level.found, level.replications,
               level.leads ? ", leads" : "");
    if (level.leads) {
      ++leads;
      EXPECT_EQ(level.replications, kStudies) << level.test;
      EXPECT_LE(level.found, most()) << level.test;
    }
  }
  EXPECT_EQ(leads, leading);
}

void expect_no_level(const std::vector<NullLevel>& levels, const std::string& test) {
  for (const NullLevel& level : levels) {
    if (level.test == test) {
      EXPECT_GT(level.found * kStudies, most() * level.replications) << test;
      return;
    }
  }
  FAIL() << test << " was not counted";
}

TEST(NullValidity, WhatTheShippedStudysReportLeadsWithKeepsItsLevel) {
  expect_level(test::null_validity(shipped(), NullLabels::kGroups, kStudies, 2, 2), 2);
  expect_level(test::null_validity(shipped(), NullLabels::kRatings, kStudies, 2, 2), 1);
}

TEST(NullValidity, ManyProceduresOfEachParticipantDeceiveOnlyThePooledTests) {
  const auto groups = test::null_validity(many_procedures(), NullLabels::kGroups, kStudies, 2, 2);
  expect_level(groups, 2);
  expect_no_level(groups, "as published: ratings, Student's t over procedures");
  const auto ratings = test::null_validity(many_procedures(), NullLabels::kRatings, kStudies, 2, 2);
  expect_level(ratings, 1);
  expect_no_level(ratings, "as published: one metric, R over procedures");
}

TEST(NullValidity, PermutedLabelsKeepTheLevelOfTheRegion) {
  const auto regions = test::null_regions(kStudies, 2, 2);
  expect_level(regions, 1);
}

TEST(NullValidity, GroupsOfDifferentSpreadDeceiveOnlyTestsThatAssumeOneSpread) {
  const auto spreads = test::null_spreads(kStudies, 2, 2);
  expect_level(spreads, 1);
  expect_no_level(spreads, "as published: ratings, Student's t over procedures");
}

}  // namespace
}  // namespace haptrial::analysis::drilling::null_validity_test
