#include "core/record/rows/marker_row.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kMarkerWordBytes = 16;

template <class E>
EnumText::Entry named(E value) {
  return {static_cast<std::uint8_t>(value), name_of(value)};
}

}  // namespace

const char* name_of(MarkerOf what) noexcept {
  switch (what) {
    case MarkerOf::kTrial:
      return "trial";
    case MarkerOf::kInterval:
      return "interval";
    case MarkerOf::kStage:
      return "stage";
    case MarkerOf::kResponse:
      return "response";
  }
  return "";
}

const char* name_of(MarkerOutput way) noexcept {
  switch (way) {
    case MarkerOutput::kNone:
      return "none";
    case MarkerOutput::kSerial:
      return "serial";
    case MarkerOutput::kStream:
      return "stream";
    case MarkerOutput::kScreen:
      return "screen";
    case MarkerOutput::kSound:
      return "sound";
    case MarkerOutput::kNeon:
      return "neon";
  }
  return "";
}

template <>
const Table<MarkerRow>& table_of<MarkerRow>() {
  using R = MarkerRow;
  using T = Table<R>;
  static const T table(
      {"markers",
       "one row for each onset and each way that it went",
       80,
       RowsOf::kPass,
       {"pass", "sequence"},
       "markers",
       5},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("trial", &R::trial, "1", "trial number, as in /trials"),
       T::column("interval", &R::interval, "1", "of the pass, from 1; 0: none"),
       T::word("what", &R::what, kMarkerWordBytes,
               EnumText({named(MarkerOf::kTrial), named(MarkerOf::kInterval),
                         named(MarkerOf::kStage), named(MarkerOf::kResponse)}),
               "what begins: trial, interval, stage or response"),
       T::text("name", &R::name, kMarkerNameBytes, "of the interval, stage or answer"),
       T::column("code", &R::code, "1", "its code, 1 to 255"),
       T::column("sequence", &R::sequence, "1", "tick of the onset, as in /samples"),
       T::column("time_ns", &R::time_ns, "ns", "of that tick, since the first tick of the session"),
       T::word("way", &R::way, kMarkerWordBytes,
               EnumText({named(MarkerOutput::kNone), named(MarkerOutput::kSerial),
                         named(MarkerOutput::kStream), named(MarkerOutput::kScreen),
                         named(MarkerOutput::kSound), named(MarkerOutput::kNeon)}),
               "where it went: serial, stream, screen, sound, neon or none"),
       T::column("written", &R::written, "s",
                 "when it had gone there, since the first tick of the session; NaN: it did not"),
       T::column("latency", &R::latency, "s", "from the tick to then; NaN: it did not go"),
       T::column("frame", &R::frame, "1",
                 "of the screen: number of the frame in this run, from 0; else -1")});
  return table;
}

}  // namespace haptrial::record
