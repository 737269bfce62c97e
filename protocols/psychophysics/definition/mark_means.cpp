#include "protocols/psychophysics/definition/mark_means.h"

#include <algorithm>

#include "core/base/definition/schema.h"

namespace haptrial::protocols {
namespace {

void check_means(Table& table, MarkMeans& mark) {
  if (table.has("length") && mark.by == MarkedBy::kKeys) {
    table.reject("length", "stands alone; add by = \"hand\" or \"mouse\", which move along a line");
  }
  if (table.has("buttons") && mark.by != MarkedBy::kHand) {
    table.reject("buttons", "stands alone; add by = \"hand\", whose answer a button gives");
  } else if (mark.buttons == 0) {
    table.reject("buttons", "an empty list", "at least one button");
  }
}

}  // namespace

double MarkMeans::share_at(double x) const noexcept {
  return std::clamp(0.5 + x / length, 0.0, 1.0);
}

const Schema<MarkMeans>& mark_schema() {
  using M = MarkMeans;
  static const auto schema =
      Schema<M>()
          .choice(
              "by", &M::by,
              {{"keys", MarkedBy::kKeys}, {"hand", MarkedBy::kHand}, {"mouse", MarkedBy::kMouse}},
              "What moves the mark of a scale after a trial: keys, the tool of the first device "
              "or the mouse of the participant's window")
          .number("length", &M::length, {0.01, 1.0}, "m",
                  "Length of the line along x that the hand or the mouse moves the mark on")
          .bits("buttons", &M::buttons,
                "Buttons of the device that give the answer of a mark that the hand moves; Enter "
                "gives it, too")
          .otherwise("[0]")
          .check(check_means);
  return schema;
}

}  // namespace haptrial::protocols
