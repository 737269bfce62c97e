#include "analysis/bone_drilling/report/validity_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "analysis/bone_drilling/report/achieved_section.h"
#include "analysis/bone_drilling/report/field_section.h"
#include "analysis/bone_drilling/report/nerve_section.h"
#include "analysis/bone_drilling/report/phase_section.h"
#include "analysis/bone_drilling/report/validity_figures.h"
#include "analysis/bone_drilling/report/validity_summary.h"
#include "analysis/bone_drilling/report/validity_words.h"
#include "analysis/learning/learned_study.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::drilling {

const char* const kSimulatedValidity =
    "SIMULATED: the participants or the raters of this study are programs. It is a rehearsal of "
    "the pipeline and proves nothing about people.";

namespace {

using Row = std::vector<std::string>;

class Report {
 public:
  Report(const ValidityResult& result, const std::vector<Drawing>& drawings)
      : result_(result), v_(result.validity), drawings_(drawings) {}

  Document made() {
    document_.title = result_.title;
    document_.simulated = v_.simulated;
    document_.subtitle =
        fmt::format("{} ({} rated) by {} in {}.", counted(result_.procedures.size(), "procedure"),
                    v_.rated, counted(count_of(&ProcedureSummary::participant), "participant"),
                    counted(count_of(&ProcedureSummary::group), "group"));
    add_simulation_alarm();
    document_.points(summary_lines(result_));
    add_design();
    add_learning_section(document_, result_.learned, drawings_, v_.simulated);
    add(nerve_findings(result_.nerves));
    add_hint_section(document_, result_.hints, result_.hint_effects, v_.simulated);
    add(crossing_findings(result_.crossings));
    add_achieved_section(document_, result_);
    add(phase_findings(result_));
    if (compares_experts() || v_.rated > 0) {
      add_ratings();
    }
    add(checklist_findings(result_.checked, result_.procedures, v_.plan.groups));
    if (compares_experts()) {
      add_metrics();
    }
    add_forces();
    if (compares_experts()) {
      add_regions();
      add_combined();
    }
    add_unknown();
    add_tears();
    add(field_findings(result_.procedures));
    add_quality();
    if (compares_experts()) {
      add_published();
      add_methods();
    }
    return std::move(document_);
  }

