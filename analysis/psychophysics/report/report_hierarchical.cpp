#include "analysis/psychophysics/report/report_hierarchical.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "analysis/document/number.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

using hierarchical::HierarchicalFit;
using hierarchical::Posterior;

constexpr double kUnusualShare = 0.05;  // of a predictive p

std::string unit_after(const std::string& unit) { return unit.empty() ? "" : " " + unit; }

std::string chains_words(const HierarchicalFit& fit) {
  return fmt::format(
      "{} chains of {} draws after {} of warm-up; R-hat at most {:.3f}, at least "
      "{:.0f} effective draws",
      fit.chains, fit.draws, fit.warm_up, fit.r_hat, std::floor(fit.effective));
}

std::string refusal(const HierarchicalFit& fit) {
  return fmt::format(
      "The chains of the hierarchical functions have not converged, so none of their numbers is "
      "stated: R-hat up to {:.3f} (below {} is needed), at least {:.0f} effective draws ({} are "
      "needed) after {} draws of each of {} chains. Answers that tell too little, or a lapse rate "
      "that is free without need, are the usual reasons",
      fit.r_hat, hierarchical::kMostRHat, std::floor(fit.effective), hierarchical::kFewestEffective,
      fit.draws, fit.chains);
}

std::string thresholds_words(const TrialsResult& result, const HierarchicalFunctions& all) {
  const psychometric::Axis& axis = result.plan.function.axis;
  std::vector<std::string> words;
  for (std::size_t c = 0; c < all.conditions.size(); ++c) {
    const Posterior& p = all.fit.conditions[c].threshold;
    words.push_back(fmt::format(
        "{}{}{}", number_with_interval(axis.level(p.median), axis.level(p.low), axis.level(p.high)),
        unit_after(axis.unit), all.conditions[c].empty() ? "" : " under " + all.conditions[c]));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string differences_words(const TrialsResult& result, const HierarchicalFunctions& all) {
  std::string words;
  for (const hierarchical::ConditionDifference& each : all.fit.differences) {
    const Posterior& d = each.threshold;
    const bool above = each.share_above >= 0.5;
    const double share = above ? each.share_above : 1.0 - each.share_above;
    words += fmt::format("; {} less {}: {}{}, {} with a posterior probability of {}",
                         all.conditions[each.second], all.conditions[each.first],
                         number_with_interval(d.median, d.low, d.high),
                         unit_after(result.plan.function.axis.x_unit()), above ? "higher" : "lower",
                         share > 0.999 ? "above 0.999" : fmt::format("{:.3f}", share));
  }
  return words;
}

std::string prior_words(const TrialsResult& result, const HierarchicalFit& fit) {
  std::string words =
      "Priors, with s the range and c the middle of all levels on the axis: the mean threshold of "
      "a condition is normal(c, s), its mean ln width normal(ln s - 0.7, 1.5); the spreads are "
      "half-t with three degrees of freedom and the scales s / 4 and 0.5.";
  if (fit.lapse_sought) {
    words += fmt::format(
        " The logit of a participant's lapse rate as a share of {:g} has a normal(-2, 1) mean and "
        "a half-t spread with the scale 0.5.",
        result.plan.lapse.high);
  }
  if (fit.guess_sought) {
    words += " The same of the guess rate has a normal(-1, 1) mean.";
  }
  return words;
}

void add_replications(Document& document, const HierarchicalFunctions& all) {
  std::vector<std::string> unusual;
  for (std::size_t person = 0; person < all.participants.size(); ++person) {
    if (all.fit.people[person].predictive_p < kUnusualShare) {
      unusual.push_back(all.participants[person]);
    }
  }
  document.paragraph(fmt::format(
      "Posterior predictive check: the p of a participant is the share of answers drawn from the "
      "posterior whose deviance is at least that of the answers given. It is below {:g} in {} of "
      "{}{}.",
      kUnusualShare, unusual.size(), counted(all.participants.size(), "participant"),
      unusual.empty() ? ""
                      : fmt::format(" ({}), whose answers scatter more than a function with "
                                    "constant parameters explains",
                                    fmt::join(unusual, ", "))));
}

}  // namespace

std::string hierarchical_sentence(const TrialsResult& result) {
  if (!result.hierarchical) {
    return {};
  }
  if (!*result.hierarchical) {
    return "Hierarchical functions are not defined, because " + result.hierarchical->because();
  }
  const HierarchicalFunctions& all = **result.hierarchical;
  if (!all.fit.converged) {
    return refusal(all.fit);
  }
  return fmt::format(
      "Hierarchical Bayesian functions ({}, posterior medians and central 95 % intervals): mean "
      "threshold {}{} ({})",
      counted(all.participants.size(), "participant"), thresholds_words(result, all),
      differences_words(result, all), chains_words(all.fit));
}

void add_hierarchical(Document& document, const TrialsResult& result) {
  if (!result.hierarchical) {
    return;
  }
  document.subheading("Hierarchical Bayesian functions");
  document.paragraph(hierarchical_sentence(result) + ".");
  if (!*result.hierarchical || !(**result.hierarchical).fit.converged) {
    return;
  }
  const HierarchicalFunctions& all = **result.hierarchical;
  add_table(document, hierarchical_group_findings(result), false);
  add_table(document, hierarchical_people_findings(result), true);
  document.paragraph(fmt::format(
      "One model of all answers: the thresholds and the logarithms of the widths of participants "
      "are normal around the means of the conditions, with a spread between people{}; a "
      "participant has one lapse rate under all conditions{}. A width is that from {:g} to {:g} of "
      "the function. Chains are elliptical slice samplers.",
      all.fit.has_within ? " and one of each person from condition to condition" : "",
      all.fit.guess_sought ? ", and one guess rate" : "", result.plan.function.tail,
      1.0 - result.plan.function.tail));
  document.paragraph(prior_words(result, all.fit));
  add_replications(document, all);
}

namespace {

const HierarchicalFunctions* converged(const TrialsResult& result) {
  const auto& made = result.hierarchical;
  return made && *made && (**made).fit.converged ? &**made : nullptr;
}

void add_text(FindingRow& row, const std::string& name, const std::string& title,
              const std::string& word, JsonForm form = JsonForm::kPlain) {
  row.push_back(Finding{.name = name, .title = title, .value = word, .form = form});
}

void add_posterior(FindingRow& row, const std::string& name, const std::string& title,
                   const Posterior& p, const std::string& unit, const std::string& csv) {
  row.push_back(Finding{.name = name,
                        .title = title,
                        .value = p.median,
                        .low = p.low,
                        .high = p.high,
                        .unit = unit,
                        .csv = csv,
                        .form = JsonForm::kEstimate});
}

void add_diagnostics(FindingRow& row, double r_hat, double effective) {
  row.push_back(
      Finding{.name = "r_hat", .title = "R-hat", .value = r_hat, .form = JsonForm::kPlain});
  row.push_back(Finding{.name = "effective_draws",
                        .title = "effective draws",
                        .value = static_cast<std::int64_t>(effective),
                        .form = JsonForm::kPlain});
}

/// The worst of several numbers of one row.
void add_worst(FindingRow& row, std::initializer_list<const Posterior*> all) {
  double r_hat = 1.0, effective = std::numeric_limits<double>::infinity();
  for (const Posterior* each : all) {
    r_hat = std::max(r_hat, each->chains.r_hat);
    effective = std::min(effective, each->chains.effective);
  }
  add_diagnostics(row, r_hat, effective);
}

Posterior as_level(Posterior p, const psychometric::Axis& axis) {
  for (double* each : {&p.median, &p.low, &p.high}) {
    *each = axis.level(*each);
  }
  return p;
}

/// Rows of the group's table.
class GroupRows {
 public:
  GroupRows(const TrialsResult& result, FindingTable& table) : result_(result), table_(table) {}

  void add(const std::string& quantity, const std::string& title, const std::string& condition,
           const Posterior& posterior, const std::string& unit) {
    FindingRow& row = table_.rows.emplace_back();
    add_text(row, "participant", "", "all", JsonForm::kAbsent);
    add_text(row, "source", "", "hierarchical", JsonForm::kAbsent);
    add_text(row, "quantity", "", quantity);
    add_text(row, "", "quantity", unit.empty() ? title : fmt::format("{} ({})", title, unit),
             JsonForm::kAbsent);
    add_text(row, "condition", "condition", condition.empty() ? "all" : condition);
    add_posterior(row, "posterior", "median", posterior, unit,
                  condition.empty() ? quantity : fmt::format("{}, {}", quantity, condition));
    add_diagnostics(row, posterior.chains.r_hat, posterior.chains.effective);
  }

  void add_conditions(const HierarchicalFunctions& all) {
    const psychometric::Axis& axis = result_.plan.function.axis;
    for (std::size_t c = 0; c < all.conditions.size(); ++c) {
      add("mean_threshold", "mean threshold", all.conditions[c],
          as_level(all.fit.conditions[c].threshold, axis), axis.unit);
    }
    for (std::size_t c = 0; c < all.conditions.size(); ++c) {
      add("mean_width", "typical width", all.conditions[c], all.fit.conditions[c].width,
          axis.x_unit());
    }
    for (const hierarchical::ConditionDifference& each : all.fit.differences) {
      const std::string pair =
          fmt::format("{} less {}", all.conditions[each.second], all.conditions[each.first]);
      add("threshold_difference", "difference of mean thresholds", pair, each.threshold,
          axis.x_unit());
      add("width_ratio", "ratio of typical widths",
          fmt::format("{} over {}", all.conditions[each.second], all.conditions[each.first]),
          each.width_ratio, "");
    }
  }

  void add_spreads(const HierarchicalFunctions& all) {
    const std::string unit = result_.plan.function.axis.x_unit();
    add("threshold_spread", "standard deviation of thresholds between people", "",
        all.fit.thresholds.between, unit);
    add("log_width_spread", "standard deviation of ln width between people", "",
        all.fit.log_widths.between, "");
    if (all.fit.has_within) {
      add("threshold_difference_spread",
          "standard deviation of a person's difference of thresholds between two conditions", "",
          all.fit.thresholds.within, unit);
      add("log_width_difference_spread",
          "standard deviation of a person's difference of ln width between two conditions", "",
          all.fit.log_widths.within, "");
    }
    if (all.fit.lapse_sought) {
      add("lapse", "typical lapse rate", "", all.fit.lapse, "");
    }
    if (all.fit.guess_sought) {
      add("guess", "typical guess rate", "", all.fit.guess, "");
    }
  }

 private:
  const TrialsResult& result_;
  FindingTable& table_;
};

FindingRow person_row(const TrialsResult& result, const HierarchicalFunctions& all,
                      std::size_t person, std::size_t function) {
  const psychometric::Axis& axis = result.plan.function.axis;
  const hierarchical::PersonPosterior& own = all.fit.people[person];
  const hierarchical::FunctionPosterior& psi = all.fit.functions[function];
  const std::size_t condition = all.condition_of[function];
  FindingRow row;
  add_text(row, "participant", "participant", all.participants[person]);
  for (std::size_t f = 0; f < all.levels[condition].size(); ++f) {
    add_text(row, "by/" + result.plan.by[f], "", all.levels[condition][f], JsonForm::kAbsent);
  }
  add_text(row, "source", "", "hierarchical", JsonForm::kAbsent);
  add_text(row, "condition", "condition", all.conditions[condition]);
  add_posterior(row, "threshold", "threshold", as_level(psi.threshold, axis), axis.unit,
                "threshold");
  add_posterior(row, "width", "width", psi.width, axis.x_unit(), "width");
  const Posterior known{0.0, 0.0, 0.0, {1.0, std::numeric_limits<double>::infinity()}};
  if (all.fit.lapse_sought) {
    add_posterior(row, "lapse", "lapse rate", own.lapse, "", "lapse");
  }
  if (all.fit.guess_sought) {
    add_posterior(row, "guess", "guess rate", own.guess, "", "guess");
  }
  add_worst(row, {&psi.threshold, &psi.width, all.fit.lapse_sought ? &own.lapse : &known,
                  all.fit.guess_sought ? &own.guess : &known});
  row.push_back(Finding{.name = "predictive_p",
                        .title = "p of replicated answers",
                        .value = own.predictive_p,
                        .form = JsonForm::kPlain});
  return row;
}

}  // namespace

FindingTable hierarchical_group_findings(const TrialsResult& result) {
  FindingTable table{"hierarchical_group", "Posterior of the group"};
  if (const HierarchicalFunctions* all = converged(result)) {
    GroupRows rows(result, table);
    rows.add_conditions(*all);
    rows.add_spreads(*all);
  }
  return table;
}

FindingTable hierarchical_people_findings(const TrialsResult& result) {
  FindingTable table{"hierarchical_people", "Posterior of each participant"};
  if (const HierarchicalFunctions* all = converged(result)) {
    for (std::size_t person = 0; person < all->participants.size(); ++person) {
      for (const std::size_t function : all->fit.people[person].series) {
        table.rows.push_back(person_row(result, *all, person, function));
      }
    }
  }
  return table;
}

}  // namespace haptrial::analysis::trials
