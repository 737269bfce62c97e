#include "analysis/force_training/report/study_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "analysis/document/palette.h"
#include "analysis/force_training/study/order_balance.h"
#include "analysis/force_training/study/study_statistics.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {

using namespace palette;

/// Circle, square, triangle, diamond, each with its dash.
Look condition_look(std::size_t index) {
  const std::array<Look, 4> looks{
      Look{kOrange, kLong, 5, 2.0, 1.1}, Look{kBlue, kMixed, 7, 2.0, 1.1},
      Look{kGreen, kSolid, 9, 2.0, 1.3}, Look{kPurple, kShort, 13, 2.0, 1.3}};
  return looks[index % looks.size()];
}

namespace {

constexpr double kBeside = 0.015;  // points of participants are beside the bar of their mean

/// Points of single participants behind means of this look.
Series points_behind(const Look& look) {
  return {"", Mark::kPoints, {look.color, kSolid, 6, 1.0, 0.6}};
}

/// Adds the mean of each participant over the scores of which `wanted` holds.
template <class Predicate>
void add_people(const StudyResult& study, double place, Predicate&& wanted, Series& points,
                double& highest) {
  for (const auto& [subject, values] : by_subject_where(study.scores, wanted)) {
    points.x.push_back(place);
    points.y.push_back(std::accumulate(values.begin(), values.end(), 0.0) /
                       static_cast<double>(values.size()));
    highest = std::max(highest, points.y.back());
  }
}

Figure recall_error(const StudyResult& study) {
  const auto& statistics = study.statistics;
  Figure figure;
  figure.name = "figure-28-recall-error";
  figure.title = "Recall error by training condition";
  figure.x_label = "Training condition";
  figure.y_label = "Recall error (0 is perfect)";
  Series participants{"mean of one participant", Mark::kPoints, {kBlue, kSolid, 6, 1.5, 0.9}};
  Series intervals{
      "mean of participants' means, 95 % CI", Mark::kBars, {kBlack, kSolid, 7, 2.5, 1.2}};
  Series means{"", Mark::kPoints, {kBlack, kSolid, 7, 2.5, 1.2}};  // where no interval exists
  double highest = 0.0;
  for (std::size_t c = 0; c < statistics.conditions.size(); ++c) {
    const auto& summary = statistics.summaries[c];
    const auto place = static_cast<double>(c + 1);
    figure.x_names.emplace_back(place, capitalized(summary.condition));
    const auto& means_of = statistics.table.means;
    const auto people = static_cast<double>(means_of.size());
    for (std::size_t p = 0; p < means_of.size(); ++p) {
      if (!means_of[p][c]) {
        continue;
      }
      const double spread = people > 1.0 ? 0.24 * static_cast<double>(p) / (people - 1.0) : 0.12;
      participants.x.push_back(place + 0.1 + spread);
      participants.y.push_back(*means_of[p][c]);
      highest = std::max(highest, participants.y.back());
    }
    if (const auto& i = summary.participants) {
      intervals.x.push_back(place - 0.1);
      intervals.y.push_back(i->mean);
      intervals.low.push_back(i->low);
      intervals.high.push_back(i->high);
      highest = std::max(highest, i->high);
    } else if (summary.mean) {
      means.x.push_back(place - 0.1);
      means.y.push_back(*summary.mean);
      highest = std::max(highest, *summary.mean);
    }
  }
  for (auto& series : {participants, intervals, means}) {
    if (!series.x.empty()) {
      figure.series.push_back(series);
    }
  }
  figure.x_range = Range{0.4, static_cast<double>(statistics.conditions.size()) + 0.6};
  figure.y_range = Range{0.0, highest > 0.0 ? 1.1 * highest : 1.0};
  figure.caption =
      "Mean recall error for each training condition: the mean of the participants' means with its "
      "95 % confidence interval, and beside it the mean of every participant (from left to right "
      "in "
      "order of name). The source's Figure 28 has intervals over pooled trials; they are in the "
      "table.";
  figure.alt = "Mean recall error by training condition:";
  for (const auto& s : statistics.summaries) {
    figure.alt += fmt::format(" {} {};", s.condition, mean_with_interval(s.participants));
  }
  return figure;
}

/// Two factors: a line for each level of the first over the levels of the second.
Figure interaction(const StudyResult& study) {
  const auto& statistics = study.statistics;
  const auto& table = statistics.table;
  Figure figure;
  figure.name = "interaction";
  figure.title =
      fmt::format("Recall error by {} and {}", table.factors[0].name, table.factors[1].name);
  figure.x_label = capitalized(table.factors[1].name);
  figure.y_label = "Recall error (0 is perfect)";
  figure.alt = "Mean recall error:";
  double highest = 0.0;
  const auto lines = static_cast<double>(table.factors[0].levels.size());
  for (std::size_t a = 0; a < table.factors[0].levels.size(); ++a) {
    Series series{capitalized(table.factors[0].levels[a]), Mark::kLinkedBars, condition_look(a)};
    Series people = points_behind(series.look);
    const double aside = 0.04 * (static_cast<double>(a) - 0.5 * (lines - 1.0));
    for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
      const auto& interval = statistics.summaries[cell].participants;
      if (table.cells[cell][0] != a || !interval) {
        continue;
      }
      series.x.push_back(static_cast<double>(table.cells[cell][1]) + 1.0 + aside);
      series.y.push_back(interval->mean);
      series.low.push_back(interval->low);
      series.high.push_back(interval->high);
      highest = std::max(highest, interval->high);
      add_people(
          study, series.x.back() + kBeside,
          [&](const TrialScore& s) { return s.condition == table.names[cell]; }, people, highest);
      figure.alt += fmt::format(" {} {};", table.names[cell], number(interval->mean));
    }
    figure.series.push_back(std::move(people));
    figure.series.push_back(std::move(series));
  }
  const auto& levels = table.factors[1].levels;
  for (std::size_t b = 0; b < levels.size(); ++b) {
    figure.x_names.emplace_back(static_cast<double>(b) + 1.0, capitalized(levels[b]));
  }
  figure.x_range = Range{0.6, static_cast<double>(levels.size()) + 0.4};
  figure.y_range = Range{0.0, highest > 0.0 ? 1.1 * highest : 1.0};
  figure.caption =
      "Means of the participants' means with 95 % confidence intervals over participants; small "
      "circles are participants. The test "
      "of the interaction asks whether the lines are parallel.";
  return figure;
}

