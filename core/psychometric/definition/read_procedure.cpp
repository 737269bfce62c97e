#include "core/psychometric/definition/read_procedure.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/expectation.h"
#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/read_psi.h"
#include "core/psychometric/definition/read_quest.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/procedure/adjusting.h"
#include "core/psychometric/procedure/listed.h"
#include "core/psychometric/procedure/pest.h"
#include "core/psychometric/procedure/staircase.h"

namespace haptrial::psychometric {
namespace {

constexpr long kMostTrials = 100000;

void read_range(Table& table, const std::string& key, Track& track) {
  const std::vector<double> range = table.numbers(key, {}, track.unit);
  if (range.size() != 2 || !(range[0] < range[1])) {
    table.reject(key, "another list", "[lowest, highest]");
    track.high = 1.0;
    track.range_known = false;
    return;
  }
  track.low = range[0];
  track.high = range[1];
}

const Schema<Track>& range_schema() {
  static const auto schema =
      Schema<Track>()
          .custom("range", "Lowest and highest level that the procedure presents", read_range)
          .required()
          .otherwise(kProceduresOwn);
  return schema;
}

/// Reads the range and the axis of a track whose levels are not listed.
void read_range_and_axis(const TrackKeys& keys, Track& track) {
  range_schema().read(keys.track, keys.procedure, track);
  read_axis(keys, track);
}

double read_start(const TrackKeys& keys, const Track& track) {
  Table& table = keys.of("start");
  table.describe(
      {"start", "First level of a staircase or of PEST, within the range", kProceduresOwn, true});
  const double start = table.number("start", {}, track.unit);
  if (track.range_known && (start < track.low || start > track.high)) {
    table.reject("start", fmt::format("{}", start),
                 fmt::format("a number within the range, {} to {}", track.low, track.high));
  }
  return std::clamp(start, track.low, track.high);
}

/// Events at which a track stops; 0: not by these.
struct Stop {
  int reversals{0};
  int trials{0};
  double entropy{0.0};  // [nat]
};

const Schema<Stop>& stop_schema() {
  using S = Stop;
  static const auto schema =
      Schema<S>()
          .integer("reversals", &S::reversals, 1, 1000,
                   "Reversals of a staircase after which the track ends")
          .otherwise("no such end")
          .integer("trials", &S::trials, 1, kMostTrials, "Trials after which the track ends")
          .otherwise("needed")
          .number("entropy", &S::entropy, kPositive, "nat",
                  "Entropy of the posterior of psi or QUEST+ below which the track ends")
          .otherwise("no such end");
  return schema;
}

Stop read_stop(const TrackKeys& keys) {
  Table table = keys.of("stop").table("stop");
  Stop stop = stop_schema().read(table);
  if (stop.trials == 0) {
    keys.of("stop").reject("stop",
                           "names no number of trials, so a session might never end; add "
                           "trials = … to it");
    stop.trials = 1;
  }
  return stop;
}

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

constexpr const char* kStepsText =
    "Sizes of the steps, on the axis of the scale, the next one after each reversal; of a "
    "staircase also pairs [down, up]";
constexpr const char* kRightRaisesText =
    "Whether right answers raise the level; then they get rarer as it rises, and the function of "
    "[analysis] falls (neg_norm)";

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

void read_staircase(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  StaircaseParameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  p.start = read_start(keys, track);
  staircase_schema().read(keys.track, keys.procedure, p);
  track.falls = p.right_raises;
  const Stop stop = read_stop(keys);
  p.stop_reversals = stop.reversals;
  p.stop_trials = stop.trials;
  if (keys.has("estimate")) {
    Table estimate = keys.of("estimate").table("estimate");
    estimate_schema().read(estimate, p);
  }
  track.most_trials = stop.trials;
  track.staircase = p;
  track.begin = [p](std::uint64_t, const std::string&) { return std::make_unique<Staircase>(p); };
}

const Schema<PestParameters>& pest_schema() {
  using P = PestParameters;
  static const auto schema =
      Schema<P>()
          .number("target", &P::target, {0.01, 0.99}, "1", "Share of right answers that PEST seeks")
          .number("deviation", &P::deviation, kPositive, "1",
                  "Deviation of the count of right answers from the target beyond which PEST makes "
                  "a step")
          .number("first_step", &P::first_step, kPositive, "",
                  "First step of PEST, on the axis of the scale")
          .required()
          .otherwise(kProceduresOwn)
          .number("smallest_step", &P::smallest_step, kPositive, "",
                  "Smallest step of PEST, on the axis of the scale; a step as small ends the track")
          .required()
          .otherwise(kProceduresOwn)
          .number("largest_step", &P::largest_step, kPositive, "",
                  "Largest step of PEST, on the axis of the scale")
          .required()
          .otherwise(kProceduresOwn)
          .flag("right_raises", &P::right_raises, kRightRaisesText);
  return schema;
}

void read_pest(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  PestParameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  p.start = read_start(keys, track);
  pest_schema().read(keys.track, keys.procedure, p);
  p.stop_trials = read_stop(keys).trials;
  track.falls = p.right_raises;
  track.most_trials = p.stop_trials;
  track.begin = [p](std::uint64_t, const std::string&) { return std::make_unique<Pest>(p); };
}

const Schema<std::vector<double>>& starts_schema() {
  static const auto schema =
      Schema<std::vector<double>>()
          .custom("starts",
                  "Levels at which adjustments begin: a list, or { from, to, count, spacing }",
                  [](Table& table, const std::string& key, std::vector<double>& starts) {
                    starts = read_grid(table, key);
                  })
          .required()
          .otherwise(kProceduresOwn);
  return schema;
}

/// The order of levels that stand in a list.
const Schema<ListParameters>& list_schema() {
  using L = ListParameters;
  static const auto schema =
      Schema<L>()
          .integer("repetitions", &L::repetitions, 1, 10000,
                   "Presentations of each level, or adjustments from each start")
          .flag("in_rounds", &L::in_rounds,
                "Whether each level, or start, comes once before any comes again");
  return schema;
}

ListParameters read_listed(const TrackKeys& keys, Track& track) {
  ListParameters list;
  list.levels = read_levels(keys);
  list_schema().read(keys.track, keys.procedure, list);
  const auto [least, most] = std::minmax_element(list.levels.begin(), list.levels.end());
  track.low = list.levels.empty() ? 0.0 : *least;
  track.high = list.levels.empty() ? 0.0 : *most;
  track.most_trials = static_cast<int>(list.levels.size()) * list.repetitions;
  track.listed = true;
  return list;
}

void read_constant(const TrackKeys& keys, Track& track) {
  const ListParameters list = read_listed(keys, track);
  track.begin = [list](std::uint64_t seed, const std::string& name) {
    return std::make_unique<ConstantStimuli>(list, seed, name);
  };
}

const Schema<std::optional<double>>& modulus_schema() {
  static const auto schema =
      Schema<std::optional<double>>()
          .custom("modulus", "Number that the first level of a magnitude estimation is called",
                  [](Table& table, const std::string& key, std::optional<double>& modulus) {
                    modulus = table.number(key, kPositive, "");
                  })
          .otherwise("none is stated");
  return schema;
}

void read_magnitude(const TrackKeys& keys, Track& track) {
  const ListParameters list = read_listed(keys, track);
  std::optional<double> modulus;
  modulus_schema().read(keys.track, keys.procedure, modulus);
  track.begin = [list, modulus](std::uint64_t seed, const std::string& name) {
    return std::make_unique<MagnitudeEstimation>(list, modulus, seed, name);
  };
}

const Schema<AdjustingParameters>& adjusting_schema() {
  using P = AdjustingParameters;
  static const auto schema =
      Schema<P>()
          .custom("steps", kStepsText,
                  [](Table& table, const std::string& key, P& p) {
                    p.steps = table.numbers(key, kPositive, "");
                  })
          .required()
          .otherwise(kProceduresOwn)
          .integer("most_presentations", &P::most_presentations, 1, 1000,
                   "Most presentations of one adjustment, which then ends without a setting");
  return schema;
}

/// Steps that get finer, from starts of either side.
void read_adjustment(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  AdjustingParameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  starts_schema().read(keys.track, keys.procedure, p.starts.levels);
  list_schema().read(keys.track, keys.procedure, p.starts);
  adjusting_schema().read(keys.track, keys.procedure, p);
  track.most_trials =
      static_cast<int>(p.starts.levels.size()) * p.starts.repetitions * p.most_presentations;
  track.begin = [p](std::uint64_t seed, const std::string& name) {
    return std::make_unique<Adjusting>(p, seed, name);
  };
}

}  // namespace

const std::vector<std::string>& procedure_kinds() {
  static const std::vector<std::string> kinds{"staircase", "pest",       "psi",      "quest_plus",
                                              "constant",  "adjustment", "magnitude"};
  return kinds;
}

void read_procedure(const TrackKeys& keys, Track& track) {
  if (track.kind == "staircase") {
    read_staircase(keys, track);
  } else if (track.kind == "pest") {
    read_pest(keys, track);
  } else if (track.kind == "psi") {
    const Stop stop = read_stop(keys);
    track.most_trials = stop.trials;
    read_psi(keys, {stop.trials, stop.entropy}, track);
  } else if (track.kind == "quest_plus") {
    const Stop stop = read_stop(keys);
    track.most_trials = stop.trials;
    read_quest(keys, {stop.trials, stop.entropy}, track);
    return;
  } else if (track.kind == "constant") {
    read_constant(keys, track);
  } else if (track.kind == "adjustment") {
    read_adjustment(keys, track);
  } else {
    read_magnitude(keys, track);
  }
  if (keys.has("expect")) {
    track.expected = read_expectation(keys.of("expect"), track.axis);
  }
}

}  // namespace haptrial::psychometric
