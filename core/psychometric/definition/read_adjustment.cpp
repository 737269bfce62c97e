#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>

#include <vector>

#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/procedure/adjusting.h"

namespace haptrial::psychometric {
namespace {

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

}  // namespace

void read_adjustment(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  track.finds_level = true;
  AdjustingParameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  starts_schema().read(keys.track, keys.procedure, p.starts.levels);
  list_schema().read(keys.track, keys.procedure, p.starts);
  adjusting_schema().read(keys.track, keys.procedure, p);
  track.steps = p.steps;
  track.most_trials =
      static_cast<int>(p.starts.levels.size()) * p.starts.repetitions * p.most_presentations;
  track.rule = fmt::format(
      "Adjustments began at {}, {} from each start, in steps of {}, finer after each turn. The "
      "setting is the level at which the participant left it, and the estimate the mean of the "
      "settings; after {} presentations an adjustment ended without one.",
      words_of(p.starts.levels),
      p.starts.repetitions == 1 ? std::string("once")
                                : fmt::format("{} times", p.starts.repetitions),
      words_of(p.steps), p.most_presentations);
  track.begin = [p](std::uint64_t seed, const std::string& name) {
    return std::make_unique<Adjusting>(p, seed, name);
  };
}

}  // namespace haptrial::psychometric
