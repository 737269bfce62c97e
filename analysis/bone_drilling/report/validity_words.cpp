#include "analysis/bone_drilling/report/validity_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/document/number.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::drilling {
namespace {

std::string difference_word(double difference, double low, double high, double df, double t,
                            double p) {
  return fmt::format("difference {}, 95 % CI {} to {}, t({:.1f}) = {:.2f}, {}", number(difference),
                     number(low), number(high), df, t, p_value(p));
}

}  // namespace

std::string undefined(const std::string& because) { return "not defined, because " + because; }

std::string mean_word(const GroupValues& group) {
  return !group.participant_means && group.mean ? number(*group.mean)
                                                : interval_word(group.participant_means);
}

std::string uneven_raters(const Validity& v) {
  if (std::all_of(v.scored.begin(), v.scored.end(), [&](std::size_t n) { return n == v.rated; })) {
    return "";
  }
  std::vector<std::string> counts;
  for (std::size_t r = 0; r < v.raters.size(); ++r) {
    counts.push_back(fmt::format("{} {}", v.raters[r], v.scored[r]));
  }
  return fmt::format(
      "Not every rater scored all of the {} rated procedures ({}), so a difference of ratings may "
      "be one of raters",
      v.rated, fmt::join(counts, ", "));
}

std::string word(const Defined<double>& p) { return p ? p_value(*p) : "–"; }

std::string correlation_word(const Defined<Correlation>& c) {
  return c ? fmt::format("{:.2f}, {}", c->r, p_value(c->p)) : "–";
}

std::string relation_word(const Validity& v, const MetricValidity& metric) {
  const auto& means = metric.relation.means;
  return means && metric.relation_holm
             ? fmt::format("{:.2f} ({} after Holm's adjustment over {})", means->r,
                           p_value(*metric.relation_holm), counted(relations_of(v), "metric"))
             : "–";
}

std::string area_word(const Defined<Roc>& roc) {
  if (!roc) {
    return "–";
  }
  return roc->interval ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", roc->area, roc->interval->low,
                                     roc->interval->high)
                       : fmt::format("{:.2f}", roc->area);
}

std::string form_word(const Defined<IntraclassForm>& form, bool apart) {
  if (!form) {
    return undefined(form.because());
  }
  const std::string value = fmt::format("{:.2f}", form->value);
  return apart ? fmt::format("{}, 95 % CI {:.2f} to {:.2f}, F({:.0f}, {:.0f}) = {}, {}", value,
                             form->low, form->high, form->df_targets, form->df_error,
                             number(form->f), p_value(form->p))
               : value;
}

std::string welch_word(const Contrast& c) {
  return c.means ? difference_word(c.means->difference, c.means->low, c.means->high, c.means->df,
                                   c.means->t, c.means->p)
                 : undefined(c.means.because());
}

std::string mixed_word(const Contrast& c) {
  if (!c.mixed) {
    return undefined(c.mixed.because());
  }
  const Coefficient& b = c.mixed->coefficients[1];
  return difference_word(b.estimate, b.low, b.high, b.df, b.t, *c.mixed_p) +
         (c.mixed->at_boundary ? " (no variance between participants)" : "");
}

std::string error_word(const CrossValidated& fit) {
  return fmt::format("{:.0f} % {} than that of the other participants' mean rating",
                     100.0 * std::abs(fit.gain), fit.gain < 0.0 ? "higher" : "lower");
}

std::string name_of(const MetricKind& kind) {
  return kind.unit == "1" ? kind.title : fmt::format("{} ({})", kind.title, kind.unit);
}

std::vector<const GroupValues*> shown_groups(const Validity& v) {
  const auto experts = v.plan.expert_groups.size();
  std::vector<const GroupValues*> shown;
  for (std::size_t g = 0; g < v.plan.groups.size(); ++g) {
    shown.push_back(&v.rating_groups[g]);
  }
  if (experts > 1) {
    shown.push_back(&*(v.rating_groups.end() - 2));
  }
  if (v.plan.groups.size() - experts > 1) {
    shown.push_back(&v.rating_groups.back());
  }
  return shown;
}

std::size_t contrasts_of(const Validity& v) {
  return static_cast<std::size_t>(
      std::count_if(v.metrics.begin(), v.metrics.end(),
                    [](const auto& m) { return static_cast<bool>(m.contrast_holm); }));
}

std::size_t relations_of(const Validity& v) {
  return static_cast<std::size_t>(
      std::count_if(v.metrics.begin(), v.metrics.end(),
                    [](const auto& m) { return static_cast<bool>(m.relation_holm); }));
}

}  // namespace haptrial::analysis::drilling
