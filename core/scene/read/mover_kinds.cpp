#include "core/scene/read/field_kinds_internal.h"

namespace haptrial::scene {
namespace {

const Schema<MoverParameters>& mover_schema() {
  using P = MoverParameters;
  static const auto schema = Schema<P>()
                                 .vector("to", &P::to, kPlaceBounds, "m", kTo)
                                 .required()
                                 .otherwise(kToAbsent)
                                 .number("duration", &P::duration, kDurationBounds, "s",
                                         "Duration of a pulse or of a movement")
                                 .required()
                                 .keys_of(&P::gains, field_gains_schema());
  return schema;
}

}  // namespace

KindOfField minimum_jerk_field() {
  return {"minimum_jerk", read_by<MoverParameters, mover_schema>, kNoFade};
}

}  // namespace haptrial::scene
