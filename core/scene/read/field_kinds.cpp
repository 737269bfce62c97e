#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/scene/read/field_kinds_internal.h"

namespace haptrial::scene {
namespace {

using control::PdGains;

std::vector<KindOfField>& all_fields() {
  static std::vector<KindOfField> kinds{
      constant_field(),     ramp_field(),     pulse_field(),   spring_field(),
      wall_field(),         box_field(),      sphere_field(),  cylinder_field(),
      channel_field(),      plane_field(),    viscous_field(), matrix_viscous_field(),
      inertia_field(),      friction_field(), grating_field(), texture_field(),
      vibration_field(),    tap_field(),      detent_field(),  click_field(),
      minimum_jerk_field(), path_field(),     curve_field(),   measured_field(),
  };
  return kinds;
}

}  // namespace

const std::vector<KindOfField>& kinds_of_field() { return all_fields(); }

void add_kind_of_field(const KindOfField& kind) {
  const std::vector<KindOfField>& kinds = all_fields();
  if (std::ranges::find(kinds, kind.word, &KindOfField::word) != kinds.end()) {
    throw std::invalid_argument(
        fmt::format("add_kind_of_field: there is a field '{}' already", kind.word));
  }
  all_fields().push_back(kind);
}

const Schema<PdGains>& field_gains_schema() {
  static const auto schema =
      Schema<PdGains>()
          .number("stiffness", &PdGains::stiffness, kStiffnessBounds, "N/m",
                  "Stiffness of the spring that holds the hand, or of the bristles of friction")
          .required()
          .number("damping", &PdGains::damping, kDampingBounds, "N·s/m",
                  "Damping against the hand's motion; a surface's begins over the first 1 mm")
          .required();
  return schema;
}

const Schema<Field>& field_limit_schema() {
  static const auto schema = Schema<Field>().number(
      "limit", &Field::limit, {0.0, 100.0, true}, "N",
      "Greatest force of the field or object; a longer one is shortened to it");
  return schema;
}

const Schema<Field>& field_fade_schema() {
  static const auto schema =
      Schema<Field>()
          .number("fade_in", &Field::fade_in, kFadeBounds, "s",
                  "Time over which the force grows after the field or object is switched on; a shorter "
                  "one than 0.01 s counts as 0, and the change fades over envelope.change_time")
          .number("fade_out", &Field::fade_out, kFadeBounds, "s",
                  "Time over which the force goes after the field or object is switched off; a shorter "
                  "one than 0.01 s counts as 0, and the change fades over envelope.change_time");
  return schema;
}

}  // namespace haptrial::scene
