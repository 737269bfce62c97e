#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/procedure/staircase.h"
#include "core/psychometric/procedure/staircase_chain.h"

namespace haptrial::psychometric {
namespace {

std::vector<StaircaseStep> read_steps(Table& table, const std::string& key) {
  const char* allowed = "sizes above 0, or pairs [down, up]: [0.08, 0.04] or [[0.02, 0.04]]";
  std::vector<StaircaseStep> steps;
  const auto rows = table.rows(key, allowed);
  const auto add = [&](double down, double up) {
    steps.push_back({down, up, static_cast<int>(steps.size())});
  };
  bool good = !rows.empty();
  for (const auto& row : rows) {
    const bool pairs = rows.size() > 1 || table.is_nested(key);
    good = good && std::all_of(row.begin(), row.end(), [](const NumberOrText& each) {
             return each.number.value_or(0) > 0;
           });
    if (!good) {
      break;
    }
    if (pairs && row.size() == 2) {
      add(*row[0].number, *row[1].number);
    } else if (!pairs) {
      for (const NumberOrText& each : row) {
        add(*each.number, *each.number);
      }
    } else {
      good = false;
    }
  }
  if (!good) {
    table.reject(key, "another list", allowed);
    return {{1.0, 1.0, 0}};
  }
  return steps;
}

const Schema<StaircaseParameters>& estimate_schema() {
  using P = StaircaseParameters;
  static const auto schema =
      Schema<P>()
          .choice("of", &P::estimator,
                  {{"mean of reversals", P::Estimator::kMeanOfReversals},
                   {"median of reversals", P::Estimator::kMedianOfReversals},
                   {"mean of levels", P::Estimator::kMeanOfLevels}},
                  "Statistic of a staircase that estimates the threshold")
          .required()
          .integer("skip", &P::skip, 0, 1000,
                   "First reversals, or levels, that the estimate of a staircase leaves out")
          .integer("last", &P::last, 0, 1000,
                   "Number of the last reversals, or levels, that alone count for the estimate of "
                   "a staircase")
          .otherwise("all");
  return schema;
}

const Schema<StaircaseParameters>& staircase_schema() {
  using P = StaircaseParameters;
  static const auto schema =
      Schema<P>()
          .integer("down", &P::down, 1, 100,
                   "Right answers in a row after which a staircase makes the task harder")
          .integer("up", &P::up, 1, 100,
                   "Wrong answers in a row after which a staircase makes the task easier")
          .integer("first_down", &P::first_down, 0, 100,
                   "Right answers in a row for a harder task before the first reversal; 0: as "
                   "after it")
          .integer("first_up", &P::first_up, 0, 100,
                   "Wrong answers in a row for an easier task before the first reversal; 0: as "
                   "after it")
          .custom(
              "steps", kStepsText,
              [](Table& table, const std::string& key, P& p) { p.steps = read_steps(table, key); })
          .required()
          .otherwise(kProceduresOwn)
          .choice("schedule", &P::schedule,
                  {{"reversals", P::Schedule::kReversals}, {"trials", P::Schedule::kTrials}},
                  "Event after each of which a staircase takes the next size of its steps")
          .choice("at_bound", &P::at_bound,
                  {{"hold", P::AtBound::kHold},
                   {"uncounted", P::AtBound::kHoldUncounted},
                   {"end", P::AtBound::kEnd}},
                  "Consequence of a step beyond the range: the level stays, stays and the turn is "
                  "no reversal, or the track ends")
          .flag("right_raises", &P::right_raises, kRightRaisesText);
  return schema;
}

void add_estimate(const Track& track, const StaircaseParameters& p,
                  std::vector<std::string>& words) {
  const bool levels = p.estimator == StaircaseParameters::Estimator::kMeanOfLevels;
  const int most = levels                 ? p.stop_trials
                   : p.stop_reversals > 0 ? std::min(p.stop_reversals, p.stop_trials)
                                          : p.stop_trials;
  if (p.skip >= most) {
    words.push_back(
        fmt::format("{}: the estimate skips {} {}, and the track stops at {}, so that there will "
                    "never be an estimate",
                    track.name, p.skip, levels ? "trials" : "reversals", most));
  }
}

void add_steps(const Track& track, const StaircaseParameters& p, std::vector<std::string>& words) {
  const bool trials = p.schedule == StaircaseParameters::Schedule::kTrials;
  const int most = !trials && p.stop_reversals > 0 ? p.stop_reversals : p.stop_trials;
  const auto unused =
      std::ranges::count_if(p.steps, [&](const StaircaseStep& step) { return step.from >= most; });
  if (unused > 0) {
    words.push_back(
        fmt::format("{}: {} of {} sizes of steps are never used, since the track stops "
                    "at {} {}",
                    track.name, unused, p.steps.size(), most, trials ? "trials" : "reversals"));
  }
}

/// "2 right answers in a row".
std::string answers(int count, const char* which) {
  return count == 1 ? fmt::format("each {} answer", which)
                    : fmt::format("{} {} answers in a row", count, which);
}

std::string step_words(const StaircaseParameters& p) {
  std::vector<double> down, up;
  for (const StaircaseStep& step : p.steps) {
    down.push_back(step.down);
    up.push_back(step.up);
  }
  const std::string sizes = down == up ? words_of(down)
                                       : fmt::format("{} to a harder task and {} to an easier one",
                                                     words_of(down), words_of(up));
  const bool trials = p.schedule == StaircaseParameters::Schedule::kTrials;
  return fmt::format("Steps were {} [{}]{}.", sizes,
                     p.axis.x_unit().empty() ? "the level" : p.axis.x_unit(),
                     p.steps.size() == 1 ? ""
                     : trials            ? ", the next one after each trial"
                                         : ", the next one after each reversal");
}

std::string estimate_words(const StaircaseParameters& p) {
  using Estimator = StaircaseParameters::Estimator;
  const bool levels = p.estimator == Estimator::kMeanOfLevels;
  const std::string of = levels ? "levels" : "reversals";
  return fmt::format("The estimate is the {} of {}{}{}.",
                     p.estimator == Estimator::kMedianOfReversals ? "median" : "mean", of,
                     p.skip > 0 ? fmt::format(" without the first {}", p.skip) : "",
                     p.last > 0 ? fmt::format(", of the last {} alone", p.last) : "");
}

std::string rule_words(const Track& track, const StaircaseParameters& p, const TrackStop& stop) {
  std::string words = fmt::format(
      "It began at {:g}. After {} the task became harder (the level {}), after {} easier", p.start,
      answers(p.down, "right"), p.right_raises ? "rose" : "fell", answers(p.up, "wrong"));
  if (p.first_down > 0 || p.first_up > 0) {
    words += fmt::format("; before the first reversal after {} and {}",
                         answers(p.first_down > 0 ? p.first_down : p.down, "right"),
                         answers(p.first_up > 0 ? p.first_up : p.up, "wrong"));
  }
  words += track.balance ? fmt::format(", a rule in balance at {:.1f} % right answers.",
                                       100.0 * *track.balance)
                         : ".";
  return fmt::format("{} {} {} {}", words, step_words(p), words_of(stop), estimate_words(p));
}

}  // namespace

void read_staircase(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  track.finds_level = true;
  StaircaseParameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  p.start = read_start(keys, track);
  staircase_schema().read(keys.track, keys.procedure, p);
  track.falls = p.right_raises;
  const TrackStop stop = read_stop(keys, track);
  p.stop_reversals = stop.reversals;
  p.stop_trials = stop.trials;
  if (keys.has("estimate")) {
    Table estimate = keys.of("estimate").table("estimate");
    estimate_schema().read(estimate, p);
  }
  for (const StaircaseStep& step : p.steps) {
    track.steps.insert(track.steps.end(), {step.down, step.up});
  }
  if (p.up == 1) {
    track.balance = balance_of(p.down, p.steps.back());
  }
  track.rule = rule_words(track, p, stop);
  track.begin = [p](std::uint64_t, const std::string&) { return std::make_unique<Staircase>(p); };
  track.predict = [p, share = track.balance.value_or(0.5)](const PsychometricFunction& function) {
    const auto found = predict_staircase(
        p, [&](double level) { return function(level); }, function.level_for(share));
    return TrackPrediction{found.mean, found.deviation, found.trials};
  };
  track.warnings = [p](const Track& named) {
    std::vector<std::string> words;
    add_estimate(named, p, words);
    add_steps(named, p, words);
    return words;
  };
}

}  // namespace haptrial::psychometric