 private:
  /// A study of learning compares what groups learned, and nobody's experience.
  bool compares_experts() const { return result_.learned.outcomes.empty(); }
  std::size_t count_of(std::string ProcedureSummary::*name) const {
    std::set<std::string> names;
    for (const ProcedureSummary& p : result_.procedures) {
      names.insert(p.*name);
    }
    return names.size();
  }
  void add_simulation_alarm() {
    if (v_.simulated) {
      document_.alarm(kSimulatedValidity);
    }
  }
  void add(FindingList list) {
    if (list.has_values()) {
      list.heading += v_.simulated ? " (simulated)" : "";
      add_findings(document_, {list}, drawings_);
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
  void add_agreement();
  void add_metrics();
  void add_forces();
  void add_regions();
  void add_combined();
  void add_unknown();
  void add_tears();
  void add_quality();
  void add_published();
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
    std::set<std::size_t> people;
    std::size_t procedures = 0;
    for (std::size_t i = 0; i < result_.procedures.size(); ++i) {
      if (result_.procedures[i].group == group) {
        ++procedures;
        people.insert(v_.participant[i]);
      }
    }
    const bool expert =
        std::count(v_.plan.expert_groups.begin(), v_.plan.expert_groups.end(), group) > 0;
    rows.push_back({group,
                    expert               ? "with experience"
                    : compares_experts() ? "novices"
                                         : "–",
                    std::to_string(people.size()), std::to_string(procedures)});
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
      "{} scored from 1 to 5 without knowing whose procedure it was{}.{}",
      counted(v_.raters.size(), "rater"),
      v_.simulated_raters ? " (programs are among the raters)" : "",
      v_.raters.size() > 1 ? " A procedure's rating is the mean over its raters." : ""));
  if (const std::string uneven = uneven_raters(v_); !uneven.empty()) {
    document_.alarm(uneven + ".");
  }
  picture("figure-16-ratings");
  std::vector<Row> rows;
  for (const GroupValues* g : shown_groups(v_)) {
    rows.push_back(
        {g->group, std::to_string(g->participants), std::to_string(g->procedures), mean_word(*g)});
  }
  document_.table({"group", "participants", "procedures", "mean of participants' means [95 % CI]"},
                  rows);
  const Contrast& c = v_.rating_contrast;
  document_.table({"test: experts are rated higher than novices (one-tailed)", "result"},
                  {{"Welch's t over participants' means", welch_word(c)},
                   {"mixed model with repeated procedures", mixed_word(c)},
                   {"Hedges' g of participants' means", effect(c.g)},
                   {"area under the ROC curve [95 % CI]", area_word(c.roc)}});
  add_agreement();
}

void Report::add_agreement() {
  document_.subheading("Agreement between raters");
  if (!v_.agreement) {
    document_.paragraph(
        fmt::format("The intraclass correlation is {}.", undefined(v_.agreement.because())));
    return;
  }
  const Intraclass& a = *v_.agreement;
  const bool apart = count_of(&ProcedureSummary::participant) == result_.procedures.size();
  document_.table(
      {"intraclass correlation", "result"},
      {{"one rater, agreement, ICC(2,1)", form_word(a.random_raters, apart)},
       {"mean of the raters, agreement, ICC(2,k)", form_word(a.random_raters_mean, apart)},
       {"one rater, consistency, ICC(3,1)", form_word(a.fixed_raters, apart)},
       {"mean of the raters, consistency, ICC(3,k)", form_word(a.fixed_raters_mean, apart)},
       {"one rater, raters not identified, ICC(1,1)", form_word(a.one_way, apart)},
       {"mean, raters not identified, ICC(1,k)", form_word(a.one_way_mean, apart)}});
  if (!apart) {
    document_.paragraph(
        "Intervals and p values would count every procedure as independent, so there are none: "
        "participants have several.");
  }
}

void Report::add_metrics() {
  section("Automatic metrics");
  for (const StudyPicture& shown : result_.pictures) {
    picture(shown.name);
  }
  std::vector<Row> groups, relations;
  for (const MetricValidity& m : v_.metrics) {
    const auto& experts = *(m.groups.end() - 2);
    const char* expected = m.kind.experts == Expected::kHigher  ? "higher"
                           : m.kind.experts == Expected::kLower ? "lower"
                                                                : "–";
    groups.push_back({name_of(m.kind), expected, mean_word(experts), mean_word(m.groups.back()),
                      word(m.contrast_p), word(m.contrast_holm), area_word(m.contrast.roc)});
    const auto& r = m.relation.means;
    relations.push_back({name_of(m.kind), r ? std::to_string(r->count) : "–", correlation_word(r),
                         word(m.relation_holm), correlation_word(m.relation.ranks),
                         word(m.ranks_holm)});
  }
  document_.subheading("Experts and novices");
  document_.table(
      {"metric", "experts expected", "experts' mean [95 % CI]", "novices' mean [95 % CI]",
       "p, not adjusted", "p after Holm", "ROC area [95 % CI]"},
      groups);
  document_.paragraph(
      "Means are of participants' means. Tests are Welch's over participants' means, one-tailed if "
      "an end is expected, else two-tailed; only the region's score, whose values share their "
      "training, is tested by permuting the participants' labels. Holm's adjustment covers all "
      "metrics of the table. The ROC area is the probability that an expert is on the expected "
      "side of a novice, or is higher if no end is expected.");
  if (v_.rated == 0) {
    return;
  }
  document_.subheading("Metrics and ratings");
  picture("figure-19-visibility");
  picture("figure-21-region");
  document_.table(
      {"metric", "participants", "R over participants' means, p not adjusted", "p of R after Holm",
       "Spearman's rho of the means, p not adjusted", "p of rho after Holm"},
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
    rows.push_back({way.name, correlation_word(way.means), area_word(way.roc)});
  }
  document_.table({"counted and trained", "R with ratings over participants' means, p not adjusted",
                   "ROC area [95 % CI]"},
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
      "The squared error for participants left out is {}. (If it is higher, the metrics add "
      "nothing.) R on the data that were fitted is high even if the metrics say nothing. The "
      "penalty of the fit to all data is {}.",
      error_word(*c.fit), number(c.fit->lambda)));
  std::vector<Row> rows;
  for (std::size_t i = 0; i < c.metrics.size(); ++i) {
    rows.push_back({metric_of(v_, c.metrics[i])->kind.title,
                    fmt::format("{:+.3f}", c.fit->fit.slopes[static_cast<Eigen::Index>(i)])});
  }
  document_.table({"metric", "points per standard deviation"}, rows, "Weights of the metrics");
  if (!c.left_out.empty()) {
    document_.paragraph(fmt::format(
        "Left out, because a rated procedure lacks a value or all values are equal: {}.",
        fmt::join(c.left_out, ", ")));
  }
}

