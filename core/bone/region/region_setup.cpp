#include "core/bone/region/region_setup.h"

#include "core/base/definition/schema.h"

namespace haptrial::bone {
namespace {

struct Usual {
  double stiffness, force_limit;
};

constexpr Usual usual(RegionKind kind) noexcept {
  constexpr Usual kSoft{300.0, 1.5}, kHard{1000.0, 5.0};
  return kind == RegionKind::kHard ? kHard : kSoft;
}

void refuse_force_without(Table& table, RegionSetup& setup) {
  for (const char* key : {"stiffness", "force_limit"}) {
    if (setup.kind == RegionKind::kSound && table.has(key)) {
      table.reject(key, "stands beside kind = \"sound\", which gives no force; leave it out");
    }
  }
  if (setup.structures.empty() && table.has("structures")) {
    table.reject("structures", "is empty; name a structure of the bone");
  }
}

}  // namespace

double RegionSetup::spring() const noexcept {
  return kind == RegionKind::kSound ? 0.0 : stiffness.value_or(usual(kind).stiffness);
}

double RegionSetup::most_force() const noexcept {
  return kind == RegionKind::kSound ? 0.0 : force_limit.value_or(usual(kind).force_limit);
}

const Schema<RegionSetup>& region_schema() {
  using S = RegionSetup;
  static const auto schema =
      Schema<S>()
          .texts("structures", &S::structures,
                 "Structures of the bone, by any of their names, around which burrs are kept away")
          .required()
          .number("margin", &S::margin, {0.0, 0.01}, "m",
                  "Distance from a structure's surface that the burr is to keep")
          .choice("kind", &S::kind,
                  {{"soft", RegionKind::kSoft},
                   {"hard", RegionKind::kHard},
                   {"sound", RegionKind::kSound}},
                  "Effect on a burr that comes nearer: a spring that gives way, one that hardly "
                  "does, or a chime only")
          .number("stiffness", &S::stiffness, {0.0, 2000.0, true}, "N/m",
                  "Stiffness of the spring that pushes the burr out")
          .otherwise("300; of a hard region 1000")
          .number("force_limit", &S::force_limit, {0.0, 100.0, true}, "N",
                  "Greatest force of the region of one structure")
          .otherwise("1.5; of a hard region 5")
          .custom(
              "given_in",
              "Procedures in which the participant feels or hears the regions; every other: the "
              "first participant from the first on, the second from the second on; or the groups "
              "that "
              "alone do so, in every procedure",
              [](Table& table, const std::string& key, S& s) {
                s.given = read_given_in(table, key);
              })
          .otherwise("all")
          .check(refuse_force_without);
  return schema;
}

}  // namespace haptrial::bone
