#include "analysis/bone_drilling/report/validity_figures.h"
#include "analysis/document/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/bone_drilling/report/ratings.h"
#include "analysis/bone_drilling/report/validity_words.h"
#include "analysis/document/palette.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr Look kExperts{palette::kBlue, palette::kSolid, 7, 2.0, 1.0};
constexpr Look kNovices{palette::kOrange, palette::kLong, 5, 2.0, 1.0};
constexpr Look kThird{palette::kGreen, palette::kShort, 9, 2.0, 1.2};
constexpr Look kFourth{palette::kPurple, palette::kMixed, 13, 2.0, 1.2};
constexpr Look kMeans{palette::kBlack, palette::kSolid, 7, 2.5, 1.2};
constexpr Look kChance{palette::kGrey, palette::kShort, 7, 1.5, 1.0};

Look look_of(std::size_t group) {
  const std::array<Look, 4> looks{kExperts, kThird, kNovices, kFourth};
  return looks[group % looks.size()];
}

void add_interval(Series& series, double x, const MeanInterval& m) {
  series.x.push_back(x);
  series.y.push_back(m.mean);
  series.low.push_back(m.low);
  series.high.push_back(m.high);
}

Figure new_figure(const ValidityResult& result, std::string name, std::string title,
                  std::string x_label, std::string y_label) {
  Figure figure;
  figure.name = std::move(name);
  figure.title = std::move(title);
  figure.x_label = std::move(x_label);
  figure.y_label = std::move(y_label);
  figure.simulated = result.validity.simulated;
  return figure;
}

// Novices left, experts right, as in the source; then every group.
Figure ratings_figure(const ValidityResult& result) {
  const Validity& v = result.validity;
  Figure figure = new_figure(result, "figure-16-ratings", "Ratings by experience", "Participants",
                             "Rating (5 is best)");
  std::vector<const GroupValues*> order{&v.rating_groups.back(), &*(v.rating_groups.end() - 2)};
  for (std::size_t g = 0; g < v.plan.groups.size(); ++g) {
    const GroupValues& group = v.rating_groups[g];
    const bool whole_side = std::any_of(order.begin(), order.begin() + 2, [&](const auto* side) {
      return side->procedures == group.procedures && group.procedures > 0;
    });
    if (!whole_side) {
      order.push_back(&group);
    }
  }
  Series pooled{"mean, procedures", Mark::kBars, kMeans};
  Series means{"mean, participants", Mark::kBars, kExperts};
  Series dots{"procedure", Mark::kPoints, {palette::kGrey, palette::kSolid, 6, 1.5, 0.8}};
  constexpr double kAside = 0.12;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double place = static_cast<double>(k + 1);
    const std::string& name = order[k]->group;
    figure.x_names.emplace_back(place, k == 0 ? "all novices" : k == 1 ? "with experience" : name);
    std::size_t shown = 0;
    for (std::size_t i = 0; i < result.procedures.size(); ++i) {
      const bool own = k == 0   ? !v.expert[i]
                       : k == 1 ? v.expert[i]
                                : result.procedures[i].group == name;
      if (own && v.rating[i]) {
        constexpr int kColumns = 6;
        dots.x.push_back(place + 0.2 + 0.03 * static_cast<double>(shown++ % kColumns));
        dots.y.push_back(*v.rating[i]);
      }
    }
    if (order[k]->pooled) {
      add_interval(pooled, place - kAside, *order[k]->pooled);
    }
    if (order[k]->participant_means) {
      add_interval(means, place, *order[k]->participant_means);
    }
  }
  for (Series& series : std::vector<Series>{dots, pooled, means}) {
    if (!series.x.empty()) {
      figure.series.push_back(std::move(series));
    }
  }
  figure.x_range = Range{0.5, static_cast<double>(order.size()) + 0.6};
  figure.y_range = Range{0.8, 5.2};
  figure.caption = fmt::format(
      "Ratings of procedures by novices and by participants with surgical experience{}. Means with "
      "95 % confidence intervals: blue of participants' means; black over all procedures, as "
      "published, which takes procedures of one participant as independent.",
      order.size() > 2 ? ", then by group" : "");
  figure.alt = fmt::format("Mean of participants' mean ratings: novices {}; with experience {}.",
                           mean_with_interval(order[0]->participant_means),
                           mean_with_interval(order[1]->participant_means));
  return figure;
}

