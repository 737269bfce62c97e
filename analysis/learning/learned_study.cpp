#include "analysis/learning/learned_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "analysis/document/palette.h"
#include "analysis/statistics/design/compared_sides.h"
#include "analysis/statistics/design/design_blocks.h"
#include "analysis/statistics/design/design_lines.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

constexpr std::size_t kGroup = 0, kSession = 1;  // factors

std::vector<std::string> joined(std::vector<std::string> first,
                                const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

void add_means(const DesignTable& table, LearnedOutcome& outcome) {
  outcome.groups = table.factors[kGroup].levels;
  outcome.sessions = table.factors[kSession].levels;
  outcome.means.assign(outcome.groups.size(), std::vector<Mean>(outcome.sessions.size()));
  for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
    std::vector<double> values;
    for (const auto& row : table.means) {
      if (row[cell]) {
        values.push_back(*row[cell]);
      }
    }
    const auto& levels = table.cells[cell];
    if (!values.empty()) {
      outcome.means[levels[kGroup]][levels[kSession]] = mean_and_interval(values);
    }
  }
}

LearnedOutcome outcome_of(const LearningQuantity& quantity, const LearningPlan& plan,
                          const LearningNames& names) {
  LearnedOutcome outcome;
  outcome.name = quantity.name;
  outcome.title = quantity.title;
  outcome.unit = quantity.unit;
  const std::vector<Observation>& all = quantity.values;
  const auto order = joined(names.groups, names.sessions);
  add_means(design_table(all, {"group", "session"}, order), outcome);
  std::vector<Observation> changes = changes_from(all, kSession, plan.baseline);
  std::erase_if(changes, [&](const Observation& each) {
    return std::ranges::find(plan.tests, each.levels[kSession]) == plan.tests.end();
  });
  if (changes.empty()) {
    return outcome;
  }
  outcome.changes = design_table(changes, {"group", "change"}, order);
  Resampling resampling;
  resampling.stream = "learning " + quantity.name;
  outcome.tests = design_tests(outcome.changes, plan.plan, resampling);
  return outcome;
}

Look look_of_group(std::size_t group) {
  static constexpr std::array<Look, 6> kLooks{{{palette::kBlue, palette::kSolid, 7, 2.0, 1.0},
                                               {palette::kOrange, palette::kLong, 5, 2.0, 1.0},
                                               {palette::kGreen, palette::kShort, 9, 2.0, 1.2},
                                               {palette::kPurple, palette::kMixed, 13, 2.0, 1.2},
                                               {palette::kGrey, palette::kSolid, 4, 2.0, 1.0},
                                               {palette::kBlack, palette::kLong, 6, 2.0, 1.0}}};
  return kLooks[group % kLooks.size()];
}

std::string unit_of(const LearnedOutcome& outcome) {
  return outcome.unit == "1" ? "" : outcome.unit;
}

Series series_of(const LearnedOutcome& outcome, std::size_t group) {
  constexpr double kAside = 0.06;  // of groups from each other
  Series series{outcome.groups[group], Mark::kLinkedBars, look_of_group(group)};
  const double middle = 0.5 * static_cast<double>(outcome.groups.size() - 1);
  for (std::size_t session = 0; session < outcome.sessions.size(); ++session) {
    const Mean& mean = outcome.means[group][session];
    if (mean.value) {
      series.x.push_back(static_cast<double>(session + 1) +
                         kAside * (static_cast<double>(group) - middle));
      series.y.push_back(*mean.value);
      series.low.push_back(mean.interval ? mean.interval->low : *mean.value);
      series.high.push_back(mean.interval ? mean.interval->high : *mean.value);
    }
  }
  return series;
}

Figure figure_of(const LearnedOutcome& outcome, bool simulated) {
  Figure figure;
  figure.name = "learning-" + outcome.name;
  figure.title = capitalized(outcome.title) + " by session";
  figure.x_label = "Session";
  figure.y_label = capitalized(outcome.title) +
                   (unit_of(outcome).empty() ? "" : fmt::format(" ({})", outcome.unit));
  figure.simulated = simulated;
  for (std::size_t session = 0; session < outcome.sessions.size(); ++session) {
    figure.x_names.emplace_back(static_cast<double>(session + 1), outcome.sessions[session]);
  }
  figure.x_range = Range{0.5, static_cast<double>(outcome.sessions.size()) + 0.5};
  for (std::size_t group = 0; group < outcome.groups.size(); ++group) {
    Series series = series_of(outcome, group);
    if (!series.x.empty()) {
      figure.series.push_back(std::move(series));
    }
  }
  figure.caption =
      "Means of participants' means with 95 % confidence intervals between participants. What "
      "groups learned is compared by changes within participants, whose intervals are in the "
      "table.";
  figure.alt =
      fmt::format("A line for each group over the sessions {}.", fmt::join(outcome.sessions, ", "));
  return figure;
}

