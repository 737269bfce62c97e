#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

namespace haptrial::scene {
namespace {

const Schema<SpringParameters>& spring_schema() {
  using P = SpringParameters;
  static const auto schema = Schema<P>()
                                 .vector("to", &P::to, kPlaceBounds, "m", kTo)
                                 .required()
                                 .otherwise(kToAbsent)
                                 .keys_of(&P::gains, field_gains_schema());
  return schema;
}

const Schema<LineChannelParameters>& line_channel_schema() {
  using P = LineChannelParameters;
  static const auto schema =
      Schema<P>()
          .vector("from", &P::from, kPlaceBounds, "m", kFrom)
          .required()
          .otherwise(kFromAbsent)
          .vector("to", &P::to, kPlaceBounds, "m", kTo)
          .required()
          .otherwise(kToAbsent)
          .keys_of(&P::gains, field_gains_schema())
          .check([](Table& table, P& p) {
            if (p.from == p.to) {
              table.reject("to", "is the same place as from; write another one");
              p.to.x() += 0.1;
            }
          });
  return schema;
}

void read_axes(Table& table, AxisChannelParameters& p) {
  p.free_x = p.free_y = p.free_z = false;
  for (const std::string& axis : table.texts("axes")) {
    p.free_x = p.free_x || axis == "x";
    p.free_y = p.free_y || axis == "y";
    p.free_z = p.free_z || axis == "z";
    if (axis != "x" && axis != "y" && axis != "z") {
      table.reject("axes", fmt::format("an array with \"{}\"", axis), "\"x\", \"y\", \"z\"");
    }
  }
  if (p.free_x && p.free_y && p.free_z) {
    table.reject("axes", "leaves every axis free; write one or two of them");
  }
}

const Schema<AxisChannelParameters>& axis_channel_schema() {
  using P = AxisChannelParameters;
  static const auto schema =
      Schema<P>()
          .custom("axes", "Axes along which a channel leaves the hand free: x, y, z",
                  [](Table& table, const std::string&, P& p) { read_axes(table, p); })
          .required()
          .vector("through", &P::through, kPlaceBounds, "m", "Point of a channel or plane")
          .required()
          .keys_of(&P::gains, field_gains_schema());
  return schema;
}

FieldKind read_channel(Table& table, const FieldSetting&) {
  if (table.has("from") || table.has("to")) {
    return line_channel_schema().read(table);
  }
  return axis_channel_schema().read(table);
}

const Schema<PlaneParameters>& plane_schema() {
  using P = PlaneParameters;
  static const auto schema =
      Schema<P>()
          .vector("through", &P::through, kPlaceBounds, "m", "Point of a channel or plane")
          .required()
          .any_direction("normal", &P::normal, kNormal)
          .required()
          .keys_of(&P::gains, field_gains_schema());
  return schema;
}

}  // namespace

KindOfField spring_field() { return {"spring", read_by<SpringParameters, spring_schema>}; }

KindOfField channel_field() { return {"channel", read_channel}; }

KindOfField plane_field() { return {"plane", read_by<PlaneParameters, plane_schema>}; }

}  // namespace haptrial::scene
