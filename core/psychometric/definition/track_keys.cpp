#include "core/psychometric/definition/track_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/track.h"

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

const Schema<Track>& axis_schema() {
  static const auto schema =
      Schema<Track>()
          .custom("scale",
                  "Scale of the axis on which steps and the psychometric function are stated: the "
                  "level's difference to the origin, or a logarithm of it",
                  [](Table& table, const std::string& key, Track& track) {
                    const std::string scale = table.choice(key, {"linear", "log10", "decibel"});
                    track.axis.scale = scale == "log10"     ? Scale::kLog10
                                       : scale == "decibel" ? Scale::kDecibel
                                                            : Scale::kLinear;
                  })
          .otherwise("linear")
          .custom("origin",
                  "Level from which the axis of steps and of the psychometric function counts, "
                  "such as that of the reference",
                  [](Table& table, const std::string& key, Track& track) {
                    track.axis.origin = table.number(key, {}, track.unit);
                  })
          .otherwise("0");
  return schema;
}

const Schema<TrackStop>& stop_schema() {
  using S = TrackStop;
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

}  // namespace

void read_range_and_axis(const TrackKeys& keys, Track& track) {
  range_schema().read(keys.track, keys.procedure, track);
  read_axis(keys, track);
}

const Axis& read_axis(const TrackKeys& keys, Track& track) {
  axis_schema().read(keys.track, keys.procedure, track);
  Axis& axis = track.axis;
  if (axis.scale != Scale::kLinear && track.low <= axis.origin) {
    keys.of("scale").reject("scale", "logarithmic", "\"linear\", or a range above the origin");
    axis.scale = Scale::kLinear;
  }
  return axis;
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

TrackStop read_stop(const TrackKeys& keys, Track& track) {
  Table table = keys.of("stop").table("stop");
  TrackStop stop = stop_schema().read(table);
  if (stop.trials == 0) {
    keys.of("stop").reject("stop",
                           "names no number of trials, so a session might never end; add "
                           "trials = … to it");
    stop.trials = 1;
  }
  track.most_trials = stop.trials;
  return stop;
}

std::string words_of(const TrackStop& stop) {
  std::vector<std::string> ends;
  if (stop.reversals > 0) {
    ends.push_back(fmt::format("{} reversals", stop.reversals));
  }
  if (stop.entropy > 0.0) {
    ends.push_back(fmt::format("an entropy below {:g} nat", stop.entropy));
  }
  ends.push_back(fmt::format("{} trials", stop.trials));
  return fmt::format("It ended after {}{}.", fmt::join(ends, " or "),
                     ends.size() > 1 ? ", whichever came first" : "");
}

std::string words_of(const std::vector<double>& numbers) {
  return fmt::format("{:.10g}", fmt::join(numbers, ", "));
}

}  // namespace haptrial::psychometric
