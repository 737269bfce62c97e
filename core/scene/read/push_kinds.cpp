#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

namespace haptrial::scene {
namespace {

const Schema<ConstantParameters>& constant_schema() {
  static const auto schema = Schema<ConstantParameters>()
                                 .vector("force", &ConstantParameters::force, kForceBounds, "N",
                                         "Force of the field in the world frame")
                                 .required();
  return schema;
}

const Schema<RampParameters>& ramp_schema() {
  using P = RampParameters;
  static const auto schema =
      Schema<P>()
          .vector("to", &P::to, kForceBounds, "N", kTo)
          .required()
          .otherwise(kToAbsent)
          .number("rise", &P::rise, kDurationBounds, "s",
                  "Time over which the force of a ramp or of an edge of a pulse grows")
          .required()
          .vector("from", &P::from, kForceBounds, "N", kFrom)
          .otherwise(kFromAbsent);
  return schema;
}

const Schema<PulseParameters>& pulse_schema() {
  using P = PulseParameters;
  static const auto schema =
      Schema<P>()
          .vector("force", &P::force, kForceBounds, "N", "Force of the field in the world frame")
          .required()
          .number("duration", &P::duration, kDurationBounds, "s",
                  "Duration of a pulse or of a movement")
          .required()
          .number("delay", &P::delay, {0.0, kDurationBounds.high}, "s",
                  "Time from the beginning of the stage to a pulse")
          .number("rise", &P::rise, {0.0, kDurationBounds.high}, "s",
                  "Time over which the force of a ramp or of an edge of a pulse grows")
          .check([](Table& table, P& p) {
            if (p.rise > 0.5 * p.duration) {
              table.reject("rise", fmt::format("{} s", p.rise),
                           fmt::format("at most half the duration, {} s", 0.5 * p.duration));
              p.rise = 0.5 * p.duration;
            }
          });
  return schema;
}

}  // namespace

KindOfField constant_field() { return {"constant", read_by<ConstantParameters, constant_schema>}; }

KindOfField ramp_field() { return {"ramp", read_by<RampParameters, ramp_schema>, kNoFade}; }

KindOfField pulse_field() { return {"pulse", read_by<PulseParameters, pulse_schema>, kNoFade}; }

}  // namespace haptrial::scene
