#include <fmt/format.h>

#include <cmath>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string tested(const Coefficient& c) {
  return fmt::format("t({:.1f}) = {:.2f}, {}", c.df, c.t, p_value(c.p));
}

std::string tested(const Defined<JointTest>& test) {
  if (!test) {
    return "not defined, because " + test.because();
  }
  return fmt::format("F({:.0f}, {:.1f}) = {:.2f}, {}", test->df_numerator, test->df_denominator,
                     test->f, p_value(test->p));
}

std::vector<std::string> model_row(const std::string& effect, const Coefficient& c) {
  return {effect, number(c.estimate), fmt::format("{} to {}", number(c.low), number(c.high)),
          tested(c)};
}

std::string sphericity_verdict(const RepeatedAnova& anova) {
  constexpr double kAlpha = 0.05;
  const auto& mauchly = anova.sphericity.mauchly;
  if (!mauchly) {
    return "Whether they do could not be tested; trust the tests above.";
  }
  return mauchly->p < kAlpha
             ? "Mauchly's test above says that they do not, so the p values of this model are not "
               "to be trusted; take those of the tests above."
             : "Mauchly's test above does not speak against it.";
}

void add_terms(Document& document, const StudyMixed& study) {
  Rows rows;
  for (std::size_t k = 0; k < study.terms.size(); ++k) {
    const StudyTerm& term = study.terms[k];
    rows.push_back({capitalized(term.words), term.notation, std::to_string(term.groups),
                    number(std::sqrt(study.model->variances[k]))});
  }
  rows.push_back({"Trial (residual)", "", std::to_string(study.model->observations),
                  number(std::sqrt(study.model->variance_within))});
  document.table({"Random intercept", "In lme4", "Groups", "Standard deviation"}, rows);
  for (const std::string& sentence : study.left_out) {
    document.paragraph(capitalized(sentence) + ".");
  }
  if (study.model->at_boundary) {
    document.paragraph(
        "A standard deviation of 0 means that those groups differ no more than chance makes them "
        "differ; the tests are those of the model without that term.");
  }
}

void add_model_effects(Document& document, const StudyMixed& study) {
  Rows rows{model_row(study.conditions[0] + " (mean)", study.model->coefficients[0])};
  for (const MixedPair& pair : study.pairs) {
    if (pair.difference) {
      auto row = model_row(pair.a + " − " + pair.b, *pair.difference);
      row.push_back(pair.holm ? p_value(*pair.holm) : "");
      rows.push_back(std::move(row));
    }
  }
  rows[0].push_back("");
  document.table({"Effect", "Estimate", "95 % CI", "Test (Satterthwaite)", "After Holm"}, rows);
}

}  // namespace

void add_mixed(Document& document, const StudyStatistics& statistics) {
  document.subheading("Mixed model: every trial");
  const StudyMixed& study = statistics.mixed;
  if (!study.model) {
    document.paragraph("Not defined, because " + study.model.because() + ".");
    return;
  }
  document.paragraph(fmt::format(
      "A linear mixed model of recall error by condition over {}, fitted by restricted maximum "
      "likelihood. Random intercepts allow for trials that resemble each other because they share "
      "a participant, a condition of that participant or a block. Participants with missing trials "
      "are kept. Do the conditions differ? {}.",
      counted(study.model->observations, "trial"), tested(study.omnibus)));
  if (statistics.repeated && statistics.table.factors.size() == 1 &&
      statistics.conditions.size() > 2) {
    document.paragraph(
        "The model takes the differences between any two conditions to vary alike "
        "(sphericity). " +
        sphericity_verdict(*statistics.repeated));
  }
  add_model_effects(document, study);
  add_terms(document, study);
}

}  // namespace haptrial::analysis
