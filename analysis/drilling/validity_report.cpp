#include "analysis/drilling/validity_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/drilling/validity_figures.h"
#include "analysis/wording.h"

namespace haptrial::analysis::drilling {

const char* const kRehearsal =
    "SIMULATED: the participants or the raters of this study are programs. It is a rehearsal of "
    "the "
    "pipeline and proves nothing about people.";

namespace {

using Row = std::vector<std::string>;

std::string undefined(const std::string& because) { return "not defined, because " + because; }

std::string word(const Defined<double>& p) { return p ? p_value(*p) : "–"; }

std::string correlation_word(const Defined<Correlation>& c) {
  return c ? fmt::format("{:.2f}, {}", c->r, p_value(c->p)) : "–";
}

std::string interval_word(const Defined<MeanInterval>& m) {
  return m ? fmt::format("{} [{}, {}]", number(m->mean), number(m->low), number(m->high)) : "–";
}

std::string area_word(const Defined<Roc>& roc) {
  if (!roc) {
    return "–";
  }
  return roc->interval ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", roc->area, roc->interval->low,
                                     roc->interval->high)
                       : fmt::format("{:.2f}", roc->area);
}

std::string form_word(const Defined<IntraclassForm>& form) {
  return form ? fmt::format("{:.2f}, 95 % CI {:.2f} to {:.2f}, F({:.0f}, {:.0f}) = {}, {}",
                            form->value, form->low, form->high, form->df_targets, form->df_error,
                            number(form->f), p_value(form->p))
              : undefined(form.because());
}

std::string mixed_word(const Contrast& c) {
  if (!c.mixed) {
    return undefined(c.mixed.because());
  }
  const Coefficient& b = c.mixed->coefficients[1];
  return fmt::format("experts are {} higher, 95 % CI {} to {}; t({:.1f}) = {:.2f}, {}{}",
                     number(b.estimate), number(b.low), number(b.high), b.df, b.t,
                     p_value(*c.mixed_p),
                     c.mixed->at_boundary ? " (no variance between participants)" : "");
}

class Report {
 public:
  Report(const ValidityResult& result, const std::vector<Drawing>& drawings)
      : result_(result), v_(result.validity), drawings_(drawings) {}

  Document made() {
    document_.title = result_.title;
    document_.simulated = v_.simulated;
    document_.subtitle = fmt::format(
        "{} by {} in {}, {} of them rated.", counted(result_.procedures.size(), "procedure"),
        counted(v_.participant.empty()
                    ? 0
                    : *std::max_element(v_.participant.begin(), v_.participant.end()) + 1,
                "participant"),
        counted(v_.plan.groups.size(), "group"), v_.rated);
    rehearsal();
    document_.points(summary_lines(result_));
    add_design();
    add_ratings();
    add_metrics();
    add_forces();
    add_regions();
    add_combined();
    add_quality();
    add_methods();
    return std::move(document_);
  }

 private:
  void rehearsal() {
    if (v_.simulated) {
      document_.alarm(kRehearsal);
    }
  }
  void section(const std::string& text) {
    document_.heading(v_.simulated ? text + " (simulated)" : text);
  }
  void picture(const std::string& name) {
    for (const Drawing& drawing : drawings_) {
      if (drawing.figure.name == name) {
        document_.picture(drawing);
      }
    }
  }

  void add_design();
  void add_ratings();
  void add_metrics();
  void add_forces();
  void add_regions();
  void add_combined();
  void add_quality();
  void add_methods();

