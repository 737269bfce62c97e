#include "core/channel/channel_row.h"

namespace haptrial::channel {
namespace {

record::EnumText incidents() {
  std::vector<record::EnumText::Entry> entries;
  for (int i = 0; i <= static_cast<int>(Incident::kClockOffset); ++i) {
    const auto what = static_cast<Incident>(i);
    entries.push_back({static_cast<std::uint8_t>(what), name_of(what)});
  }
  return record::EnumText(std::move(entries));
}

}  // namespace

const char* name_of(Incident what) noexcept {
  switch (what) {
    case Incident::kOpened:
      return "opened";
    case Incident::kLost:
      return "lost";
    case Incident::kBack:
      return "back";
    case Incident::kGap:
      return "gap";
    case Incident::kRepeated:
      return "repeated";
    case Incident::kMalformed:
      return "malformed";
    case Incident::kClockStep:
      return "clock_step";
    case Incident::kStatus:
      return "status";
    case Incident::kDropped:
      return "dropped";
    case Incident::kMessage:
      return "message";
    case Incident::kClockOffset:
      return "clock_offset";
  }
  return "";
}

ChannelTable::ChannelTable(const std::string& channel, const std::vector<Quantity>& quantities,
                           std::size_t chunk_rows) {
  using R = ChannelRow;
  using T = record::Table<R>;
  const auto kept = [this](std::string text) {
    texts_.push_back(std::make_unique<const std::string>(std::move(text)));
    return texts_.back()->c_str();
  };
  T::Columns columns;
  const auto add = [&](T::Columns more) {
    columns.insert(columns.end(), more.begin(), more.end());
  };
  add(T::column("sample", &R::sample, "1",
                "number of the sample from 0; what the instrument says it lost is left out"));
  add(T::column("time_ns", &R::time_ns, "ns",
                "when it was measured, since the first tick of the session"));
  add(T::column("received_ns", &R::received_ns, "ns", "when it had come, on the same clock"));
  add(T::column("uncertainty", &R::uncertainty, "s",
                "the time is within this of the truth in 95 % of samples"));
  add(T::column("device_time", &R::device_time, "s",
                "by the instrument's own clock; NaN: it has none"));
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    add(T::column(
        kept(quantities[i].name), [i](R & row) -> auto& { return row.values[i]; },
        kept(quantities[i].unit), "measured; NaN: not in this sample"));
  }
  table_ = std::make_unique<const T>(
      record::TableHead{kept("channel_" + channel),
                        kept("one row for each sample of the channel " + channel),
                        chunk_rows,
                        record::RowsOf::kSession,
                        {"sample"}},
      std::initializer_list<T::Columns>{columns});
}

}  // namespace haptrial::channel

namespace haptrial::record {

template <>
const Table<channel::IncidentRow>& table_of<channel::IncidentRow>() {
  using R = channel::IncidentRow;
  using T = Table<R>;
  static const T table(
      {"channel_events", "what befell the channels", 72, RowsOf::kSession, {"time_ns"}, "", 5},
      {T::column("time_ns", &R::time_ns, "ns", "since the first tick of the session"),
       T::text("channel", &R::channel, kNameBytes, "its name in [channels]"),
       T::word("what", &R::what, kStatusBytes, channel::incidents(), "what happened, in one word"),
       T::column("amount", &R::amount, "1", "how much of it, as docs/channels.md says"),
       T::text("text", &R::text, kTextBytes, "details")});
  return table;
}

}  // namespace haptrial::record
