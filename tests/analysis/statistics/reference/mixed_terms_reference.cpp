// Mixed models with several random intercepts, with contrasts and joint tests.
#include <map>

#include "analysis/statistics/relation/mixed_contrast.h"
#include "analysis/statistics/relation/mixed_model.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::mixed_terms_reference {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Values = std::vector<double>;
using Groups = std::vector<std::size_t>;

/// A row of data/study.csv with what mixed_terms.R makes of it.
struct Trial {
  std::size_t row, subject, place, block;  // from 1
  double trial, score;
  bool novice;

  std::size_t cell() const { return 3 * subject + place; }
  std::size_t set() const { return 10 * cell() + block; }
  std::size_t item() const { return row % 13; }
  double even() const { return static_cast<double>(row * 37 % 53); }
  double people() const { return even() + 5.0 * static_cast<double>(subject * 5 % 12); }
  double cells() const {
    return people() + 4.0 * static_cast<double>((subject * 7 + 5 * place) % 11);
  }
};

template <class Keep>
std::vector<Trial> trials(Keep&& keep) {
  const DataSet study("study");
  const std::map<std::string, std::size_t> places{{"haptic", 1}, {"visual", 2}, {"visuohaptic", 3}};
  const Values trial = study.numbers("trial"), score = study.numbers("score");
  const Values block = study.numbers("block");
  std::vector<Trial> result;
  std::size_t row = 0;
  for (std::size_t i = 0; i < score.size(); ++i) {
    if (trial[i] > 9.0) {
      continue;
    }
    Trial t{.row = ++row,
            .subject = static_cast<std::size_t>(std::stoi(study.texts("subject")[i].substr(1))),
            .place = places.at(study.texts("condition")[i]),
            .block = static_cast<std::size_t>(block[i]),
            .trial = trial[i],
            .score = score[i],
            .novice = study.texts("group")[i] == "novice"};
    t.score += 20.0 * static_cast<double>((3 * t.subject + 5 * t.place + 2 * t.block) % 11);
    if (keep(t)) {
      result.push_back(t);
    }
  }
  return result;
}

template <class Key>
Groups grouped(const std::vector<Trial>& trials, Key&& key) {
  Groups groups;
  for (const Trial& t : trials) {
    groups.push_back(key(t));
  }
  return groups;
}

std::vector<Groups> nested(const std::vector<Trial>& trials) {
  return {grouped(trials, [](const Trial& t) { return t.subject; }),
          grouped(trials, [](const Trial& t) { return t.cell(); }),
          grouped(trials, [](const Trial& t) { return t.set(); })};
}

MatrixXd conditions(const std::vector<Trial>& trials) {
  MatrixXd x(std::ssize(trials), 2);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    x.row(static_cast<Eigen::Index>(i)) << (trials[i].place == 2), (trials[i].place == 3);
  }
  return x;
}

VectorXd novices(const std::vector<Trial>& trials) {
  VectorXd x(std::ssize(trials));
  for (std::size_t i = 0; i < trials.size(); ++i) {
    x[static_cast<Eigen::Index>(i)] = trials[i].novice ? 1.0 : 0.0;
  }
  return x;
}

template <class Value>
Values values(const std::vector<Trial>& trials, Value&& value) {
  Values result;
  for (const Trial& t : trials) {
    result.push_back(value(t));
  }
  return result;
}

Values of(const std::vector<Coefficient>& coefficients, double Coefficient::*member) {
  Values result;
  for (const auto& c : coefficients) {
    result.push_back(c.*member);
  }
  return result;
}

void compare_model(Answers& r, const std::string& name, const Defined<MixedModel>& m,
                   const MatrixXd& contrasts) {
  VectorXd weights = VectorXd::Zero(std::ssize(m->coefficients));
  weights[1] = 1.0;
  weights[2] = -1.0;
  const auto difference = contrast(*m, weights);
  const auto test = joint_test(*m, contrasts);
  r.at("Mixed model with several random terms", name)
      .are("estimate", of(m->coefficients, &Coefficient::estimate))
      .are("error", of(m->coefficients, &Coefficient::error))
      .are("df", of(m->coefficients, &Coefficient::df))
      .are("t", of(m->coefficients, &Coefficient::t))
      .are("p", of(m->coefficients, &Coefficient::p))
      .are("variance", m->variances)
      .is("within", m->variance_within)
      .is("reml", -2.0 * m->log_likelihood)
      .is("difference", difference->estimate)
      .is("spread", difference->error)
      .is("difference_df", difference->df)
      .is("f", test->f)
      .is("ddf", test->df_denominator)
      .is("p_f", test->p);
}

template <class Value>
void compare_nested(Answers& r, const std::string& name, const std::vector<Trial>& trials,
                    Value&& value) {
  const MatrixXd x = conditions(trials);
  compare_model(r, name, mixed_model(values(trials, value), x, nested(trials)),
                sequential_contrasts(x));
}

void compare_two_factors(Answers& r, const std::vector<Trial>& trials) {
  MatrixXd x(std::ssize(trials), 5);
  x << conditions(trials), novices(trials), MatrixXd::Zero(std::ssize(trials), 2);
  x.col(3) = x.col(0).cwiseProduct(x.col(2));
  x.col(4) = x.col(1).cwiseProduct(x.col(2));
  MatrixXd interaction = MatrixXd::Zero(2, 6);
  interaction.rightCols(2).setIdentity();
  compare_model(
      r, "two factors",
      mixed_model(values(trials, [](const Trial& t) { return t.score; }), x, nested(trials)),
      interaction);
}

void compare_crossed(Answers& r, const std::vector<Trial>& trials) {
  MatrixXd x(std::ssize(trials), 3);
  x << conditions(trials), novices(trials);
  MatrixXd contrasts = MatrixXd::Zero(2, 4);
  contrasts.middleCols(1, 2).setIdentity();
  const auto response = values(trials, [](const Trial& t) {
    return t.score + 30.0 * static_cast<double>(t.item() * 5 % 13);
  });
  compare_model(r, "crossed",
                mixed_model(response, x,
                            {grouped(trials, [](const Trial& t) { return t.subject; }),
                             grouped(trials, [](const Trial& t) { return t.item(); })}),
                contrasts);
}

const Topic kMixedTerms("mixed_terms", [](Answers& r) {
  const auto score = [](const Trial& t) { return t.score; };
  const auto missing = [](const Trial& t) { return t.subject == 5 && t.place == 2; };
  const auto all = trials([](const Trial&) { return true; });
  compare_nested(r, "balanced", all, score);
  const auto some = trials([&](const Trial& t) {
    return t.row % 7 != 0 && !(t.subject == 3 && t.trial > 5.0) && !missing(t);
  });
  compare_nested(r, "unbalanced", some, score);
  compare_two_factors(r, some);
  compare_crossed(r, some);
  compare_nested(r, "all at 0", all, [](const Trial& t) { return t.even(); });
  compare_nested(r, "two at 0", all, [](const Trial& t) { return t.people(); });
  compare_nested(r, "one at 0", all, [](const Trial& t) { return t.cells(); });
  compare_nested(r, "one at 0 unbalanced",
                 trials([&](const Trial& t) { return t.row % 5 != 0 && !missing(t); }),
                 [](const Trial& t) { return t.cells(); });
});

}  // namespace
}  // namespace haptrial::analysis::reference::mixed_terms_reference
