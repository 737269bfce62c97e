#include "core/record/rows/partner_rows.h"

#include "core/record/table/schema.h"

namespace haptrial::record {

template <>
const Table<LinkRow>& table_of<LinkRow>() {
  using R = LinkRow;
  using T = Table<R>;
  static const T table(
      {"link", "one tick of a link to a partner", 3072, RowsOf::kTick, {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "number of the tick, as in /samples"),
       T::column("sent", &R::sent, "1", "number of the message that left; 0: none"),
       T::column("heard", &R::heard, "1",
                 "number of the partner's message that the tick goes by: `sent` in the partner's "
                 "file; 0: none yet"),
       T::column("arrived", &R::arrived, "1", "messages that came since the tick before"),
       T::column("lost", &R::lost, "1", "messages of the partner so far that never came"),
       T::column("state", &R::state, "1",
                 "sum of 1 linked, 2 coupled, 4 partner stopped, 8 partner's device at fault, 16 "
                 "partner took the lead"),
       T::rounded("lead", &R::lead, "1", "own authority over the own tool, 0 to 1"),
       T::rounded("delay", &R::delay, "s", "from the partner's tick to this one"),
       T::rounded("round_trip", &R::round_trip, "s", "of the last answer; -1: none yet"),
       T::column("clock_offset", &R::clock_offset, "s", "partner's clock less the own"),
       T::rounded("clock_drift", &R::clock_drift, "1", "how much faster the partner's clock runs"),
       T::rounded_elements<3>({"position_x", "position_y", "position_z"}, &R::position, "m",
                              "of the partner's tool, in W"),
       T::rounded_elements<3>({"velocity_x", "velocity_y", "velocity_z"}, &R::velocity, "m/s",
                              "of the partner's tool, in W"),
       T::rounded_elements<3>({"force_x", "force_y", "force_z"}, &R::force, "N",
                              "of the partner's world on the partner's tool, in W"),
       T::rounded_elements<3>(
           {"coupling_x", "coupling_y", "coupling_z"}, &R::coupling, "N",
           "of the partner's world, spring and damper on the own tool, before the envelope, in W"),
       T::rounded("energy", &R::energy, "J", "that may still be given to the hand"),
       T::column("energy_given", &R::energy_given, "J",
                 "by spring and damper to the hand so far, less what the hand gave"),
       T::column("energy_sent", &R::energy_sent, "J", "to the partner so far"),
       T::column("energy_received", &R::energy_received, "J", "from the partner so far")});
  return table;
}

template <>
const Table<NetworkRow>& table_of<NetworkRow>() {
  using R = NetworkRow;
  using T = Table<R>;
  static const T table({"networks",
                        "the simulated network that a pass went over, each way",
                        24,
                        RowsOf::kSession,
                        {"pass"}},
                       {T::column("pass", &R::pass, "1", "row of /trials"),
                        T::text("name", &R::name, kConditionBytes, "as the definition calls it"),
                        T::column("delay", &R::delay, "s", "least"),
                        T::column("jitter", &R::jitter, "s", "mean of what comes on top"),
                        T::column("loss", &R::loss, "1", "share of messages"),
                        T::column("duplication", &R::duplication, "1", "likewise"),
                        T::column("reordering", &R::reordering, "1", "likewise"),
                        T::column("bandwidth", &R::bandwidth, "1", "bytes a second; 0: no limit")});
  return table;
}

template <>
const Table<TutoringRow>& table_of<TutoringRow>() {
  using R = TutoringRow;
  using T = Table<R>;
  static const T table(
      {"tutoring",
       "one tick during which a tutor leads the tool",
       3584,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "number of the tick, as in /samples"),
       T::column("time", &R::time, "s", "in what the tutor did, from the beginning of the run"),
       T::column("lead", &R::lead, "1", "the tutor's authority, 0 to 1"),
       T::rounded_elements<3>({"position_x", "position_y", "position_z"}, &R::position, "m",
                              "of the tutor's tool, in W"),
       T::rounded_elements<3>({"tutor_force_x", "tutor_force_y", "tutor_force_z"}, &R::tutor_force,
                              "N", "that was on the tutor's tool, in W"),
       T::rounded_elements<3>({"played_force_x", "played_force_y", "played_force_z"},
                              &R::played_force, "N",
                              "of the tutor on the tool, before the envelope, in W")});
  return table;
}

}  // namespace haptrial::record
