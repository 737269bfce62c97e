#include "protocols/bone_drilling/definition/cavity.h"

#include <fmt/format.h>

#include "core/base/definition/schema.h"

namespace haptrial::protocols {

static std::vector<double> read_margins(Table& table) {
  return table.numbers("margins", {0.0, 0.01}, "m");
}

const Schema<subject::CavityParameters>& cavity_schema() {
  using P = subject::CavityParameters;
  static const auto schema =
      Schema<P>()
          .direction("inward", &P::inward, "Direction into the bone in which the cavity narrows")
          .otherwise("towards the structure that it ends at")
          .text("beside", &P::beside, "Structure of the bone beside which the cavity ends")
          .vector("offset", &P::offset_B, {-1.0, 1.0}, "m",
                  "Offset of the cavity's end from the middle of the structure beside it, in the "
                  "bone's frame")
          .otherwise("[-0.002, 0.007, 0.001]")
          .number("radius", &P::radius, {1e-4, 0.02}, "m", "Radius of the cavity at its end")
          .number("slope", &P::slope, {0.0, 5.0}, "",
                  "Growth of the cavity's radius with the height above its end")
          .number("margin", &P::margin, {0.0, 0.01}, "m",
                  "Bone that is to stay between the cavity and any structure")
          .texts("structures", &P::structures, "Structures that have margins of their own")
          .otherwise("none")
          .custom("margins",
                  "Bone that is to stay at each of the structures that have margins of their own",
                  [](Table& table, const std::string&, P& p) { p.margins = read_margins(table); })
          .otherwise("none")
          .check([](Table& table, P& p) {
            if (table.has("margins") && !table.has("structures")) {
              p.structures = table.texts("structures");
            } else if (table.has("structures") && !table.has("margins")) {
              p.margins = read_margins(table);
            }
            if (p.margins.size() != p.structures.size()) {
              table.reject("margins",
                           fmt::format("has {} numbers; write one for each of the {} structures",
                                       p.margins.size(), p.structures.size()));
              p.margins.resize(p.structures.size(), 0.0);
            }
          });
  return schema;
}

}  // namespace haptrial::protocols
