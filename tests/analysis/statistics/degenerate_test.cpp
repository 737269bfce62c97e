// No statistic is ever NaN or infinite: whatever the data, there is a number or a sentence.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "analysis/statistics/tests/shapiro_wilk.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/tests/wilcoxon.h"
#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/rank_anova.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "tests/analysis/statistics/degenerate_samples.h"
#include "tests/support/two_factors.h"

namespace haptrial::analysis {
namespace {

using degenerate::expect_numbers;
using degenerate::expect_p;
using degenerate::has_value;
using degenerate::kSamples;
using degenerate::name;
using degenerate::Values;
using Table = std::vector<Values>;

void check(const std::string& what, const Defined<TTest>& t) {
  if (has_value(what, t)) {
    expect_numbers(what, {t->t, t->df, t->difference, t->low, t->high, t->error});
    expect_p(what, t->p);
  }
}

void check(const std::string& what, const Defined<RankTest>& t) {
  if (has_value(what, t)) {
    expect_numbers(what, {t->statistic});
    expect_p(what, t->p);
  }
}

void check(const std::string& what, const Defined<RankAnova>& a) {
  if (has_value(what, a)) {
    expect_numbers(what, {a->chi_squared, a->df});
    expect_p(what, a->p);
  }
}

void check(const std::string& what, const Defined<Anova>& a) {
  if (has_value(what, a)) {
    expect_numbers(what, {a->f, a->squares_between, a->squares_within, a->eta_squared});
    expect_p(what, a->p);
  }
}

void check(const std::string& what, const Sphericity& s) {
  expect_numbers(what, {s.greenhouse_geisser});
  if (has_value(what, s.mauchly)) {
    expect_p(what, s.mauchly->p);
    expect_p(what, s.mauchly->w);
  }
  if (has_value(what, s.huynh_feldt)) {
    expect_numbers(what, {*s.huynh_feldt});
  }
}

void check(const std::string& what, const Defined<WithinEffect>& e) {
  if (has_value(what, e)) {
    expect_numbers(what, {e->f, e->squares, e->squares_error, e->partial_eta_squared});
    expect_p(what, e->p);
    expect_p(what, e->p_greenhouse_geisser);
    check(what, e->sphericity);
    if (has_value(what, e->p_huynh_feldt)) {
      expect_p(what, *e->p_huynh_feldt);
    }
  }
}

void check(const std::string& what, const test::TwoFactors& found) {
  check(what, found.a);
  check(what, found.b);
  check(what, found.interaction);
}

TEST(DegenerateData, GiveNumbersOrASentenceInTestsOfTwoSamples) {
  for (std::size_t i = 0; i < kSamples.size(); ++i) {
    for (std::size_t j = 0; j < kSamples.size(); ++j) {
      const Values &a = kSamples[i], &b = kSamples[j];
      for (const Tail tail : {Tail::kTwoSided, Tail::kLess, Tail::kGreater}) {
        check("student, " + name(i, j), student_t_test(a, b, tail));
        check("welch, " + name(i, j), welch_t_test(a, b, tail));
        check("mann_whitney, " + name(i, j), mann_whitney(a, b, tail));
        if (a.size() == b.size()) {
          check("paired, " + name(i, j), paired_t_test(a, b, tail));
          check("signed rank, " + name(i, j), wilcoxon_signed_rank(a, b, tail));
        }
      }
    }
  }
}

TEST(DegenerateData, GiveNumbersOrASentenceInTestsOfGroups) {
  for (std::size_t i = 0; i < kSamples.size(); ++i) {
    const auto s = shapiro_wilk(kSamples[i]);
    if (has_value("shapiro", s)) {
      expect_p("shapiro, " + name(i, i), s->p);
      expect_p("shapiro, " + name(i, i), s->w);
    }
    for (std::size_t j = 0; j < kSamples.size(); ++j) {
      const Table groups{kSamples[i], kSamples[j], {1.0, 2.0, 4.0}};
      for (const Table& table : {groups, Table{kSamples[i], kSamples[j]}, Table{kSamples[i]}}) {
        check("one way, " + name(i, j), one_way_anova(table));
        check("kruskal, " + name(i, j), kruskal_wallis(table));
        check("levene, " + name(i, j), levene(table, Centre::kMean));
        check("levene, " + name(i, j), levene(table, Centre::kMedian));
      }
    }
  }
}

TEST(DegenerateData, GiveNumbersOrASentenceInDesignsWithinParticipants) {
  for (std::size_t i = 0; i < kSamples.size(); ++i) {
    for (std::size_t j = 0; j < kSamples.size(); ++j) {
      Table table{kSamples[i], kSamples[j]};
      for (int rows = 2; rows <= 4; ++rows) {
        check("friedman, " + name(i, j), friedman(table));
        if (const auto a = repeated_measures_anova(table); has_value("repeated", a)) {
          expect_numbers("repeated, " + name(i, j), {a->f, a->squares_participants, a->epsilon});
          expect_p("repeated, " + name(i, j), a->p);
          expect_p("repeated, " + name(i, j), a->p_corrected);
          check("repeated, " + name(i, j), a->sphericity);
        }
        if (!table.empty() && table.front().size() == 4) {
          check("two way, " + name(i, j), test::two_within(table, 2));
        }
        check("mixed, " + name(i, j), test::mixed_factors({table, {kSamples[j]}}));
        table.push_back(Values(kSamples[i].rbegin(), kSamples[i].rend()));
      }
    }
  }
}

}  // namespace
}  // namespace haptrial::analysis
