#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

namespace haptrial::scene {
namespace {

/// Levels of friction on a surface are coefficients, those in free space forces.
template <double FrictionParameters::*level>
void read_level(Table& table, const std::string& key, FrictionParameters& p) {
  const bool free = p.on.empty();
  p.*level = table.number(key, {0.0, free ? 100.0 : 10.0}, free ? "N" : "");
}

const Schema<FrictionParameters>& friction_schema() {
  using P = FrictionParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .otherwise("everywhere")
          .custom("static", "Friction before it slips: a force, or on a surface a coefficient",
                  read_level<&P::static_level>)
          .required()
          .custom("dynamic", "Friction while it slips: a force, or on a surface a coefficient",
                  read_level<&P::dynamic_level>)
          .required()
          .number("stiffness", &P::stiffness, {0.0, kStiffnessBounds.high, true}, "N/m",
                  "Stiffness of the spring that holds the hand, or of the bristles of friction")
          .choice("model", &P::model, {{"bristle", P::Model::kBristle}, {"dahl", P::Model::kDahl}},
                  "Model of friction")
          .check([](Table& table, P& p) {
            const bool dahl = p.model == P::Model::kDahl;
            const bool good =
                dahl ? p.static_level == p.dynamic_level : p.static_level >= p.dynamic_level;
            if (!good) {
              table.reject("static", fmt::format("{}", p.static_level),
                           fmt::format("{} dynamic, {}", dahl ? "the same as" : "at least",
                                       p.dynamic_level));
              p.static_level = p.dynamic_level;
            }
          });
  return schema;
}

}  // namespace

KindOfField friction_field() { return {"friction", read_by<FrictionParameters, friction_schema>}; }

}  // namespace haptrial::scene