/// Adds the participants whose bones had no vital structure; nothing if all had.
void Report::add_unknown() {
  std::vector<std::string> whose;
  for (const ProcedureSummary& p : result_.procedures) {
    if (p.injuries.empty()) {
      whose.push_back(fmt::format("{}, procedure {}", p.participant, p.number));
    }
  }
  if (!whose.empty()) {
    section("Vital structures that are unknown");
    document_.paragraph(fmt::format(
        "These bones have no vital structure by a known name, so that nobody can tell what was "
        "injured or spared; injuries are left out of their metrics: {}.",
        fmt::join(whose, "; ")));
  }
}

/// Soft tissue that tore; nothing where none did.
void Report::add_tears() {
  std::vector<Row> rows;
  for (const ProcedureSummary& p : result_.procedures) {
    for (const Injury& injury : p.injuries) {
      if (injury.first_tear) {
        constexpr double kMillimetres = 1000.0;
        const FirstTear& first = *injury.first_tear;
        const Eigen::Vector3d place = kMillimetres * first.place;
        rows.push_back({p.participant, fmt::format("{}", p.number), injury.structure,
                        fmt::format("{}", injury.tears), fmt::format("{:.1f}", first.time),
                        fmt::format("{:.2f}{}", first.force, first.by_suction ? " (suction)" : ""),
                        fmt::format("({:.1f}, {:.1f}, {:.1f})", place.x(), place.y(), place.z())});
      }
    }
  }
  if (!rows.empty()) {
    section("Soft tissue that was torn");
    document_.paragraph("An injury each; time, force and place are of the first tear.");
    document_.table({"participant", "procedure", "structure", "tears", "time (s)", "force (N)",
                     "place in the world (mm)"},
                    rows);
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
    document_.paragraph(fmt::format("The report includes them: {}.", fmt::join(broken, ", ")));
  }
}

void Report::add_published() {
  section("As published (Morris 2006, §3.5): pooled procedures");
  document_.paragraph(
      "These tests assume that all procedures are independent. Procedures of one participant are "
      "not: differences between participants then pass for effects of experience, and p values are "
      "too small. They are not adjusted either. They are here for comparison with the source.");
  std::vector<Row> rows;
  if (v_.rated > 0) {
    for (const GroupValues* g : shown_groups(v_)) {
      rows.push_back({"mean rating, " + g->group + " [95 % CI]", interval_word(g->pooled)});
    }
    rows.push_back({"experts are rated higher, Student's t-test (one-tailed)",
                    t_result(v_.rating_contrast.pooled)});
  }
  for (const MetricValidity& m : v_.metrics) {
    if (m.relation.pooled) {
      rows.push_back({m.kind.title + " and ratings, R", correlation_word(m.relation.pooled)});
    }
  }
  for (const RegionWay& way : v_.regions) {
    if (way.pooled) {
      rows.push_back(
          {"region's score and ratings, " + way.name + ", R", correlation_word(way.pooled)});
    }
  }
  if (rows.empty()) {
    document_.paragraph("Nothing is rated yet.");
    return;
  }
  document_.table({"over procedures", "result"}, rows);
}

void Report::add_methods() {
  section("Methods");
  document_.paragraph(
      "The procedures of one participant depend on each other, so tests and correlations take "
      "participants as the unit: each participant gives one mean. Welch's test allows groups of "
      "different spread. The mixed model has a random intercept for each participant, fixed "
      "effects of experience and, if procedures differ in it, of the procedure's number, REML and "
      "Satterthwaite's degrees of freedom; it assumes the same spread in both groups.");
  document_.paragraph(
      "Areas under ROC curves count all pairs, ties half; their intervals are DeLong's with "
      "Obuchowski's sums over participants, and with few participants they are somewhat "
      "too narrow. The combined score is a ridge regression: standardisation, penalty and fit use "
      "nothing of the participant who is predicted. The region's score, one of its metrics, is "
      "trained on groups, never on ratings; the scores of the other participants do depend on the "
      "region of the participant left out.");
  document_.paragraph(
      "The intraclass correlations follow Shrout and Fleiss (1979) over the procedures that every "
      "rater scored.");
  add_simulation_alarm();
}

}  // namespace

Document validity_report(const ValidityResult& result, const std::vector<Drawing>& drawings) {
  return Report(result, drawings).made();
}

}  // namespace haptrial::analysis::drilling
