#include "core/bone/record/tool_rows.h"

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

template <>
const Table<SecondHandRow>& table_of<SecondHandRow>() {
  using R = SecondHandRow;
  using T = Table<R>;
  static const T table(
      {"second_hand",
       "the tube in the other hand on each tick of the servo loop",
       4096,
       RowsOf::kEachTick,
       {"sequence"},
       // The table has a group of its own: made anew beside other tables it would have no row for
       // their ticks.
       "second_hand",
       5},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       turn_columns(&R::orientation, "unit quaternion from the handle's frame to the world"),
       T::column("sucks", &R::sucks, "1", "1 where it sucks"),
       T::column("rinses", &R::rinses, "1", "1 where water runs"),
       T::column("immersed", &R::immersed, "1", "samples of its end in bone"),
       T::rounded_elements(std::array<const char*, 3>{"contact_x", "contact_y", "contact_z"},
                           &R::contact, "N",
                           "force of bone and soft tissue before any limit, in the world frame",
                           kForceResolution)});
  return table;
}

template <>
const Table<ToolContactRow>& table_of<ToolContactRow>() {
  using R = ToolContactRow;
  using T = Table<R>;
  static const T table(
      {"tool_contact",
       "the push of the two hands' tools on each tick of the servo loop",
       4096,
       RowsOf::kEachTick,
       {"sequence"},
       "tool_contact",
       5},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       T::rounded_elements(std::array<const char*, 3>{"force_x", "force_y", "force_z"}, &R::force,
                           "N",
                           "force of the tube on the first hand's tool before any limit of the "
                           "device, in the world frame; its opposite acts on the tube",
                           kForceResolution)});
  return table;
}

template <>
const Table<LedRow>& table_of<LedRow>() {
  using R = LedRow;
  using T = Table<R>;
  using Names3 = std::array<const char*, 3>;
  static const T table(
      {"led",
       "one row for each tick of the side that teaches which the bone has followed",
       1000,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "own tick on which it was followed"),
       T::column("step", &R::step, "1", "of the bone, from 1 when it was new"),
       T::column("begins", &R::begins, "1", "1: the first one of a pass there"),
       T::rounded_elements(
           Names3{"x", "y", "z"}, [](R& r) -> Eigen::Vector3d& { return r.tool.position; }, "m",
           "of the tool there, in the world frame", kPositionResolution),
       T::rounded_elements(
           Names3{"vx", "vy", "vz"}, [](R& r) -> Eigen::Vector3d& { return r.tool.velocity; },
           "m/s", "of the tool there, in the world frame", kVelocityResolution),
       turn_columns(&R::orientation, "unit quaternion from the handle's frame there to the world"),
       T::column("buttons", &R::buttons, "1", "of the device there"),
       T::column("keys", &R::keys, "1", "of the window there"),
       T::rounded("pedal", &R::pedal, "1", "there", kPedalResolution)});
  return table;
}

template <>
const Table<TuningRow>& table_of<TuningRow>() {
  using R = TuningRow;
  using T = Table<R>;
  static const T table(
      {"tuning", "one row for each key that was tuned in a pilot", 16, RowsOf::kTick, {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "first tick with the new value"),
       T::text("key", &R::key, 96, "of the definition, by its path"),
       T::column("before", &R::before, "1", "value before, in the unit of the key"),
       T::column("after", &R::after, "1", "new value, likewise")});
  return table;
}

}  // namespace haptrial::record
