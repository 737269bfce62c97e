#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

namespace haptrial::scene {
namespace {

const Schema<GratingParameters>& grating_schema() {
  using P = GratingParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .required()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("amplitude", &P::amplitude, {0.0, 0.1}, "m",
                  "Amplitude of a relief or of a vibration")
          .required()
          .number("period", &P::period, kLengthBounds, "m", "Period of a grating")
          .required()
          .number("phase", &P::phase, {-1e3, 1e3}, "periods",
                  "Phase of a grating or of a vibration")
          .choice("profile", &P::profile,
                  {{"sine", P::Profile::kSine}, {"rounded", P::Profile::kRounded}},
                  "Profile of a grating: a sine, or flat ridges and grooves with soft edges");
  return schema;
}

const Schema<TextureParameters>& texture_schema() {
  using P = TextureParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .required()
          .any_direction("normal", &P::normal, kNormal)
          .required()
          .number("roughness", &P::roughness, {0.0, 0.1}, "m",
                  "Root mean square of a texture's height")
          .required()
          .number("lowest", &P::lowest, {0.0, 1e5, true}, "1/m", kLowest)
          .required()
          .number("highest", &P::highest, {0.0, 1e5, true}, "1/m", kHighest)
          .required()
          .seed("seed", &P::seed, kSeed)
          .required()
          .check([](Table& table, P& p) {
            if (!(p.highest > p.lowest)) {
              table.reject("highest", fmt::format("{}", p.highest),
                           fmt::format("a number above lowest, {}", p.lowest));
              p.highest = 2.0 * p.lowest;
            }
          });
  return schema;
}

}  // namespace

KindOfField grating_field() {
  return {
      .word = "grating", .read = read_by<GratingParameters, grating_schema>, .has_limit = false};
}

KindOfField texture_field() {
  return {
      .word = "texture", .read = read_by<TextureParameters, texture_schema>, .has_limit = false};
}

}  // namespace haptrial::scene
