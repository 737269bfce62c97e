#include "core/scene/read/field_kinds_internal.h"

namespace haptrial::scene {
namespace {

constexpr const char* kVelocityFilter = "Cut-off of the filter of the hand's velocity";

const Schema<ViscousParameters>& viscous_schema() {
  using P = ViscousParameters;
  static const auto schema =
      Schema<P>()
          .number("damping", &P::damping, kDampingBounds, "N·s/m",
                  "Damping against the hand's motion; a surface's begins over the first 1 mm")
          .required()
          .number("velocity_filter", &P::velocity_filter, kFilterBounds, "Hz", kVelocityFilter);
  return schema;
}

const Schema<MatrixViscousParameters>& matrix_viscous_schema() {
  using P = MatrixViscousParameters;
  static const auto schema =
      Schema<P>()
          .custom("matrix", "Matrix B of the force B v",
                  [](Table& table, const std::string& key, P& p) {
                    p.matrix = read_matrix(table, key, {-1e3, 1e3}, "N·s/m");
                  })
          .required()
          .number("velocity_filter", &P::velocity_filter, kFilterBounds, "Hz", kVelocityFilter)
          .required();
  return schema;
}

}  // namespace

KindOfField viscous_field() { return {"viscous", read_by<ViscousParameters, viscous_schema>}; }

KindOfField matrix_viscous_field() {
  return {"matrix_viscous", read_by<MatrixViscousParameters, matrix_viscous_schema>};
}

}  // namespace haptrial::scene
