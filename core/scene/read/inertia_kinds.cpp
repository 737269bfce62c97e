#include "core/scene/read/field_kinds_internal.h"

namespace haptrial::scene {
namespace {

const Schema<InertiaParameters>& inertia_schema() {
  using P = InertiaParameters;
  static const auto schema =
      Schema<P>()
          .number("mass", &P::mass, {0.0, 100.0}, "kg", "Virtual mass that the hand feels")
          .required()
          .number("acceleration_filter", &P::acceleration_filter, kFilterBounds, "Hz",
                  "Cut-off of the filter of the hand's acceleration")
          .required();
  return schema;
}

}  // namespace

KindOfField inertia_field() { return {"inertia", read_by<InertiaParameters, inertia_schema>}; }

}  // namespace haptrial::scene