/// Means by group and session, then the mean change up to each test.
void add_outcome_table(Document& document, const LearnedOutcome& outcome,
                       const LearningPlan& plan) {
  std::vector<std::string> heading{"group"};
  heading.insert(heading.end(), outcome.sessions.begin(), outcome.sessions.end());
  for (const std::string& test : plan.tests) {
    heading.push_back(fmt::format("change to {}", test));
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t group = 0; group < outcome.groups.size(); ++group) {
    std::vector<std::string> row{outcome.groups[group]};
    for (const auto& mean : outcome.means[group]) {
      row.push_back(interval_word(mean));
    }
    for (const std::string& test : plan.tests) {
      row.push_back(interval_word(mean_change(outcome, outcome.groups[group], test)));
    }
    rows.push_back(std::move(row));
  }
  document.table(heading, rows);
}

}  // namespace

Mean mean_change(const LearnedOutcome& outcome, const std::string& group, const std::string& test) {
  const DesignTable& table = outcome.changes;
  std::vector<double> values;
  for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
    const auto& levels = table.cells[cell];
    if (table.factors[kGroup].levels[levels[kGroup]] == group &&
        table.factors[kSession].levels[levels[kSession]] == test) {
      for (const auto& row : table.means) {
        if (row[cell]) {
          values.push_back(*row[cell]);
        }
      }
    }
  }
  return mean_and_interval(values);
}

LearnedStudy learned_study(std::span<const LearningQuantity> quantities, const LearningPlan& plan,
                           const LearningNames& names) {
  LearnedStudy study{plan, {}};
  LearningPlan own = plan;
  for (const LearningQuantity& quantity : quantities) {
    study.outcomes.push_back(outcome_of(quantity, own, names));
    for (PlannedTest& test : own.plan.tests) {  // directions are those of the first outcome
      test.tail = Tail::kTwoSided;
    }
  }
  return study;
}

std::vector<Figure> learning_figures(const LearnedStudy& study, bool simulated) {
  std::vector<Figure> figures;
  for (const LearnedOutcome& outcome : study.outcomes) {
    Figure figure = figure_of(outcome, simulated);
    if (!figure.series.empty()) {
      figures.push_back(std::move(figure));
    }
  }
  return figures;
}

void add_learning_section(Document& document, const LearnedStudy& study,
                          const std::vector<Drawing>& drawings, bool simulated) {
  if (study.outcomes.empty()) {
    return;
  }
  document.heading(simulated ? "Learning from session to session (simulated)"
                             : "Learning from session to session");
  document.paragraph(fmt::format(
      "A change is a participant's mean in a test less the mean in {}. Groups are compared in "
      "their "
      "changes, so that a test of two groups is one of group by session. Holm's adjustment covers "
      "the planned tests of one outcome, and the first outcome decides{}.",
      study.plan.baseline,
      study.outcomes.size() > 1 ? "; tests of the others are two-tailed and stand beside it" : ""));
  for (const LearnedOutcome& outcome : study.outcomes) {
    document.subheading(capitalized(outcome.title) +
                        (unit_of(outcome).empty() ? "" : fmt::format(" [{}]", outcome.unit)));
    const auto drawing = std::ranges::find_if(drawings, [&](const Drawing& each) {
      return each.figure.name == "learning-" + outcome.name;
    });
    if (drawing != drawings.end()) {
      document.picture(*drawing);
    } else {
      document.paragraph("No figure is drawn: no participant has a value in a session.");
    }
    add_outcome_table(document, outcome, study.plan);
    if (outcome.changes.cells.empty()) {
      document.paragraph("Nobody has both the baseline and a test yet, so no change is known.");
    } else {
      add_design_tests(document, outcome.changes, outcome.tests, unit_of(outcome));
    }
  }
}

std::vector<std::string> learning_lines(const LearnedStudy& study) {
  std::vector<std::string> lines;
  if (!study.outcomes.empty()) {
    const LearnedOutcome& outcome = study.outcomes.front();
    for (const auto& found : {effect_lines(outcome.tests), planned_lines(outcome.tests)}) {
      for (const std::string& line : found) {
        const std::size_t end = line.ends_with('.') ? line.size() - 1 : line.size();
        lines.push_back(fmt::format("change of {}: {}", outcome.title, line.substr(0, end)));
      }
    }
  }
  return lines;
}

}  // namespace haptrial::analysis
