#include "core/record/rows/object_rows.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kObjectNameBytes = 64;
constexpr std::size_t kObjectFileBytes = 256;

}  // namespace

template <>
const Table<ContactRow>& table_of<ContactRow>() {
  using R = ContactRow;
  using T = Table<R>;
  static const T table(
      {"contacts",
       "one tick of a tool on an object whose contact is recorded",
       3072,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "number of the tick, as in /samples"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::column("object", &R::object, "1", "of [objects] in the order of their names, from 0"),
       T::column("sliding", &R::sliding, "1", "1 where it slides, 0 where friction holds it"),
       T::rounded("depth", &R::depth, "m", "of the tool behind the surface"),
       T::rounded_elements<3>({"proxy_x", "proxy_y", "proxy_z"}, &R::proxy, "m",
                              "where the surface holds the tool's proxy, in W"),
       T::rounded_elements<3>({"force_x", "force_y", "force_z"}, &R::force, "N",
                              "of the object on the tool, in W"),
       T::column("work", &R::work, "J",
                 "done on the hand by the object since its stage began: above 0 it gave energy")});
  return table;
}

template <>
const Table<MovingBodyRow>& table_of<MovingBodyRow>() {
  using R = MovingBodyRow;
  using T = Table<R>;
  static const T table(
      {"moving_bodies", "how each body that moves did so, in ticks", 37, RowsOf::kPass, {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::text("object", &R::object, kObjectNameBytes, "of [objects]"),
       T::column("steps", &R::steps, "1", "of the body on a tick"),
       T::column("limited", &R::limited, "1",
                 "ticks on which the force was cut, as it might have given out more energy than "
                 "the hand had given"),
       T::column("flown_apart", &R::flown_apart, "1",
                 "ticks on which the body flew apart, as it was deformed beyond what its steps "
                 "are stable for, and was put to rest")});
  return table;
}

template <>
const Table<TouchedBodyRow>& table_of<TouchedBodyRow>() {
  using R = TouchedBodyRow;
  using T = Table<R>;
  static const T table(
      {"touched_bodies",
       "how the contact with each body that gives way went, in ticks",
       40,
       RowsOf::kPass,
       {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::text("object", &R::object, kObjectNameBytes, "of [objects]"),
       T::column("contact", &R::contact, "1", "ticks in contact"),
       T::column("inverted", &R::inverted, "1",
                 "ticks on which a tetrahedron would have been turned inside out: the force stayed "
                 "at what it was before"),
       T::column("unsettled", &R::unsettled, "1",
                 "ticks on which the places of contact were not found to rounding"),
       T::column("crowded", &R::crowded, "1",
                 "ticks with more places of contact than fit: the deepest were taken")});
  return table;
}

template <>
const Table<LateWindowRow>& table_of<LateWindowRow>() {
  using R = LateWindowRow;
  using T = Table<R>;
  static const T table(
      {"late_windows",
       "windows that bodies of their own rate did not end in time, the first 4,096 of each",
       40,
       RowsOf::kPass,
       {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::column("interval", &R::interval, "1", "of the trial, from 1"),
       T::text("object", &R::object, kObjectNameBytes, "of [objects]"),
       T::column("tick", &R::tick, "1",
                 "on which the window was taken, counted while the object acts in the interval, "
                 "from 0"),
       T::column("ticks", &R::ticks, "1", "that it was too late")});
  return table;
}

template <>
const Table<ObjectFileRow>& table_of<ObjectFileRow>() {
  using R = ObjectFileRow;
  using T = Table<R>;
  static const T table(
      {"object_files",
       "files of objects and sounds as they were when the session began: meshes, constants of "
       "springs, recordings",
       4,
       RowsOf::kSession,
       {"object"}},
      {T::column("object", &R::object, "1",
                 "of [objects] in the order of their names, from 0; -1 of a sound"),
       T::text("name", &R::name, kObjectNameBytes,
               "of the object, with .calibrated behind it for its constants; of a sound with "
               "sounds. before it"),
       T::text("file", &R::file, kObjectFileBytes, "as the definition names it"),
       T::column("bytes", &R::bytes, "byte", "size of the file"),
       T::column("checksum", &R::checksum, "1", "64-bit FNV-1a hash of the file's bytes")});
  return table;
}

}  // namespace haptrial::record
