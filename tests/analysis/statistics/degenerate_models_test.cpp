// Effect sizes, resampling, linear models: whatever the data, there is a number or a sentence.
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/relation/correlation.h"
#include "analysis/statistics/relation/mixed_model.h"
#include "analysis/statistics/relation/regression.h"
#include "analysis/statistics/tests/bootstrap.h"
#include "analysis/statistics/tests/permutation.h"
#include "analysis/statistics/tests/power.h"
#include "analysis/statistics/variance/effect_size.h"
#include "tests/analysis/statistics/degenerate_samples.h"

namespace haptrial::analysis::degenerate_models_test {
namespace {

using degenerate::expect_numbers;
using degenerate::expect_p;
using degenerate::has_value;
using degenerate::kInfinity;
using degenerate::kNan;
using degenerate::kSamples;
using degenerate::name;
using degenerate::Values;

const Resampling kFew{1, "degenerate", 99, 1};

void check(const std::string& what, const Defined<EffectSize>& e) {
  if (has_value(what, e)) {
    expect_numbers(what, {e->value, e->low, e->high});
    EXPECT_LE(e->low, e->high) << what;
  }
}

void check(const std::string& what, const Defined<BootstrapInterval>& b) {
  if (has_value(what, b)) {
    expect_numbers(what, {b->estimate, b->low, b->high, b->bias, b->acceleration});
  }
}

void check(const std::string& what, const Defined<PermutationTest>& t) {
  if (has_value(what, t)) {
    expect_numbers(what, {t->difference});
    expect_p(what, t->p);
    EXPECT_GT(t->p, 0.0) << what;
  }
}

void check(const std::string& what, const Defined<Correlation>& c) {
  if (has_value(what, c)) {
    expect_numbers(what, {c->r});
    expect_p(what, c->p);
    if (has_value(what, c->interval)) {
      expect_numbers(what, {c->interval->low, c->interval->high});
    }
  }
}

void check(const std::string& what, const std::vector<Coefficient>& coefficients) {
  for (const auto& c : coefficients) {
    expect_numbers(what, {c.estimate, c.error, c.df, c.t, c.low, c.high});
    expect_p(what, c.p);
  }
}

void check(const std::string& what, const Defined<Regression>& r) {
  if (has_value(what, r)) {
    check(what, r->coefficients);
    expect_numbers(what, {r->deviation, r->r_squared, r->adjusted_r_squared, r->f});
    expect_p(what, r->p);
  }
}

void check(const std::string& what, const Defined<MixedModel>& m) {
  if (has_value(what, m)) {
    check(what, m->coefficients);
    expect_numbers(
        what, {m->variances.front(), m->variances.back(), m->variance_within, m->log_likelihood});
  }
}

TEST(DegenerateData, GiveNumbersOrASentenceInEffectSizesAndResampling) {
  const auto mean = [](std::span<const double> v) { return moments(v)->mean(); };
  for (std::size_t i = 0; i < kSamples.size(); ++i) {
    check("bootstrap, " + name(i, i), bootstrap(kSamples[i], mean, kFew));
    for (std::size_t j = 0; j < kSamples.size(); ++j) {
      const Values &a = kSamples[i], &b = kSamples[j];
      check("d, " + name(i, j), cohens_d(a, b));
      check("g, " + name(i, j), hedges_g(a, b));
      check("difference, " + name(i, j), bootstrap_difference(a, b, kFew));
      check("permutation, " + name(i, j), permutation_test(a, b, Tail::kTwoSided, kFew));
      if (const auto anova = one_way_anova({a, b}); anova) {
        check("eta, " + name(i, j), eta_squared(*anova));
      }
      if (a.size() == b.size()) {
        check("d_z, " + name(i, j), cohens_dz(a, b));
        check("signs, " + name(i, j), sign_flip_test(a, b, Tail::kLess, kFew));
      }
    }
  }
}

TEST(DegenerateData, GiveNumbersOrASentenceInLinearModels) {
  for (std::size_t i = 0; i < kSamples.size(); ++i) {
    for (std::size_t j = 0; j < kSamples.size(); ++j) {
      const Values &a = kSamples[i], &b = kSamples[j];
      if (a.size() != b.size()) {
        continue;
      }
      check("pearson, " + name(i, j), pearson_correlation(a, b));
      check("spearman, " + name(i, j), spearman_correlation(a, b));
      check("regression, " + name(i, j), linear_regression(a, b));
      const Eigen::MatrixXd x = Eigen::VectorXd::Map(a.data(), std::ssize(a));
      std::vector<std::size_t> groups(a.size());
      std::iota(groups.begin(), groups.end(), std::size_t{0});
      for (auto& group : groups) {
        group /= 2;
      }
      check("mixed model, " + name(i, j), random_intercept_model(b, x, groups));
      std::vector<std::size_t> crossed(a.size());
      for (std::size_t row = 0; row < crossed.size(); ++row) {
        crossed[row] = (row + row / 2) % 2;
      }
      check("two terms, " + name(i, j), mixed_model(b, x, {groups, crossed}));
      check("means model, " + name(i, j),
            random_intercept_model(b, Eigen::MatrixXd(std::ssize(b), 0), groups));
    }
  }
}

TEST(DegenerateData, GiveNumbersOrASentenceInPlans) {
  const Values numbers{kNan, kInfinity, -1.0, 0.0, 1e-300, 1e-9, 0.05, 0.5, 1.0, 2.0, 1e6, 1e300};
  const auto check_number = [](const Defined<double>& value) {
    if (has_value("power", value)) {
      expect_numbers("power", {*value});
    }
  };
  for (const double a : numbers) {
    for (const double b : numbers) {
      for (const double alpha : {kNan, 0.0, 0.05, 1.0}) {
        check_number(t_power({TDesign::kPaired, alpha, true}, a, b));
        check_number(t_detectable({TDesign::kTwoSample, alpha, false}, a, b));
        check_number(anova_power({3, alpha}, a, b));
        check_number(anova_detectable({3, alpha}, a, b));
        for (const auto& size : {t_sample_size({TDesign::kOneSample, alpha, false}, a, b),
                                 anova_sample_size({3, alpha}, a, b)}) {
          if (has_value("size", size)) {
            expect_numbers("size", {size->exact, size->power});
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace haptrial::analysis::degenerate_models_test
