#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

namespace haptrial::scene {
namespace {

/// A frequency that the loop cannot present is refused.
void keep_below_half_rate(Table& table, const char* key, double& frequency, double rate) {
  if (!(frequency < 0.5 * rate)) {
    table.reject(key, fmt::format("{} Hz", frequency),
                 fmt::format("a number below half the servo loop's rate, {} Hz", 0.5 * rate));
    frequency = 0.25 * rate;
  }
}

const Schema<NoiseVibrationParameters>& noise_schema() {
  using P = NoiseVibrationParameters;
  static const auto schema = Schema<P>()
                                 .any_direction("direction", &P::direction, kDirection)
                                 .required()
                                 .number("rms", &P::rms, kStrengthBounds, "N",
                                         "Root mean square of a vibration that is noise")
                                 .otherwise("a sine with amplitude")
                                 .number("lowest", &P::lowest, kFilterBounds, "Hz", kLowest)
                                 .required()
                                 .number("highest", &P::highest, kFilterBounds, "Hz", kHighest)
                                 .required()
                                 .seed("seed", &P::seed, kSeed)
                                 .required();
  return schema;
}

const Schema<SineVibrationParameters>& sine_schema() {
  using P = SineVibrationParameters;
  static const auto schema =
      Schema<P>()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("amplitude", &P::amplitude, kStrengthBounds, "N",
                  "Amplitude of a relief or of a vibration")
          .required()
          .number("frequency", &P::frequency, kFilterBounds, "Hz",
                  "Frequency of a vibration or tap")
          .required()
          .number("phase", &P::phase, {-7.0, 7.0}, "rad", "Phase of a grating or of a vibration");
  return schema;
}

FieldKind read_vibration(Table& table, const FieldSetting& setting) {
  if (!table.has("rms")) {
    SineVibrationParameters p = sine_schema().read(table);
    keep_below_half_rate(table, "frequency", p.frequency, setting.rate);
    return p;
  }
  NoiseVibrationParameters p = noise_schema().read(table);
  keep_below_half_rate(table, "lowest", p.lowest, setting.rate);
  keep_below_half_rate(table, "highest", p.highest, setting.rate);
  if (!(p.highest > p.lowest)) {
    table.reject("highest", fmt::format("{} Hz", p.highest),
                 fmt::format("a number above lowest, {} Hz", p.lowest));
    p.highest = 0.5 * (p.lowest + 0.5 * setting.rate);
  }
  return p;
}

const Schema<TapParameters>& tap_schema() {
  using P = TapParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .otherwise("everywhere")
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .only_if([](const P& p) { return p.on.empty(); })
          .custom("amplitude", "Amplitude of a relief or of a vibration",
                  [](Table& table, const std::string& key, P& p) {
                    p.amplitude = table.number(key, {0.0, 1e3}, p.on.empty() ? "N" : "N·s/m");
                  })
          .required()
          .number("frequency", &P::frequency, kFilterBounds, "Hz",
                  "Frequency of a vibration or tap")
          .required()
          .number("decay", &P::decay, kDurationBounds, "s", "Time constant at which a tap decays")
          .required();
  return schema;
}

FieldKind read_tap(Table& table, const FieldSetting& setting) {
  TapParameters p = tap_schema().read(table);
  keep_below_half_rate(table, "frequency", p.frequency, setting.rate);
  return p;
}

}  // namespace

KindOfField vibration_field() { return {"vibration", read_vibration, kNoFade}; }

KindOfField tap_field() { return {"tap", read_tap, kNoFade}; }

}  // namespace haptrial::scene
