#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/document/html.h"
#include "analysis/document/palette.h"
#include "analysis/document/report_style.h"
#include "analysis/force_training/report/comparison.h"
#include "analysis/statistics/design/result_json_internal.h"
#include "analysis/statistics/design/wording.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::analysis {
namespace {

constexpr const char* kFigure = "comparison";

std::string paragraph(const std::string& text) { return "<p>" + escape_html(text) + "</p>\n"; }

std::string pace_of(const ScoredStudy& study) {
  return study.own_pace
             ? "at the participants' own pace, forces compared over the place on the path"
             : "at the pace of the trajectory, forces compared over time";
}

bool simulated(const StudyComparison& c) { return c.first.simulated() || c.second.simulated(); }

/// "12 participants, 3 of them simulated".
std::string people_in(const ScoredStudy& study) {
  std::set<std::string> scored;
  for (const TrialScore& s : study.scores) {
    scored.insert(s.subject);
  }
  const auto virtual_ones = static_cast<std::size_t>(std::count_if(
      study.people.begin(), study.people.end(),
      [&](const Identity& who) { return who.simulated && scored.contains(who.subject); }));
  if (virtual_ones == scored.size()) {
    return counted(scored.size(), "simulated participant");
  }
  return counted(scored.size(), "participant") +
         (virtual_ones > 0 ? fmt::format(", {} of them simulated", virtual_ones) : "");
}

std::string names_of(const std::vector<std::string>& subjects) {
  constexpr std::size_t kMost = 6;
  const auto shown = subjects.size() > kMost ? kMost - 1 : subjects.size();
  std::string names = fmt::format(
      "{}", fmt::join(subjects.begin(), subjects.begin() + static_cast<long>(shown), ", "));
  return shown < subjects.size() ? fmt::format("{} and {} more", names, subjects.size() - shown)
                                 : names;
}

std::string pairing(const StudyComparison& comparison) {
  std::string text = comparison.paired.empty()
                         ? "No participant is paired"
                         : "Paired: " + counted(comparison.paired.size(), "participant");
  std::string others;
  for (const auto& [reason, subjects] : comparison.unpaired) {
    others += fmt::format("{}{} ({})", others.empty() ? "" : "; ", names_of(subjects), reason);
  }
  return others.empty() ? text + "." : fmt::format("{}. Not paired: {}.", text, others);
}

/// Nothing when both studies were compared over the same.
std::string different_pace(const StudyComparison& c) {
  if (c.first.own_pace == c.second.own_pace) {
    return "";
  }
  const auto& [over_path, over_time] =
      c.first.own_pace ? std::tie(c.first, c.second) : std::tie(c.second, c.first);
  return fmt::format(
      "{} compares forces over the place on the path, {} over time. A place counts as the time "
      "that "
      "the definition's speed takes to reach it, so the scores have the same units.",
      over_path.name, over_time.name);
}

std::string test_interval(const TTest& test) {
  return fmt::format("{} (95 % CI {} to {})", number(test.difference), number(test.low),
                     number(test.high));
}

std::string t_value(const Defined<TTest>& test) {
  return test ? fmt::format("t({:.4g}) = {:.3g}", test->df, test->t)
              : "not defined, because " + test.because();
}

/// Words for differences within people, without an interval if they do not vary.
std::string within_people(const ConditionComparison& c) {
  return c.paired ? test_interval(*c.paired) : c.shared > 0 ? number(c.shared_difference) : "-";
}

std::string adjusted(const Defined<double>& p) { return p ? p_value(*p) : "-"; }

std::string mean_text(const Mean& mean, std::size_t people) {
  return fmt::format("{} ({})", mean.value ? number(*mean.value) : "not defined",
                     counted(people, "participant"));
}

Figure figure_of(const StudyComparison& comparison) {
  Figure figure;
  figure.name = kFigure;
  figure.title = "Recall error in two studies";
  figure.x_label = "Training condition";
  figure.y_label = "Recall error (0 is perfect)";
  figure.simulated = simulated(comparison);
  Series first{comparison.first.name, Mark::kBars, {palette::kBlue, palette::kSolid, 7, 2.5, 1.2}};
  Series second{
      comparison.second.name, Mark::kBars, {palette::kOrange, palette::kSolid, 5, 2.5, 1.2}};
  double highest = 0.0;
  double place = 0.0;
  for (const auto& c : comparison.conditions) {
    figure.x_names.emplace_back(++place, capitalized(c.condition));
    const auto add = [&](Series& series, double x, const Mean& m) {
      if (m.value) {
        series.x.push_back(x);
        series.y.push_back(*m.value);
        series.low.push_back(m.interval ? m.interval->low : *m.value);
        series.high.push_back(m.interval ? m.interval->high : *m.value);
        highest = std::max(highest, series.high.back());
      }
    };
    add(first, place - 0.1, c.first);
    add(second, place + 0.1, c.second);
  }
  for (const Series& series : {first, second}) {
    if (!series.x.empty()) {
      figure.series.push_back(series);
    }
  }
  figure.x_range = Range{0.4, place + 0.6};
  figure.y_range = Range{0.0, highest > 0.0 ? 1.1 * highest : 1.0};
  figure.caption =
      "Mean over participants of their mean recall error, with 95 % confidence intervals over "
      "participants.";
  figure.alt = "Mean recall error by training condition, one point for each study.";
  return figure;
}

std::string within_table(const StudyComparison& comparison) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& c : comparison.conditions) {
    rows.push_back({capitalized(c.condition), std::to_string(c.shared), within_people(c),
                    t_value(c.paired), adjusted(c.paired_holm)});
  }
  return "<h2>Within participants</h2>\n" +
         html_table({"Condition", "Participants", "Difference", "Paired t-test", "Adjusted p"},
                    rows);
}

