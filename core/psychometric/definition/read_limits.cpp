#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/procedure/limits.h"

namespace haptrial::psychometric {
namespace {

const Schema<LimitsParameters>& limits_schema() {
  using P = LimitsParameters;
  static const auto schema =
      Schema<P>()
          .number("step", &P::step, kPositive, "",
                  "Step from one level of a series to the next, on the axis of the scale")
          .required()
          .otherwise(kProceduresOwn)
          .integer("series", &P::series, 1, 1000,
                   "Series of the method of limits, descending and ascending in turn")
          .choice("first", &P::descending_first, {{"descending", true}, {"ascending", false}},
                  "Direction of the first series of the method of limits")
          .integer("start_steps", &P::start_steps, 0, 1000,
                   "Most steps from its end of the range at which a series begins, drawn anew for "
                   "each so that steps cannot be counted");
  return schema;
}

}  // namespace

void read_limits(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  LimitsParameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  limits_schema().read(keys.track, keys.procedure, p);
  track.steps = {p.step};
  track.finds_level = true;
  track.falls = false;
  track.rule = fmt::format(
      "It had {} series, descending and ascending in turn, the first one {}, in steps of {:g}; a "
      "series began up to {} steps from its end of the range and ended at the first change of the "
      "answer. The estimate is the mean of the middles between the last two levels of each series.",
      p.series, p.descending_first ? "descending" : "ascending", p.step, p.start_steps);
  track.most_trials = p.series * Limits::longest_series(p);
  track.begin = [p](std::uint64_t seed, const std::string& name) {
    return std::make_unique<Limits>(p, seed, name);
  };
}

}  // namespace haptrial::psychometric
