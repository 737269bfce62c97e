#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

#include "core/channel/channel_options.h"

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

const Schema<MeasuredParameters>& measured_schema() {
  using P = MeasuredParameters;
  constexpr Bounds kValue{-1e9, 1e9};
  static const auto schema =
      Schema<P>()
          .vector("gain", &P::gain, {-1e6, 1e6}, "",
                  "Force in the world frame for each unit of the value that the field follows, in "
                  "newtons")
          .required()
          .number("zero", &P::zero, kValue, "",
                  "Value at which the field gives no force, in the value's own unit")
          .flag("stimulus", &P::stimulus,
                "Whether fast changes of the value are a stimulus and no oscillation of the "
                "handle; never for a value that the participant's hand acts on");
  return schema;
}

FieldKind read_measured(Table& table, const FieldSetting& setting) {
  MeasuredParameters p = measured_schema().read(table);
  table.describe({"channel",
                  "Value that the force of the field follows: \"CHANNEL.QUANTITY\", or \"CHANNEL\" "
                  "for the first of a channel",
                  "", true});
  p.channel = channel::read_value_name(table, "channel", setting.values, table.text("channel"));
  return p;
}

}  // namespace

KindOfField measured_field() { return {"measured", read_measured}; }

KindOfField constant_field() { return {"constant", read_by<ConstantParameters, constant_schema>}; }

KindOfField ramp_field() { return {"ramp", read_by<RampParameters, ramp_schema>, kNoFade}; }

KindOfField pulse_field() { return {"pulse", read_by<PulseParameters, pulse_schema>, kNoFade}; }

}  // namespace haptrial::scene