// A metric over the ratings, a dot for each procedure, with the line.
Figure relation_figure(const ValidityResult& result, const MetricValidity& metric,
                       const std::string& name) {
  const Validity& v = result.validity;
  const auto at = static_cast<std::size_t>(&metric - v.metrics.data());
  Figure figure = new_figure(
      result, name, capitalized(metric.kind.title) + " and ratings", "Rating (5 is best)",
      capitalized(metric.kind.title) +
          (metric.kind.unit == "1" ? std::string() : fmt::format(" ({})", metric.kind.unit)));
  double least = kHighestScore, most = kLowestScore;
  for (std::size_t g = 0; g < v.plan.groups.size(); ++g) {
    Series dots{v.plan.groups[g], Mark::kPoints, look_of(g)};
    for (std::size_t i = 0; i < result.procedures.size(); ++i) {
      if (result.procedures[i].group == v.plan.groups[g] && v.rating[i] &&
          result.procedures[i].values[at]) {
        dots.x.push_back(*v.rating[i]);
        dots.y.push_back(*result.procedures[i].values[at]);
        least = std::min(least, dots.x.back());
        most = std::max(most, dots.x.back());
      }
    }
    if (!dots.x.empty()) {
      figure.series.push_back(std::move(dots));
    }
  }
  const RatingRelation& relation = metric.relation;
  std::string fit = "The line is not defined.";
  if (relation.line && relation.pooled) {
    const double a = relation.line->coefficients[0].estimate;
    const double b = relation.line->coefficients[1].estimate;
    figure.series.push_back(
        Series{"linear fit", Mark::kLine, kChance, {least, most}, {a + b * least, a + b * most}});
    fit = fmt::format(
        "Over participants' means R = {}. Over procedures, as published, R = {}: this takes "
        "procedures of one participant as independent.",
        relation_word(v, metric), correlation_word(relation.pooled));
  }
  figure.x_range = Range{0.8, 5.2};
  figure.caption = fmt::format("One dot is one procedure. {}", fit);
  figure.alt = fit;
  return figure;
}

std::vector<NearCase> cases_of(const ValidityResult& result, bool expert) {
  std::vector<NearCase> cases;
  for (std::size_t i = 0; i < result.procedures.size(); ++i) {
    for (const NearRemovals& near : result.procedures[i].near) {
      if (near.structure == result.structure && result.validity.expert[i] == expert) {
        cases.push_back({result.procedures[i].participant, &near});
      }
    }
  }
  return cases;
}

// Force or speed by distance to the chosen structure.
Figure profile_figure(const ValidityResult& result, NearQuantity quantity) {
  const bool force = quantity == NearQuantity::kForce;
  Figure figure =
      new_figure(result, force ? "figure-20-force-near-structure" : "speed-near-structure",
                 fmt::format("{} near the {}", force ? "Force" : "Speed", result.structure),
                 fmt::format("Distance to the {} (mm)", result.structure),
                 force ? "Force (N)" : "Speed (mm/s)");
  const double factor = force ? 1.0 : 1e3;
  for (const bool expert : {true, false}) {
    Series series{expert ? "with experience" : "novices", Mark::kLinkedBars,
                  expert ? kExperts : kNovices};
    const std::vector<NearCase> cases = cases_of(result, expert);
    for (const ProfileBin& bin : near_profile(cases, quantity, result.bins)) {
      const double middle = 500.0 * (bin.low + bin.high) + (expert ? 0.1 : -0.1);
      if (bin.by_participant) {
        MeanInterval m = *bin.by_participant;
        m.mean *= factor;
        m.low = std::max(0.0, factor * m.low);
        m.high *= factor;
        add_interval(series, middle, m);
      }
    }
    if (!series.x.empty()) {
      figure.series.push_back(std::move(series));
    }
  }
  figure.x_range = Range{0.0, 1e3 * result.bins.reach};
  figure.caption = fmt::format(
      "Mean {} with which voxels were removed, by their distance to the {}; every participant is "
      "one value in an interval of distance, bars are 95 % confidence intervals over participants "
      "(the source pools removals, which depend on each other). Intervals that fewer than two "
      "participants of a side reached are left out.",
      force ? "force" : "speed", result.structure);
  figure.alt = figure.title + " for participants with experience and novices.";
  return figure;
}

