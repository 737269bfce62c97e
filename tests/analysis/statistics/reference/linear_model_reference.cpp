// Regression, correlation and the mixed model.
#include <algorithm>
#include <map>

#include "analysis/statistics/relation/correlation.h"
#include "analysis/statistics/relation/mixed_model.h"
#include "analysis/statistics/relation/regression.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::linear_model_reference {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Values = std::vector<double>;

Values of(const std::vector<Coefficient>& coefficients, double Coefficient::*member) {
  Values result;
  for (const auto& c : coefficients) {
    result.push_back(c.*member);
  }
  return result;
}

void compare_fit(Answers& r, const std::string& name, const Defined<Regression>& fit) {
  r.at("Linear regression", name)
      .are("estimate", of(fit->coefficients, &Coefficient::estimate))
      .are("error", of(fit->coefficients, &Coefficient::error))
      .are("t", of(fit->coefficients, &Coefficient::t))
      .are("p", of(fit->coefficients, &Coefficient::p))
      .are("low", of(fit->coefficients, &Coefficient::low))
      .are("high", of(fit->coefficients, &Coefficient::high))
      .is("deviation", fit->deviation)
      .is("r_squared", fit->r_squared)
      .is("adjusted", fit->adjusted_r_squared)
      .is("f", fit->f)
      .is("p_model", fit->p);
}

// 1 where a factor has this level.
VectorXd is(const std::vector<std::string>& factor, const std::string& level) {
  VectorXd column(std::ssize(factor));
  std::transform(factor.begin(), factor.end(), column.begin(),
                 [&](const auto& text) { return text == level ? 1.0 : 0.0; });
  return column;
}

MatrixXd columns(const std::vector<VectorXd>& list) {
  MatrixXd result(list.front().size(), std::ssize(list));
  for (std::size_t j = 0; j < list.size(); ++j) {
    result.col(static_cast<Eigen::Index>(j)) = list[j];
  }
  return result;
}

VectorXd vector(const Values& values) { return VectorXd::Map(values.data(), std::ssize(values)); }

void compare_regression(Answers& r) {
  for (const auto& [name, file] :
       std::map<std::string, std::string>{{"pairs", "pairs"}, {"long pairs", "long_pairs"}}) {
    const DataSet data(file);
    compare_fit(r, name, linear_regression(data.numbers("first"), data.numbers("second")));
  }
  const DataSet study("study");
  const VectorXd trial = vector(study.numbers("trial"));
  compare_fit(
      r, "study",
      linear_regression(columns({trial, trial.cwiseAbs2(), is(study.texts("condition"), "visual"),
                                 is(study.texts("condition"), "visuohaptic"),
                                 is(study.texts("group"), "novice")}),
                        study.numbers("score")));
}

void compare_correlations(Answers& r, const std::string& name, const Values& a, const Values& b) {
  for (const auto& [procedure, function] :
       {std::pair{"Pearson correlation", &pearson_correlation},
        std::pair{"Spearman correlation", &spearman_correlation}}) {
    const auto c = function(a, b, 0.95);
    r.at(procedure, name)
        .is("r", c->r)
        .is("p", c->p)
        .is("low", c->interval->low)
        .is("high", c->interval->high);
  }
}

Values head(Values values, std::size_t count) {
  values.resize(count);
  return values;
}

void compare_correlation(Answers& r) {
  const DataSet pairs("pairs"), long_pairs("long_pairs"), tied("tied_pairs");
  const Values first = pairs.numbers("first"), second = pairs.numbers("second");
  compare_correlations(r, "pairs", first, second);
  compare_correlations(r, "long pairs", long_pairs.numbers("first"), long_pairs.numbers("second"));
  compare_correlations(r, "tied pairs", tied.numbers("first"), tied.numbers("second"));
  compare_correlations(r, "eight pairs", head(first, 8), head(second, 8));
  Values visual, both;
  for (const auto& row : DataSet("study").means("score", "subject", "condition")) {
    visual.push_back(row[1]);
    both.push_back(row[2]);
  }
  compare_correlations(r, "participants", visual, both);
  for (const std::size_t n : {5u, 8u}) {
    const auto c =
        spearman_correlation(head(tied.numbers("first"), n), head(tied.numbers("second"), n));
    r.at("Spearman correlation of few tied pairs", std::to_string(n) + " pairs")
        .is("r", c->r)
        .is("p", c->p);
  }
}