  const ValidityResult& result_;
  const Validity& v_;
  const std::vector<Drawing>& drawings_;
  Document document_;
};

void Report::add_design() {
  section("Participants");
  std::vector<Row> rows;
  for (const std::string& group : v_.plan.groups) {
    std::vector<std::size_t> people;
    std::size_t procedures = 0;
    for (std::size_t i = 0; i < result_.procedures.size(); ++i) {
      if (result_.procedures[i].group == group) {
        ++procedures;
        people.push_back(v_.participant[i]);
      }
    }
    std::sort(people.begin(), people.end());
    people.erase(std::unique(people.begin(), people.end()), people.end());
    const bool expert =
        std::count(v_.plan.expert_groups.begin(), v_.plan.expert_groups.end(), group) > 0;
    rows.push_back({group, expert ? "with experience" : "novices", std::to_string(people.size()),
                    std::to_string(procedures)});
  }
  document_.table({"group", "counted among", "participants", "procedures"}, rows);
  for (const std::string& remark : result_.remarks) {
    document_.paragraph(remark);
  }
}

void Report::add_ratings() {
  section("Ratings");
  if (v_.rated == 0) {
    document_.paragraph(
        "Nothing is rated yet. haptrial rate prepare makes what raters need, haptrial rate import "
        "reads their sheets.");
    return;
  }
  document_.paragraph(fmt::format(
      "{} scored from 1 to 5 without knowing whose procedure it was{}; a procedure's rating is "
      "the mean over raters.",
      counted(v_.raters.size(), "rater"), v_.simulated_raters ? " (the raters are programs)" : ""));
  picture("figure-16-ratings");
  std::vector<Row> rows;
  for (const GroupValues& g : v_.rating_groups) {
    rows.push_back({g.group, std::to_string(g.participants), std::to_string(g.procedures),
                    interval_word(g.pooled), interval_word(g.participant_means)});
  }
  document_.table({"group", "participants", "procedures", "mean over procedures [95 % CI]",
                   "mean over participants' means [95 % CI]"},
                  rows);
  const Contrast& c = v_.rating_contrast;
  document_.table({"test: experts are rated higher (one-tailed)", "result"},
                  {{"Student's t over procedures, as published", t_result(c.pooled)},
                   {"Welch's t over participants' means", t_result(c.means)},
                   {"mixed model with repeated procedures", mixed_word(c)},
                   {"Hedges' g of participants' means", effect(c.g)},
                   {"area under the ROC curve", area_word(c.roc)}});
  document_.subheading("Agreement between raters");
  if (!v_.agreement) {
    document_.paragraph(
        fmt::format("The intraclass correlation is {}.", undefined(v_.agreement.because())));
    return;
  }
  const Intraclass& a = *v_.agreement;
  document_.table({"intraclass correlation", "result"},
                  {{"one rater, agreement, ICC(2,1)", form_word(a.random_raters)},
                   {"mean of the raters, agreement, ICC(2,k)", form_word(a.random_raters_mean)},
                   {"one rater, consistency, ICC(3,1)", form_word(a.fixed_raters)},
                   {"mean of the raters, consistency, ICC(3,k)", form_word(a.fixed_raters_mean)},
                   {"one rater, raters not identified, ICC(1,1)", form_word(a.one_way)},
                   {"mean, raters not identified, ICC(1,k)", form_word(a.one_way_mean)}});
}

void Report::add_metrics() {
  section("Automatic metrics");
  for (const StudyPicture& shown : result_.pictures) {
    picture(shown.name);
  }
  std::vector<Row> groups, relations;
  for (const MetricValidity& m : v_.metrics) {
    const std::string name =
        m.kind.unit == "1" ? m.kind.title : fmt::format("{} ({})", m.kind.title, m.kind.unit);
    const auto& experts = *(m.groups.end() - 2);
    const char* expected = m.kind.experts == Expected::kHigher  ? "higher"
                           : m.kind.experts == Expected::kLower ? "lower"
                                                                : "–";
    groups.push_back({name, expected, interval_word(experts.participant_means),
                      interval_word(m.groups.back().participant_means), word(m.contrast.mixed_p),
                      word(m.contrast_holm), area_word(m.contrast.roc)});
    relations.push_back({name, std::to_string(m.defined), correlation_word(m.relation.pooled),
                         correlation_word(m.relation.means), word(m.relation_holm),
                         correlation_word(m.relation.ranks)});
  }
  document_.subheading("Experts and novices");
  document_.table({"metric", "experts expected", "experts' mean [95 % CI]",
                   "novices' mean [95 % CI]", "p, mixed model", "p, Holm", "ROC area [95 % CI]"},
                  groups);
  document_.paragraph(
      "Means are over participants' means. p is one-tailed where an end is expected, else "
      "two-tailed; Holm's is for all metrics of the table together. The ROC area is that of "
      "experts being where they are expected, or higher where nothing is.");
  if (v_.rated == 0) {
    return;
  }
  document_.subheading("Metrics and ratings");
  picture("figure-19-visibility");
  picture("figure-21-region");
  document_.table({"metric", "procedures", "R over procedures, as published",
                   "R over participants' means", "p of that, Holm", "Spearman's rho of the means"},
                  relations);
}

void Report::add_forces() {
  if (result_.structure.empty()) {
    return;
  }
  section("Forces near vital structures");
  picture("figure-20-force-near-structure");
  picture("speed-near-structure");
}

void Report::add_regions() {
  section("The region's score by how it is trained");
  document_.paragraph(
      "The published score is tested on the procedures that it was trained on, which makes each "
      "look like its own group. Here it is trained without the participant whom it scores, and "
      "without one of the other side, so that both sides stay as large whoever is left out.");
  std::vector<Row> rows;
  for (const RegionWay& way : v_.regions) {
    rows.push_back(
        {way.name, correlation_word(way.pooled), correlation_word(way.means), area_word(way.roc)});
  }
  document_.table({"counted and trained", "R with ratings over procedures",
                   "R over participants' means", "ROC area [95 % CI]"},
                  rows);
}

void Report::add_combined() {
  section("All metrics together");
  picture("roc-experts-novices");
  const Combined& c = v_.combined;
  if (!c.fit) {
    document_.paragraph(fmt::format("The combined score is {}.", undefined(c.fit.because())));
    return;
  }
  const auto r_word = [](const Agreement& a) {
    return a.r ? fmt::format("{:.2f}", *a.r) : std::string("–");
  };
  document_.table({"ridge regression onto the ratings", "R", "RMSE (points)", "ROC area [95 % CI]"},
                  {{"each participant predicted from the others", r_word(c.fit->validated),
                    number(c.fit->validated.rmse), area_word(c.roc)},
                   {"tested on the data that were fitted", r_word(c.fit->resubstitution),
                    number(c.fit->resubstitution.rmse), area_word(c.resubstitution_roc)}});
  document_.paragraph(fmt::format(
      "Predicting from the metrics takes {:.0f} % off the squared error of predicting the other "
      "participants' mean rating (0 or less: the metrics add nothing). The penalty of the fit to "
      "all is {}.",
      100.0 * c.fit->gain, number(c.fit->lambda)));
  std::vector<Row> rows;
  for (std::size_t i = 0; i < c.metrics.size(); ++i) {
    rows.push_back({metric_of(v_, c.metrics[i])->kind.title,
                    fmt::format("{:+.3f}", c.fit->fit.slopes[static_cast<Eigen::Index>(i)])});
  }
  document_.table({"metric", "points per standard deviation"}, rows, "Weights of the metrics");
  if (!c.left_out.empty()) {
    document_.paragraph(
        fmt::format("Left out, because a rated procedure has none or all have the same: {}.",
                    fmt::join(c.left_out, ", ")));
  }
}

void Report::add_quality() {
  std::vector<std::string> broken;
  for (const ProcedureSummary& p : result_.procedures) {
    if (!p.completed) {
      broken.push_back(fmt::format("{} procedure {}", p.session, p.number));
    }
  }
  if (!broken.empty()) {
    section("Procedures that were not completed");
    document_.paragraph(
        fmt::format("They are part of everything above: {}.", fmt::join(broken, ", ")));
  }
}

void Report::add_methods() {
  section("Methods");
  document_.paragraph(
      "The procedures of one participant depend on each other. The published analysis takes them "
      "as independent, so that its p values are too small; it is given for comparison. The mixed "
      "model has a random intercept for each participant, fixed effects of experience and of the "
      "procedure's number, REML and Satterthwaite's degrees of freedom. Correlations over "
      "participants' means have one pair of values for each participant.");
  document_.paragraph(
      "Areas under ROC curves count all pairs, ties half; their intervals are DeLong's with "
      "Obuchowski's sums over participants. The combined score is a ridge regression; "
      "standardising, the choice of the penalty and the fit see nothing of the participant who is "
      "predicted. The region's score, one of its metrics, is trained on groups, never on ratings; "
      "those of the other participants do know the region of the one who is left out.");
  document_.paragraph(
      "The intraclass correlations follow Shrout and Fleiss (1979) over the procedures that every "
      "rater scored. A rater's scores of the two procedures of one participant count as two.");
  rehearsal();
}

}  // namespace

