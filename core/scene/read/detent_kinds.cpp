#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

namespace haptrial::scene {
namespace {

constexpr const char* kAt = "Place of the first detent, or of the top of a click";
constexpr const char* kPeak = "Greatest force of a detent or click, at most the field's limit";

/// A peak above the field's limit would never be felt.
void keep_peak_below_limit(Table& table, double& peak, double limit) {
  if (peak > limit) {
    table.reject("peak", fmt::format("{}", peak), fmt::format("at most the limit, {} [N]", limit));
    peak = limit;
  }
}

const Schema<DetentParameters>& detent_schema() {
  using P = DetentParameters;
  static const auto schema =
      Schema<P>()
          .vector("at", &P::at, kPlaceBounds, "m", kAt)
          .required()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("spacing", &P::spacing, kLengthBounds, "m", "Distance between detents")
          .required()
          .number("peak", &P::peak, kStrengthBounds, "N", kPeak)
          .required()
          .integer("count", &P::count, 1, 1000, "Number of detents")
          .otherwise("no end");
  return schema;
}

FieldKind read_detent(Table& table, const FieldSetting& setting) {
  DetentParameters p = detent_schema().read(table);
  keep_peak_below_limit(table, p.peak, setting.limit);
  return p;
}

const Schema<ClickParameters>& click_schema() {
  using P = ClickParameters;
  static const auto schema =
      Schema<P>()
          .vector("at", &P::at, kPlaceBounds, "m", kAt)
          .required()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("peak", &P::peak, kStrengthBounds, "N", kPeak)
          .required()
          .number("travel", &P::travel, kLengthBounds, "m", "Way of a click up to its peak")
          .required()
          .number("drop", &P::drop, kStrengthBounds, "N", "Drop of a click's force after its peak")
          .required()
          .number("drop_travel", &P::drop_travel, kLengthBounds, "m",
                  "Way over which a click's force drops")
          .required();
  return schema;
}

FieldKind read_click(Table& table, const FieldSetting& setting) {
  ClickParameters p = click_schema().read(table);
  keep_peak_below_limit(table, p.peak, setting.limit);
  if (p.drop > p.peak) {
    table.reject("drop", fmt::format("{} N", p.drop),
                 fmt::format("at most the peak, {} N", p.peak));
    p.drop = p.peak;
  }
  return p;
}

}  // namespace

KindOfField detent_field() { return {"detent", read_detent}; }

KindOfField click_field() { return {"click", read_click}; }

}  // namespace haptrial::scene
