#include "protocols/psychophysics/definition/mark_means.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "protocols/psychophysics/definition/trials_definition.h"

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

void check_mark(Table& table, const TrialsDefinition& d, const MarkMeans& mark) {
  constexpr double kMostOfScreen = 0.8;  // beside it stand the words of the ends
  const double fits = kMostOfScreen * d.view.width;
  const double reached = 2.0 * d.envelope.workspace_radius;
  const char* key = table.has("length") ? "length" : "by";
  if (mark.length > fits) {
    table.reject(key, fmt::format("a line of {:g} m", mark.length),
                 fmt::format("at most {:g} m, {:g} of display.extent; state a shorter length", fits,
                             kMostOfScreen));
  } else if (mark.by == MarkedBy::kHand && mark.length > reached) {
    table.reject(key, fmt::format("a line of {:g} m", mark.length),
                 fmt::format("at most {:g} m, which the hand reaches within "
                             "envelope.workspace_radius; state a shorter length",
                             reached));
  }
  if (mark.by == MarkedBy::kMouse && d.view.stereo) {
    table.reject("by", "\"mouse\" with display.stereo, where no pointer is on the line",
                 "\"hand\" or \"keys\"");
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

void check_marks(Table& root, const TrialsDefinition& d) {
  std::vector<Table> tables;
  if (root.has("response")) {
    tables.push_back(root.table("response"));
  } else if (root.has("responses")) {
    tables = root.tables("responses");
  }
  for (std::size_t i = 0; i < std::min(tables.size(), d.questions.size()); ++i) {
    if (d.questions[i].mark.by != MarkedBy::kKeys) {
      check_mark(tables[i], d, d.questions[i].mark);
    }
  }
}

}  // namespace haptrial::protocols
