#include "analysis/psychophysics/report/report_hierarchical.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

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

}  // namespace haptrial::analysis::trials
