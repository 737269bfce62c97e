#include "core/bone/record/burr_rows.h"

#include <array>

namespace haptrial::record {

template <>
const Table<BurrRow>& table_of<BurrRow>() {
  using R = BurrRow;
  using T = Table<R>;
  static const EnumText kinds({{0, "diamond"}, {1, "cutting"}});
  static const EnumText shapes(
      {{0, "ball"}, {1, "cylinder"}, {2, "cone"}, {3, "pear"}, {5, "blade"}});
  static const T table(
      {"burrs", "the burrs when they were new", 8, RowsOf::kSession, {"tool"}},
      {T::column("tool", &R::tool, "1", "as in /tool"),
       T::text("name", &R::name, kNameBytes, "in the definition"),
       T::code("kind", &R::kind, kinds, "0 diamond, 1 cutting"),
       T::code("shape", &R::shape, shapes, "0 ball, 1 cylinder, 2 cone, 3 pear, 5 a saw's blade"),
       T::column("diameter", &R::diameter, "m", "the greatest; the width of a saw's blade"),
       T::column("length", &R::length, "m", "along the axis"),
       T::column("narrow_diameter", &R::narrow_diameter, "m",
                 "of a cone's tip or a pear's neck; the kerf of a saw"),
       T::column("clockwise", &R::clockwise, "1",
                 "1: turns so, seen from the handle, unless it is reversed"),
       T::column("shaft_radius", &R::shaft_radius, "m",
                 "of the shaft that is felt; 0: it is not felt"),
       T::column("shaft_length", &R::shaft_length, "m", "likewise"),
       T::column("wear_volume", &R::wear_volume, "m3",
                 "of bone, after which it removes half as much; 0: never")});
  return table;
}

template <>
const Table<HandpieceRow>& table_of<HandpieceRow>() {
  using R = HandpieceRow;
  using T = Table<R>;
  using Names3 = std::array<const char*, 3>;
  static const T table(
      {"handpiece",
       "shafts, wear and reverse on each tick of the servo loop",
       4096,
       RowsOf::kEachTick,
       {"sequence"},
       // A table of its own: made anew beside other tables it would have no row for their ticks.
       "handpiece",
       5},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       T::column("reversed", &R::reversed, "1", "1 where burrs turn against their rotation"),
       T::column("sharpness", &R::sharpness, "1",
                 "what the tool in hand removes of what it removed when it was new"),
       T::rounded_elements(Names3{"shaft_x", "shaft_y", "shaft_z"}, &R::shaft, "N",
                           "force of bone on the burr's shaft before any limit, in the world frame",
                           kForceResolution),
       T::rounded_elements(Names3{"tube_shaft_x", "tube_shaft_y", "tube_shaft_z"}, &R::tube_shaft,
                           "N", "the same on the tube in the other hand behind its end",
                           kForceResolution)});
  return table;
}

}  // namespace haptrial::record