Figure learning(const StudyResult& study) {
  const auto& statistics = study.statistics;
  Figure figure;
  figure.name = "learning";
  figure.title = "Recall error over the repetitions of a trajectory";
  figure.x_label = "Repetition within the block";
  figure.y_label = "Recall error (0 is perfect)";
  std::int32_t last = 1;
  double highest = 0.0;
  for (std::size_t c = 0; c < statistics.conditions.size(); ++c) {
    Series series{capitalized(statistics.conditions[c]), Mark::kLinkedBars, condition_look(c)};
    Series people = points_behind(series.look);
    const double aside = 0.04 * (static_cast<double>(c) -
                                 0.5 * static_cast<double>(statistics.conditions.size() - 1));
    for (const auto& point : statistics.learning) {
      if (point.condition != statistics.conditions[c] || !point.mean) {
        continue;
      }
      series.x.push_back(point.repetition + aside);
      series.y.push_back(*point.mean);
      series.low.push_back(point.interval ? point.interval->low : *point.mean);
      series.high.push_back(point.interval ? point.interval->high : *point.mean);
      last = std::max(last, point.repetition);
      highest = std::max(highest, series.high.back());
      add_people(
          study, series.x.back() + kBeside,
          [&](const TrialScore& s) {
            return s.condition == point.condition && s.repetition == point.repetition;
          },
          people, highest);
    }
    figure.series.push_back(std::move(people));
    figure.series.push_back(std::move(series));
  }
  for (std::int32_t r = 1; r <= last; ++r) {
    figure.x_names.emplace_back(r, std::to_string(r));
  }
  figure.x_range = Range{0.7, last + 0.3};
  figure.y_range = Range{0.0, highest > 0.0 ? 1.1 * highest : 1.0};
  figure.caption =
      "Recall error at each repetition of the same trajectory and force pattern: means of the "
      "participants' means with 95 % confidence intervals over participants; small circles are "
      "participants.";
  figure.alt = "Mean recall error over repetitions:";
  for (const auto& point : statistics.learning) {
    if (point.mean) {
      figure.alt +=
          fmt::format(" {} {}: {};", point.condition, point.repetition, number(*point.mean));
    }
  }
  return figure;
}

