#include "core/record/rows/trial_facts.h"

namespace haptrial::record {

template <>
const Table<SkippedRow>& table_of<SkippedRow>() {
  using R = SkippedRow;
  using T = Table<R>;
  static const T table(
      {"skipped",
       "one row for each trial that the experimenter skipped for good",
       64,
       RowsOf::kSession,
       {"time_ns"},
       "skipped",
       5},
      {T::column("time_ns", &R::time_ns, "ns", "since the first tick of the session"),
       T::column("trial", &R::trial, "1", "trial number, as in /trials"),
       T::column("practice", &R::practice, "1", "1 where the trial is not part of the study")});
  return table;
}

template <>
const Table<DampingRow>& table_of<DampingRow>() {
  using R = DampingRow;
  using T = Table<R>;
  static const T table(
      {"damping",
       "one row for each pass during whose run the hand did not carry all the damping",
       56,
       RowsOf::kSession,
       {"time_ns"},
       "damping",
       5},
      {T::column("time_ns", &R::time_ns, "ns",
                 "since the first tick of the session; after the pass, before the next one"),
       T::column("trial", &R::trial, "1", "trial number, as in /trials"),
       T::column("least", &R::least, "1", "smallest share of the definition's damping"),
       T::column("seconds", &R::seconds, "s", "of the run, for which it was reduced")});
  return table;
}

template <>
const Table<TakenBackRow>& table_of<TakenBackRow>() {
  using R = TakenBackRow;
  using T = Table<R>;
  static const T table(
      {"taken_back",
       "one row for each pass whose answers the experimenter took back: it counts as aborted",
       72,
       RowsOf::kEndedPass,
       {"time_ns", "pass"},
       "taken_back",
       5},
      {T::column("time_ns", &R::time_ns, "ns", "since the first tick of the session"),
       T::column("trial", &R::trial, "1", "trial number, as in /trials"),
       T::column("pass", &R::pass, "1", "row of /trials")});
  return table;
}

}  // namespace haptrial::record