std::vector<std::string> summary_lines(const ValidityResult& result) {
  const Validity& v = result.validity;
  const std::string mark = v.simulated ? "Simulated: " : "";
  std::vector<std::string> lines;
  if (v.rated == 0) {
    lines.push_back(
        fmt::format("{}{}: not rated yet.", mark, counted(result.procedures.size(), "procedure")));
  } else {
    const auto& groups = v.rating_groups;
    lines.push_back(fmt::format("{}ratings with experience {}; of novices {} (over procedures).",
                                mark, mean_with_interval((groups.end() - 2)->pooled),
                                mean_with_interval(groups.back().pooled)));
    lines.push_back(fmt::format("{}experts rated higher, as published: {}; mixed model: {}.", mark,
                                t_result(v.rating_contrast.pooled), mixed_word(v.rating_contrast)));
  }
  for (const char* name : {"visible_share", "region_log_ratio"}) {
    const MetricValidity* m = metric_of(v, name);
    if (m != nullptr && m->relation.pooled) {
      lines.push_back(
          fmt::format("{}{} and ratings: R = {} over procedures; R = {} over "
                      "participants' means.",
                      mark, m->kind.title, correlation_word(m->relation.pooled),
                      correlation_word(m->relation.means)));
    }
  }
  if (v.combined.fit && v.combined.fit->validated.r && v.combined.fit->resubstitution.r) {
    lines.push_back(fmt::format(
        "{}all metrics together: R = {:.2f} for participants left out, {:.2f} on the fitted data; "
        "ROC area {}.",
        mark, *v.combined.fit->validated.r, *v.combined.fit->resubstitution.r,
        area_word(v.combined.roc)));
  }
  if (v.simulated) {
    lines.emplace_back(
        "A rehearsal of the pipeline with programs: it proves nothing about people.");
  }
  return lines;
}

Document validity_report(const ValidityResult& result, const std::vector<Drawing>& drawings) {
  return Report(result, drawings).made();
}

}  // namespace haptrial::analysis::drilling