void add_curve(Figure& figure, const Defined<Roc>& roc, const std::string& label, Look look,
               std::vector<std::string>& shown, const char* what) {
  if (!roc) {
    return;
  }
  shown.emplace_back(what);
  Series curve{fmt::format("{} {:.2f}", label, roc->area), Mark::kLine, look};
  for (const RocPoint& p : roc->curve) {
    curve.x.push_back(p.false_positives);
    curve.y.push_back(p.true_positives);
  }
  figure.series.push_back(std::move(curve));
}

Figure roc_figure(const ValidityResult& result) {
  const Validity& v = result.validity;
  Figure figure = new_figure(result, "roc-experts-novices", "Telling experts from novices",
                             "Share of novices called experts", "Share of experts called experts");
  std::vector<std::string> curves;
  add_curve(figure, v.combined.roc, "all metrics", kMeans, curves,
            "all metrics together (each procedure scored by a regression that saw nothing of its "
            "participant)");
  add_curve(figure, v.rating_contrast.roc, "rating", kThird, curves, "the rating");
  struct Shown {
    const char* metric;
    const char* label;
    Look look;
    const char* what;
  };
  const std::array<Shown, 3> shown{
      {{"visible_share", "visibility", kExperts, "the share of voxels removed in sight"},
       {"near_force", "force", kNovices, "the force near vital structures"},
       {kRegionMetric, "region", kFourth, "the likelihood ratio of the removed region"}}};
  for (const Shown& one : shown) {
    if (const MetricValidity* metric = metric_of(v, one.metric)) {
      add_curve(figure, metric->contrast.roc, one.label, one.look, curves, one.what);
    }
  }
  if (!figure.series.empty()) {
    figure.series.push_back(Series{"", Mark::kLine, kChance, {0.0, 1.0}, {0.0, 1.0}});
  }
  figure.x_range = Range{0.0, 1.0};
  figure.y_range = Range{0.0, 1.02};
  figure.height = 0.75;
  figure.caption = fmt::format(
      "ROC curves of procedures by experts against those by novices, with their areas: {}. The "
      "diagonal is chance.",
      fmt::join(curves, "; "));
  figure.alt = "ROC curves; their areas are in the key and the table.";
  return figure;
}

}  // namespace

const MetricValidity* metric_of(const Validity& v, std::string_view name) {
  const auto at = std::find_if(v.metrics.begin(), v.metrics.end(),
                               [&](const MetricValidity& m) { return m.kind.name == name; });
  return at == v.metrics.end() ? nullptr : &*at;
}

std::vector<Figure> validity_figures(const ValidityResult& result) {
  const Validity& v = result.validity;
  std::vector<Figure> figures;
  if (v.rated > 0) {
    figures.push_back(ratings_figure(result));
    for (const auto& [metric, name] : {std::pair{"visible_share", "figure-19-visibility"},
                                       std::pair{"region_log_ratio", "figure-21-region"}}) {
      if (const MetricValidity* m = metric_of(v, metric); m != nullptr && m->defined > 0) {
        figures.push_back(relation_figure(result, *m, name));
      }
    }
  }
  if (!result.structure.empty()) {
    figures.push_back(profile_figure(result, NearQuantity::kForce));
    figures.push_back(profile_figure(result, NearQuantity::kSpeed));
  }
  figures.push_back(roc_figure(result));
  std::erase_if(figures, [](const Figure& figure) { return figure.series.empty(); });
  return figures;
}

Drawing drawing_of(const StudyPicture& picture, bool simulated) {
  Drawing drawing;
  drawing.figure.name = picture.name;
  drawing.figure.title = picture.title;
  drawing.figure.caption = picture.caption + (simulated ? " The participant is simulated." : "");
  drawing.figure.alt = picture.alt;
  drawing.figure.simulated = simulated;
  drawing.svg = svg_of_png(picture.png);
  return drawing;
}

}  // namespace haptrial::analysis::drilling