Figure learning_over_blocks(const StudyResult& study) {
  Figure figure;
  figure.name = "learning-over-blocks";
  figure.title = "Recall error over the session";
  figure.x_label = "Block";
  figure.y_label = "Recall error (0 is perfect)";
  Series series{"", Mark::kLinkedBars, {kBlue, kSolid, 7, 2.0, 1.1}};
  Series people = points_behind(series.look);
  double highest = 0.0;
  for (const auto& point : study.statistics.blocks) {
    if (!point.mean) {
      continue;
    }
    series.x.push_back(point.block);
    series.y.push_back(*point.mean);
    series.low.push_back(point.interval ? point.interval->low : *point.mean);
    series.high.push_back(point.interval ? point.interval->high : *point.mean);
    highest = std::max(highest, series.high.back());
    add_people(
        study, point.block + 0.25, [&](const TrialScore& s) { return s.block == point.block; },
        people, highest);
    figure.alt += fmt::format(" {} {};", point.block, number(*point.mean));
  }
  figure.series.push_back(std::move(people));
  figure.series.push_back(std::move(series));
  figure.y_range = Range{0.0, highest > 0.0 ? 1.1 * highest : 1.0};
  figure.caption =
      std::string() +
      "Recall error in each block, those of later sessions after those of earlier ones: means of "
      "the participants' means with 95 % "
      "confidence intervals over participants; small circles are participants. " +
      sentence_of(order_balance(study.scores, study.statistics.conditions));
  figure.alt = "Mean recall error by block:" + figure.alt;
  return figure;
}

std::vector<double> time_base(const RecallPicture& picture) {
  std::vector<double> times(picture.target.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = picture.duration * static_cast<double>(i) /
               static_cast<double>(std::max<std::size_t>(times.size() - 1, 1));
  }
  return times;
}

std::string recall_title(const char* what, const RecallPicture& picture) {
  return fmt::format("{}: {} recall, {} trial {} ({})", what, picture.which, picture.score.subject,
                     picture.score.trial, picture.score.condition);
}

constexpr const char* kTime = "Time [s]";
constexpr const char* kPlace = "Place on the path, at its speed [s]";

Figure force_figure(const char* name, const RecallPicture& picture, const char* what,
                    bool over_path) {
  Figure figure;
  figure.name = fmt::format("{}-{}", name, picture.which);
  figure.title = recall_title(what, picture);
  figure.x_label = over_path ? kPlace : kTime;
  figure.y_label = "Normal force [N]";
  figure.x_range = Range{0.0, picture.duration};
  return figure;
}

Figure alignment(const RecallPicture& picture, bool over_path) {
  constexpr std::size_t kFewPairs = 60;  // drawn of the path
  Figure figure = force_figure("figure-26-alignment", picture, "Alignment", over_path);
  const auto times = time_base(picture);
  Series pairs{"aligned points", Mark::kSegments, {kGrey, kSolid, 0, 0.8}};
  const std::size_t stride = std::max<std::size_t>(1, picture.pairs.size() / kFewPairs);
  for (std::size_t k = 0; k < picture.pairs.size(); k += stride) {
    const auto [target, applied] = picture.pairs[k];
    pairs.x.push_back(times[target]);
    pairs.y.push_back(picture.target[target]);
    pairs.x2.push_back(times[applied]);
    pairs.y2.push_back(picture.applied[applied]);
  }
  figure.series = {pairs,
                   {"target", Mark::kLine, {kOrange, kSolid, 0, 2.5}, times, picture.target},
                   {"applied", Mark::kLine, {kBlue, kLong, 0, 2.5}, times, picture.applied}};
  figure.caption = fmt::format(
      "The pairing that dynamic programming found for the {} trial of the study (score {}): lines "
      "join points of the target and of the applied force that belong together.",
      picture.which, number(picture.score.score));
  figure.alt = "Target and applied force over time, joined by the lines of the alignment.";
  return figure;
}