void compare_model(Answers& r, const std::string& name, const Defined<MixedModel>& m) {
  r.at("Mixed model with random intercept", name)
      .are("estimate", of(m->coefficients, &Coefficient::estimate))
      .are("error", of(m->coefficients, &Coefficient::error))
      .are("df", of(m->coefficients, &Coefficient::df))
      .are("p", of(m->coefficients, &Coefficient::p))
      .are("low", of(m->coefficients, &Coefficient::low))
      .is("between", m->variances.front())
      .is("within", m->variance_within)
      .is("log_likelihood", m->log_likelihood);
}

std::vector<std::size_t> numbered(const std::vector<std::string>& factor) {
  std::map<std::string, std::size_t> numbers;
  std::vector<std::size_t> result;
  for (const auto& text : factor) {
    result.push_back(numbers.try_emplace(text, numbers.size()).first->second);
  }
  return result;
}

// Rows of the study that a predicate keeps.
struct Trials {
  Values score, trial;
  std::vector<std::string> subject, group, condition;
};

template <class Keep>
Trials trials(Keep&& keep) {
  const DataSet study("study");
  const Values score = study.numbers("score"), trial = study.numbers("trial");
  Trials result;
  std::size_t number = 0;  // of the rows up to trial 12, from 1
  for (std::size_t i = 0; i < score.size(); ++i) {
    if (trial[i] <= 12.0 && keep(++number, study.texts("subject")[i], trial[i])) {
      result.score.push_back(score[i]);
      result.trial.push_back(trial[i]);
      result.subject.push_back(study.texts("subject")[i]);
      result.group.push_back(study.texts("group")[i]);
      result.condition.push_back(study.texts("condition")[i]);
    }
  }
  return result;
}

void compare_study_models(Answers& r) {
  const Trials all = trials([](auto...) { return true; });
  const auto coded = [](const Trials& t) {
    return std::vector<VectorXd>{is(t.condition, "visual"), is(t.condition, "visuohaptic"),
                                 is(t.group, "novice")};
  };
  compare_model(r, "study",
                random_intercept_model(all.score, columns(coded(all)), numbered(all.subject)));

  const Trials some = trials([](std::size_t row, const std::string& subject, double trial) {
    return row % 7 != 0 && !(subject == "P03" && trial > 5.0);
  });
  auto list = coded(some);
  list.push_back(vector(some.trial));
  list.push_back(list[0].cwiseProduct(list[2]));
  list.push_back(list[1].cwiseProduct(list[2]));
  compare_model(r, "unbalanced",
                random_intercept_model(some.score, columns(list), numbered(some.subject)));

  std::map<std::pair<std::string, std::string>, std::pair<double, double>> cells;
  for (std::size_t i = 0; i < all.score.size(); ++i) {
    auto& [sum, count] = cells[{all.subject[i], all.condition[i]}];
    sum += all.score[i];
    count += 1.0;
  }
  Values means;
  std::vector<std::string> subjects;
  for (const auto& [cell, sum] : cells) {
    means.push_back(sum.first / sum.second);
    subjects.push_back(cell.first);
  }
  compare_model(r, "means",
                random_intercept_model(means, MatrixXd(std::ssize(means), 0), numbered(subjects)));
}

void compare_times_models(Answers& r) {
  const DataSet times("times");
  const std::vector<VectorXd> conditions{is(times.texts("condition"), "c2"),
                                         is(times.texts("condition"), "c3"),
                                         is(times.texts("condition"), "c4")};
  auto list = conditions;
  list.push_back(is(times.texts("group"), "g2"));
  list.push_back(is(times.texts("group"), "g3"));
  const auto subjects = numbered(times.texts("subject"));
  compare_model(r, "times",
                random_intercept_model(times.numbers("value"), columns(list), subjects));
  Values even;
  for (std::size_t i = 1; i <= subjects.size(); ++i) {
    even.push_back(static_cast<double>(i * 37 % 53));
  }
  compare_model(r, "boundary", random_intercept_model(even, columns(conditions), subjects));
}

const Topic kRegression("regression", compare_regression);
const Topic kCorrelation("correlation", compare_correlation);
const Topic kMixedModel("mixed_model", [](Answers& r) {
  compare_study_models(r);
  compare_times_models(r);
});

}  // namespace
}  // namespace haptrial::analysis::reference::linear_model_reference