std::string between_table(const StudyComparison& comparison) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& c : comparison.conditions) {
    rows.push_back({capitalized(c.condition), mean_with_interval(c.first),
                    mean_with_interval(c.second), c.welch ? test_interval(*c.welch) : "-",
                    t_value(c.welch), adjusted(c.welch_holm)});
  }
  return "<h2>Between all participants</h2>\n" +
         html_table({"Condition", comparison.first.name, comparison.second.name, "Difference",
                     "Welch's t-test", "Adjusted p"},
                    rows);
}

std::string html_of(const StudyComparison& comparison, const std::string& svg,
                    const Figure& figure) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}Two studies compared</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n"
      "<h1>Two studies compared</h1>\n",
      simulated(comparison) ? "SIMULATED: " : "", kReportStyle);
  for (const std::string& alarm : comparison_alarms(comparison)) {
    html += "<div class=\"banner\">" + escape_html(alarm) + "</div>\n";
  }
  html += "<ul class=\"lines\">\n";
  for (const std::string& line : comparison_lines(comparison)) {
    html += "<li>" + escape_html(line) + "</li>\n";
  }
  html += "</ul>\n<figure>\n" + inline_svg(svg, kFigure, figure.title + ". " + figure.alt) +
          "\n<figcaption>" + escape_html(figure.caption) + "</figcaption>\n</figure>\n";
  html += paragraph(fmt::format(
      "Differences are {} minus {}, of participants' means; tests are two-sided. The p values of "
      "each test are adjusted over the conditions with Holm's method. The paired test uses the "
      "participants who took part in both studies: people with the same identifier, and virtual "
      "subjects with the same identifier, seed and population. Welch's test treats all "
      "participants "
      "as different ones. The report of each study has the tests of that study alone.",
      comparison.second.name, comparison.first.name));
  if (!comparison.paired.empty()) {
    html += within_table(comparison);
  }
  return html + between_table(comparison) + "</main>\n</body>\n</html>\n";
}

}  // namespace

std::vector<std::string> comparison_alarms(const StudyComparison& comparison) {
  std::vector<std::string> alarms;
  if (!comparison.scoring.empty()) {
    std::string list;
    for (const auto& [name, first, second] : comparison.scoring) {
      list += fmt::format("{}{}: {} and {}", list.empty() ? "" : "; ", name, first, second);
    }
    alarms.push_back(
        fmt::format("DIFFERENT SCORING: the scores were made with different parameters, so a "
                    "difference between "
                    "the studies may come from the scoring alone ({}).",
                    list));
  }
  if (simulated(comparison)) {
    alarms.emplace_back(
        "SIMULATED PARTICIPANTS: these data come from virtual subjects. They say how the "
        "experiments and their analysis work, not how people learn.");
  }
  return alarms;
}

