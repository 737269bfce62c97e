#include "analysis/statistics/relation/intraclass.h"

#include <cmath>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

// The f with P(F > f) = tail, sought in its logarithm.
double f_quantile(double tail, double df_numerator, double df_denominator) {
  const auto excess = [&](double log_f) {
    return std::log(f_upper_tail(std::exp(log_f), df_numerator, df_denominator) / tail);
  };
  double low = -1.0, high = 1.0;
  while (excess(low) < 0.0) {
    low *= 2.0;
  }
  while (excess(high) > 0.0) {
    high *= 2.0;
  }
  return std::exp(find_root(excess, low, high));
}

// The reliability of a mean over k raters, from that of one (Spearman and Brown).
double stepped_up(double r, double k) { return k * r / (1.0 + (k - 1.0) * r); }

const Undefined kNoError{
    "the raters agree exactly: the correlation is 1 and there is no error for an interval"};

// Forms (1) and (3): the ratio of two mean squares alone.
struct RatioForms {
  Defined<IntraclassForm> single{kNoError};
  Defined<IntraclassForm> mean{kNoError};
};

RatioForms ratio_forms(double targets, double error, double df_targets, double df_error, double k,
                       double level) {
  if (!(error > 0.0)) {
    return {};
  }
  const double tail = 0.5 * (1.0 - level);
  IntraclassForm form{.f = targets / error, .df_targets = df_targets, .df_error = df_error};
  form.p = f_upper_tail(form.f, df_targets, df_error);
  const double low = form.f / f_quantile(tail, df_targets, df_error);
  const double high = form.f * f_quantile(tail, df_error, df_targets);
  IntraclassForm mean = form;
  mean.value = 1.0 - 1.0 / form.f;
  mean.low = 1.0 - 1.0 / low;
  mean.high = 1.0 - 1.0 / high;
  form.value = (form.f - 1.0) / (form.f + k - 1.0);
  form.low = (low - 1.0) / (low + k - 1.0);
  form.high = (high - 1.0) / (high + k - 1.0);
  RatioForms forms{form, form.f > 0.0 ? Defined<IntraclassForm>(mean)
                                      : Undefined{"all targets have the same mean"}};
  return forms;
}

// Form (2): three mean squares, its degrees of freedom by Satterthwaite's rule.
IntraclassForm random_form(const Intraclass& c, double level) {
  const auto n = static_cast<double>(c.targets);
  const auto k = static_cast<double>(c.raters);
  const double bms = c.mean_square_targets;
  const double jms = c.mean_square_raters;
  const double ems = c.mean_square_error;
  IntraclassForm form{.f = bms / ems, .df_targets = n - 1.0, .df_error = (n - 1.0) * (k - 1.0)};
  form.p = f_upper_tail(form.f, form.df_targets, form.df_error);
  const double r = (bms - ems) / (bms + (k - 1.0) * ems + k * (jms - ems) / n);
  form.value = r;
  const double a = k * r * jms / ems;
  const double b = n * (1.0 + (k - 1.0) * r) - k * r;
  const double df = (k - 1.0) * (n - 1.0) * (a + b) * (a + b) / ((n - 1.0) * a * a + b * b);
  const double tail = 0.5 * (1.0 - level);
  const double below = f_quantile(tail, n - 1.0, df);
  const double above = f_quantile(tail, df, n - 1.0);
  const double rest = k * jms + (k * n - k - n) * ems;
  form.low = n * (bms - below * ems) / (below * rest + n * bms);
  form.high = n * (above * bms - ems) / (rest + n * above * bms);
  return form;
}

void add_mean_squares(Intraclass& c, const Eigen::MatrixXd& ratings) {
  const auto n = static_cast<double>(c.targets);
  const auto k = static_cast<double>(c.raters);
  const Eigen::MatrixXd centred = ratings.array() - ratings.mean();
  const Eigen::VectorXd rows = centred.rowwise().mean();
  const Eigen::RowVectorXd columns = centred.colwise().mean();
  const Eigen::MatrixXd within = centred.colwise() - rows;
  const Eigen::MatrixXd rest = within.rowwise() - columns;
  c.mean_square_targets = k * rows.squaredNorm() / (n - 1.0);
  c.mean_square_raters = n * columns.squaredNorm() / (k - 1.0);
  c.mean_square_within = within.squaredNorm() / (n * (k - 1.0));
  c.mean_square_error = rest.squaredNorm() / ((n - 1.0) * (k - 1.0));
  // Differences between equal numbers after their mean was subtracted are rounding.
  const double noise = 1e-28 * (ratings.array() - ratings.mean()).square().maxCoeff();
  for (double* square : {&c.mean_square_targets, &c.mean_square_raters, &c.mean_square_within,
                         &c.mean_square_error}) {
    *square = *square > noise ? *square : 0.0;
  }
}

}  // namespace

Defined<Intraclass> intraclass_correlation(const Eigen::MatrixXd& ratings, double level) {
  if (ratings.rows() < 2 || ratings.cols() < 2) {
    return Undefined{"it takes at least two raters and two targets that all of them rated"};
  }
  if (!ratings.allFinite()) {
    return Undefined{"a rating is not finite"};
  }
  if (ratings.minCoeff() == ratings.maxCoeff()) {
    return Undefined{"all ratings are equal"};
  }
  Intraclass c;
  c.targets = static_cast<std::size_t>(ratings.rows());
  c.raters = static_cast<std::size_t>(ratings.cols());
  add_mean_squares(c, ratings);
  const auto n = static_cast<double>(c.targets);
  const auto k = static_cast<double>(c.raters);
  const RatioForms one =
      ratio_forms(c.mean_square_targets, c.mean_square_within, n - 1.0, n * (k - 1.0), k, level);
  const RatioForms fixed = ratio_forms(c.mean_square_targets, c.mean_square_error, n - 1.0,
                                       (n - 1.0) * (k - 1.0), k, level);
  c.one_way = one.single;
  c.one_way_mean = one.mean;
  c.fixed_raters = fixed.single;
  c.fixed_raters_mean = fixed.mean;
  if (!(c.mean_square_error > 0.0)) {
    c.random_raters = c.random_raters_mean = Undefined{
        c.mean_square_raters > 0.0 ? "the raters differ by their means only: there is no error for "
                                     "an interval"
                                   : kNoError.because};
    return c;
  }
  if (!(c.mean_square_targets > 0.0)) {  // its degrees of freedom may be 0 / 0
    c.random_raters = c.random_raters_mean = Undefined{"all targets have the same mean"};
    return c;
  }
  const IntraclassForm random = random_form(c, level);
  c.random_raters = random;
  IntraclassForm mean = random;
  for (double* r : {&mean.value, &mean.low, &mean.high}) {
    *r = stepped_up(*r, k);
  }
  c.random_raters_mean = mean;
  return c;
}

}  // namespace haptrial::analysis