Figure warped(const RecallPicture& picture, bool over_path) {
  Figure figure = force_figure("figure-27-warped", picture, "After warping", over_path);
  const auto times = time_base(picture);
  figure.series = {{"target", Mark::kLine, {kOrange, kSolid, 0, 2.5}, times, picture.target},
                   {"applied, warped", Mark::kLine, {kBlue, kLong, 0, 2.5}, times, picture.warped}};
  figure.caption = fmt::format(
      "The same trial after warping the applied force onto the time base of the target: RMS "
      "difference {1}{0}N, {2}{0}N before any alignment.",
      kNoBreak, number(picture.score.rms_force), number(picture.score.rms_unaligned));
  figure.alt = "Target force and warped applied force over time.";
  return figure;
}

Figure trajectory(const std::vector<record::StimulusRow>& rows) {
  Figure figure;
  figure.name = "figure-22-trajectory";
  figure.title = "A spatial trajectory";
  figure.x_label = "x [cm]";
  figure.y_label = "z [cm]";
  Series path{"", Mark::kLine, {kBlue, kSolid, 0, 2.5}};
  for (const auto& row : rows) {
    path.x.push_back(100.0 * row.position.x());
    path.y.push_back(100.0 * row.position.z());
  }
  const auto [left, right] = std::minmax_element(path.x.begin(), path.x.end());
  figure.x_range = Range{*left, *right};
  figure.equal_scale = true;
  figure.series = {path};
  figure.caption = "The spatial trajectory of the first block of the first session, from above.";
  figure.alt = "A winding line from left to right.";
  return figure;
}

Figure force_pattern(const std::vector<record::StimulusRow>& rows) {
  Figure figure;
  figure.name = "figure-23-force-pattern";
  figure.title = "A force pattern";
  figure.x_label = "Time [s]";
  figure.y_label = "Target normal force [N]";
  Series force{"", Mark::kLine, {kOrange, kSolid, 0, 2.5}};
  for (const auto& row : rows) {
    force.x.push_back(row.time);
    force.y.push_back(row.force);
  }
  figure.x_range = Range{rows.front().time, rows.back().time};
  figure.series = {force};
  figure.caption =
      "The magnitude of the downward force that the participant was to learn in the same block.";
  figure.alt = "A force that rises and falls several times over the seconds of a pass.";
  return figure;
}

}  // namespace

std::vector<Figure> study_figures(const StudyResult& study) {
  std::vector<Figure> figures;
  if (!study.scores.empty()) {
    figures.push_back(recall_error(study));
    if (study.statistics.table.factors.size() == 2 && study.statistics.table.crossed) {
      figures.push_back(interaction(study));
    }
    if (std::any_of(study.scores.begin(), study.scores.end(),
                    [&](const auto& s) { return s.repetition != study.scores[0].repetition; })) {
      figures.push_back(learning(study));
    }
    if (study.statistics.blocks.size() > 1) {
      figures.push_back(learning_over_blocks(study));
    }
  }
  for (const auto& picture : study.recalls) {
    figures.push_back(alignment(picture, study.over_path));
    figures.push_back(warped(picture, study.over_path));
  }
  if (study.stimulus.size() > 1) {
    figures.push_back(trajectory(study.stimulus));
    figures.push_back(force_pattern(study.stimulus));
  }
  for (auto& figure : figures) {
    figure.simulated = study.simulated();
  }
  return figures;
}

}  // namespace haptrial::analysis
