#include "core/psychometric/definition/read_procedure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/psychometric/definition/expectation.h"
#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/read_quest.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/procedure/adjusting.h"
#include "core/psychometric/procedure/listed.h"
#include "core/psychometric/procedure/pest.h"
#include "core/psychometric/procedure/psi_definition.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/staircase.h"

namespace haptrial::psychometric {
namespace {

constexpr long kMostTrials = 100000;

double number(const TrackKeys& keys, const char* key, const Bounds& bounds, const char* unit) {
  return keys.of(key).number(key, bounds, unit);
}
double number_or(const TrackKeys& keys, const char* key, double otherwise, const Bounds& bounds,
                 const char* unit) {
  keys.track.otherwise(key, otherwise);
  return keys.has(key) ? number(keys, key, bounds, unit) : otherwise;
}
int whole_or(const TrackKeys& keys, const char* key, int otherwise, int low, int high) {
  keys.track.otherwise(key, otherwise);
  return keys.has(key) ? static_cast<int>(keys.of(key).integer(key, low, high)) : otherwise;
}
bool truth_of(const TrackKeys& keys, const char* key) {
  keys.track.otherwise(key, "false");
  return keys.has(key) && keys.of(key).boolean(key);
}

void read_range(const TrackKeys& keys, Track& track) {
  const std::vector<double> range = keys.of("range").numbers("range", {}, track.unit);
  if (range.size() != 2 || !(range[0] < range[1])) {
    keys.of("range").reject("range", "another list", "[lowest, highest]");
    track.high = 1.0;
    return;
  }
  track.low = range[0];
  track.high = range[1];
}

/// Reversals and trials at which a track stops; 0: not by these.
struct Stop {
  int reversals{0};
  int trials{0};
  double entropy{0.0};
};

Stop read_stop(const TrackKeys& keys) {
  Stop stop;
  Table table = keys.of("stop").table("stop");
  if (table.has("reversals")) {
    stop.reversals = static_cast<int>(table.integer("reversals", 1, 1000));
  }
  if (table.has("trials")) {
    stop.trials = static_cast<int>(table.integer("trials", 1, kMostTrials));
  }
  if (table.has("entropy")) {
    stop.entropy = table.number("entropy", kPositive, "nat");
  }
  if (stop.trials == 0) {
    keys.of("stop").reject("stop",
                           "names no number of trials, so a session might never end; add "
                           "trials = … to it");
    stop.trials = 1;
  }
  return stop;
}

std::vector<StaircaseStep> read_steps(const TrackKeys& keys) {
  const char* allowed = "sizes above 0, or pairs [down, up]: [0.08, 0.04] or [[0.02, 0.04]]";
  std::vector<StaircaseStep> steps;
  const auto rows = keys.of("steps").rows("steps", allowed);
  const auto add = [&](double down, double up) {
    steps.push_back({down, up, static_cast<int>(steps.size())});
  };
  bool good = !rows.empty();
  for (const auto& row : rows) {
    const bool pairs = rows.size() > 1 || keys.of("steps").is_nested("steps");
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
    keys.of("steps").reject("steps", "another list", allowed);
    return {{1.0, 1.0, 0}};
  }
  return steps;
}

void read_estimate(const TrackKeys& keys, StaircaseParameters& p) {
  if (!keys.has("estimate")) {
    return;
  }
  using Estimator = StaircaseParameters::Estimator;
  Table table = keys.of("estimate").table("estimate");
  const std::string of =
      table.choice("of", {"mean of reversals", "median of reversals", "mean of levels"});
  p.estimator = of == "mean of levels"        ? Estimator::kMeanOfLevels
                : of == "median of reversals" ? Estimator::kMedianOfReversals
                                              : Estimator::kMeanOfReversals;
  if (table.has("skip")) {
    p.skip = static_cast<int>(table.integer("skip", 0, 1000));
  }
  if (table.has("last")) {
    p.last = static_cast<int>(table.integer("last", 0, 1000));
  }
}

void read_staircase(const TrackKeys& keys, Track& track) {
  read_range(keys, track);
  StaircaseParameters p;
  p.axis = track.axis = read_axis(keys, track);
  p.low = track.low;
  p.high = track.high;
  p.start = number(keys, "start", {track.low, track.high}, track.unit.c_str());
  p.down = whole_or(keys, "down", 2, 1, 100);
  p.up = whole_or(keys, "up", 1, 1, 100);
  p.first_down = whole_or(keys, "first_down", 0, 0, 100);
  p.first_up = whole_or(keys, "first_up", 0, 0, 100);
  p.steps = read_steps(keys);
  if (keys.has("schedule")) {
    const bool trials = keys.of("schedule").choice("schedule", {"reversals", "trials"}) == "trials";
    p.schedule =
        trials ? StaircaseParameters::Schedule::kTrials : StaircaseParameters::Schedule::kReversals;
  }
  if (keys.has("at_bound")) {
    const std::string word = keys.of("at_bound").choice("at_bound", {"hold", "uncounted", "end"});
    p.at_bound = word == "end"         ? StaircaseParameters::AtBound::kEnd
                 : word == "uncounted" ? StaircaseParameters::AtBound::kHoldUncounted
                                       : StaircaseParameters::AtBound::kHold;
  }
  p.right_raises = truth_of(keys, "right_raises");
  track.falls = p.right_raises;
  const Stop stop = read_stop(keys);
  p.stop_reversals = stop.reversals;
  p.stop_trials = stop.trials;
  read_estimate(keys, p);
  track.most_trials = stop.trials;
  track.staircase = p;
  track.begin = [p](std::uint64_t, const std::string&) { return std::make_unique<Staircase>(p); };
}

void read_pest(const TrackKeys& keys, Track& track) {
  read_range(keys, track);
  PestParameters p;
  p.axis = track.axis = read_axis(keys, track);
  p.low = track.low;
  p.high = track.high;
  p.start = number(keys, "start", {track.low, track.high}, track.unit.c_str());
  p.target = number_or(keys, "target", p.target, {0.01, 0.99}, "1");
  p.deviation = number_or(keys, "deviation", p.deviation, kPositive, "1");
  p.first_step = number(keys, "first_step", kPositive, "");
  p.smallest_step = number(keys, "smallest_step", kPositive, "");
  p.largest_step = number(keys, "largest_step", kPositive, "");
  p.stop_trials = read_stop(keys).trials;
  p.right_raises = truth_of(keys, "right_raises");
  track.falls = p.right_raises;
  track.most_trials = p.stop_trials;
  track.begin = [p](std::uint64_t, const std::string&) { return std::make_unique<Pest>(p); };
}

void read_listed(const TrackKeys& keys, Track& track, ListParameters& list) {
  list.levels = read_grid(keys.of("levels"), "levels");
  list.repetitions = whole_or(keys, "repetitions", 1, 1, 10000);
  list.in_rounds = truth_of(keys, "in_rounds");
  const auto [least, most] = std::minmax_element(list.levels.begin(), list.levels.end());
  track.low = list.levels.empty() ? 0.0 : *least;
  track.high = list.levels.empty() ? 0.0 : *most;
  track.most_trials = static_cast<int>(list.levels.size()) * list.repetitions;
  track.listed = true;
}

void read_constant(const TrackKeys& keys, Track& track) {
  ListParameters list;
  read_listed(keys, track, list);
  track.begin = [list](std::uint64_t seed, const std::string& name) {
    return std::make_unique<ConstantStimuli>(list, seed, name);
  };
}

void read_magnitude(const TrackKeys& keys, Track& track) {
  ListParameters list;
  read_listed(keys, track, list);
  std::optional<double> modulus;
  if (keys.has("modulus")) {
    modulus = number(keys, "modulus", kPositive, "");
  }
  track.begin = [list, modulus](std::uint64_t seed, const std::string& name) {
    return std::make_unique<MagnitudeEstimation>(list, modulus, seed, name);
  };
}

/// Steps that get finer, from starts of either side.
void read_adjustment(const TrackKeys& keys, Track& track) {
  read_range(keys, track);
  AdjustingParameters p;
  p.axis = track.axis = read_axis(keys, track);
  p.low = track.low;
  p.high = track.high;
  p.starts.levels = read_grid(keys.of("starts"), "starts");
  p.starts.repetitions = whole_or(keys, "repetitions", 1, 1, 10000);
  p.starts.in_rounds = truth_of(keys, "in_rounds");
  p.steps = keys.of("steps").numbers("steps", kPositive, "");
  p.most_presentations = whole_or(keys, "most_presentations", p.most_presentations, 1, 1000);
  track.most_trials =
      static_cast<int>(p.starts.levels.size()) * p.starts.repetitions * p.most_presentations;
  track.begin = [p](std::uint64_t seed, const std::string& name) {
    return std::make_unique<Adjusting>(p, seed, name);
  };
}

/// The levels that a psi may present, as the range of a track.
PsiParameters read_psi_function(const TrackKeys& keys, Track& track) {
  PsiParameters p;
  p.levels = read_grid(keys.of("levels"), "levels");
  const auto [least, most] = std::minmax_element(p.levels.begin(), p.levels.end());
  track.low = p.levels.empty() ? 0.0 : *least;
  track.high = p.levels.empty() ? 1.0 : *most;
  p.function.axis = track.axis = read_axis(keys, track);
  p.function.guess = number_or(keys, "guess", 0.5, {0.0, 0.99}, "1");
  if (keys.has("function")) {
    try {
      set_sigmoid(p.function, keys.of("function").text("function"), Scale::kLog10);
    } catch (const std::invalid_argument& error) {
      keys.of("function").reject("function", fmt::format("is refused: {}", error.what()));
    }
  }
  track.falls = p.function.falling;
  return p;
}

/// The levels and, as a threshold may lie beyond what can be presented, as many as half of them on
/// either side, on the axis.
std::vector<double> thresholds_around(const PsiParameters& p, const Track& track) {
  std::vector<double> values = p.levels;
  if (values.size() < 2) {
    return values;
  }
  const Axis& axis = p.function.axis;
  const double low = axis.at(track.low), high = axis.at(track.high);
  const double step = (high - low) / static_cast<double>(values.size() - 1);
  for (std::size_t i = 1; i <= (p.levels.size() + 1) / 2; ++i) {
    values.push_back(axis.level(low - static_cast<double>(i) * step));
    values.push_back(axis.level(high + static_cast<double>(i) * step));
  }
  std::ranges::sort(values);
  return values;
}

void read_psi(const TrackKeys& keys, Track& track) {
  PsiParameters p = read_psi_function(keys, track);
  const auto axis_of = [&](double level) { return p.function.axis.at(level); };
  const double span = std::abs(axis_of(track.high) - axis_of(track.low));
  p.threshold.values = keys.has("threshold") ? read_grid(keys.of("threshold"), "threshold")
                                             : thresholds_around(p, track);
  p.width.values = keys.has("width") ? read_grid(keys.of("width"), "width")
                                     : std::vector{0.125 * span, 0.25 * span, 0.5 * span, span};
  p.lapse.values =
      keys.has("lapse") ? read_grid(keys.of("lapse"), "lapse") : std::vector{0.0, 0.02, 0.05};
  p.width.nuisance = p.lapse.nuisance = truth_of(keys, "marginal");
  const Stop stop = read_stop(keys);
  track.most_trials = stop.trials;
  try {
    const auto tables = std::make_shared<const QuestTables>(psi_definition(p));
    begin_with(keys, tables, {stop.trials, stop.entropy}, track);
  } catch (const std::invalid_argument& error) {
    keys.of("levels").reject("levels", fmt::format("cannot be used as stated: {}", error.what()));
  }
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
    read_psi(keys, track);
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