std::vector<std::string> comparison_lines(const StudyComparison& comparison) {
  std::vector<std::string> lines;
  for (const ScoredStudy* study : {&comparison.first, &comparison.second}) {
    lines.push_back(fmt::format("{}: {}, {}, {}", study->name, people_in(*study),
                                counted(study->scores.size(), "scored trial"), pace_of(*study)));
  }
  if (const std::string pace = different_pace(comparison); !pace.empty()) {
    lines.push_back(pace);
  }
  lines.insert(lines.end(), comparison.remarks.begin(), comparison.remarks.end());
  lines.push_back(pairing(comparison));
  for (const auto& c : comparison.conditions) {
    std::string result = "the difference is " + t_value(c.welch);
    if (c.shared > 0) {
      result = fmt::format(
          "difference within {} {}{}", counted(c.shared, "participant"), within_people(c),
          c.paired ? ", adjusted " + adjusted(c.paired_holm)
                   : "; its interval and test are not defined, because " + c.paired.because());
    } else if (c.welch) {
      result = fmt::format("difference between the means {}, adjusted {}", test_interval(*c.welch),
                           adjusted(c.welch_holm));
    }
    lines.push_back(fmt::format("{}: mean recall error {} and {}; {}", capitalized(c.condition),
                                mean_text(c.first, c.first_people),
                                mean_text(c.second, c.second_people), result));
  }
  return lines;
}

void write_comparison(const StudyComparison& comparison, const std::filesystem::path& folder) {
  const Figure figure = figure_of(comparison);
  draw_figures({figure}, folder);
  const std::string svg = file_text(folder / (figure.name + ".svg"));
  write_whole(folder / "comparison.json", comparison_json(comparison));
  write_whole(folder / "comparison.html", html_of(comparison, svg, figure));
}

namespace {

using Json = nlohmann::ordered_json;

Json compared_json(const Defined<TTest>& t) {
  return t ? Json{{"t", t->t},
                  {"df", t->df},
                  {"p", t->p},
                  {"difference", t->difference},
                  {"difference_low_95", t->low},
                  {"difference_high_95", t->high}}
           : Json{{"not_defined", t.because()}};
}

Json compared_json(const Defined<double>& p) {
  return p ? Json(*p) : Json{{"not_defined", p.because()}};
}

Json about(const ScoredStudy& study, const StudyStatistics& statistics) {
  Json json{{"study", study.name},
            {"simulated", study.simulated()},
            {"own_pace", study.own_pace},
            {"participants", statistics.subjects.size()},
            {"trials", study.scores.size()}};
  const auto& anova = statistics.repeated;
  json["repeated_measures_anova"] = anova
                                        ? Json{{"f", anova->f},
                                               {"df_condition", anova->df_condition},
                                               {"df_error", anova->df_error},
                                               {"p", anova->p},
                                               {"p_corrected", anova->p_corrected},
                                               {"partial_eta_squared", anova->partial_eta_squared}}
                                        : Json{{"not_defined", anova.because()}};
  return json;
}

}  // namespace

std::string comparison_json(const StudyComparison& comparison) {
  Json root;
  root["simulated"] = comparison.first.simulated() || comparison.second.simulated();
  root["different_scoring"] = Json::array();
  for (const auto& [name, first, second] : comparison.scoring) {
    root["different_scoring"].push_back(
        {{"parameter", name}, {"first", first}, {"second", second}});
  }
  root["first"] = about(comparison.first, comparison.first_statistics);
  root["second"] = about(comparison.second, comparison.second_statistics);
  root["paired_participants"] = comparison.paired;
  root["not_paired"] = Json::array();
  for (const auto& [reason, subjects] : comparison.unpaired) {
    root["not_paired"].push_back({{"because", reason}, {"subjects", subjects}});
  }
  root["conditions"] = Json::array();
  for (const auto& c : comparison.conditions) {
    root["conditions"].push_back(
        {{"condition", c.condition},
         {"first_participant_means", to_json(c.first)},
         {"second_participant_means", to_json(c.second)},
         {"welch_two_sided", compared_json(c.welch)},
         {"welch_p_holm", compared_json(c.welch_holm)},
         {"shared_participants", c.shared},
         {"shared_difference", c.shared > 0 ? Json(c.shared_difference) : Json()},
         {"paired_two_sided", compared_json(c.paired)},
         {"paired_p_holm", compared_json(c.paired_holm)}});
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace haptrial::analysis
