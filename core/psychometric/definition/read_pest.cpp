#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/procedure/pest.h"

namespace haptrial::psychometric {
namespace {

const Schema<PestParameters>& pest_schema() {
  using P = PestParameters;
  static const auto schema =
      Schema<P>()
          .number("target", &P::target, {0.01, 0.99}, "1",
                  "Share of answers 1, such as right ones, that PEST or a surface seeks")
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

}  // namespace

void read_pest(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  track.finds_level = true;
  PestParameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  p.start = read_start(keys, track);
  pest_schema().read(keys.track, keys.procedure, p);
  const TrackStop stop = read_stop(keys, track);
  p.stop_trials = stop.trials;
  track.falls = p.right_raises;
  track.rule = fmt::format(
      "It sought {:g} % right answers by PEST (Taylor and Creelman 1967) with a deviation of {:g}, "
      "from {:g} on, in steps of {:g} at first and {:g} at most; a step of {:g} ended it. {}",
      100.0 * p.target, p.deviation, p.start, p.first_step, p.largest_step, p.smallest_step,
      words_of(stop));
  track.steps = {p.smallest_step};
  track.begin = [p](std::uint64_t, const std::string&) { return std::make_unique<Pest>(p); };
}

}  // namespace haptrial::psychometric
