#include "core/bone/nerve/nerve_rows.h"

namespace haptrial::record {
namespace {

constexpr const char* kGroup = "nerve_monitor";
constexpr std::int64_t kSince = 5;
constexpr std::size_t kKind = 16;  // bytes of a word

EnumText kinds() {
  using Kind = NerveEventRow::Kind;
  return EnumText({{static_cast<std::uint8_t>(Kind::kBurst), "burst"},
                   {static_cast<std::uint8_t>(Kind::kTrain), "train"},
                   {static_cast<std::uint8_t>(Kind::kResponse), "response"},
                   {static_cast<std::uint8_t>(Kind::kArtefact), "artefact"}});
}

EnumText causes() {
  using Cause = NerveThresholdRow::Cause;
  return EnumText({{static_cast<std::uint8_t>(Cause::kStart), "start"},
                   {static_cast<std::uint8_t>(Cause::kMonitor), "monitor"},
                   {static_cast<std::uint8_t>(Cause::kTechnician), "technician"}});
}

EnumText stimulus_kinds() {
  using Kind = NerveStimulusRow::Kind;
  return EnumText({{static_cast<std::uint8_t>(Kind::kSet), "set"},
                   {static_cast<std::uint8_t>(Kind::kPulse), "pulse"},
                   {static_cast<std::uint8_t>(Kind::kSearch), "search"},
                   {static_cast<std::uint8_t>(Kind::kFound), "found"},
                   {static_cast<std::uint8_t>(Kind::kOutOfRange), "out_of_range"}});
}

template <class Row>
void join(std::vector<Row>& to, const std::vector<Row>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

template <>
const Table<NerveChannelRow>& table_of<NerveChannelRow>() {
  using R = NerveChannelRow;
  using T = Table<R>;
  static const T table({"nerve_channels",
                        "the channels of the nerve monitor",
                        8,
                        RowsOf::kSession,
                        {"channel"},
                        kGroup,
                        kSince},
                       {T::column("channel", &R::channel, "1",
                                  "from 0; its samples are channel_0 to channel_7 of "
                                  "/nerve_emg"),
                        T::text("name", &R::name, kNameBytes, "of the muscle"),
                        T::text("nerve", &R::nerve, kNameBytes,
                                "a structure of the bone, or a curve of the definition"),
                        T::column("rate", &R::rate, "Hz", "of its samples")});
  return table;
}

template <>
const Table<EmgRow>& table_of<EmgRow>() {
  using R = EmgRow;
  using T = Table<R>;
  static const T table(
      {"nerve_emg",
       "simulated electromyograms at their full rate, a row for each sample",
       24000,
       RowsOf::kTick,
       {"sequence", "sample"},
       kGroup,
       kSince,
       true},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       T::column("sample", &R::sample, "1", "of the tick, from 0"),
       T::rounded_elements(
           std::array<const char*, kEmgChannels>{"channel_0", "channel_1", "channel_2", "channel_3",
                                                 "channel_4", "channel_5", "channel_6",
                                                 "channel_7"},
           &R::channels, "V", "simulated; 0 where there is no such channel", kEmgResolution)});
  return table;
}

template <>
const Table<NerveEventRow>& table_of<NerveEventRow>() {
  using R = NerveEventRow;
  using T = Table<R>;
  static const T table(
      {"nerve_events",
       "what the nerve monitor took for events, one row each",
       128,
       RowsOf::kTick,
       {"sequence", "channel"},
       kGroup,
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick at which the monitor closed the event"),
       T::column("channel", &R::channel, "1", "of /nerve_channels"),
       T::word("kind", &R::kind, kKind, kinds(), "burst, train, response or artefact"),
       T::column("begin", &R::begin, "1", "tick of the first sample beyond the threshold"),
       T::column("end", &R::end, "1", "tick of the last one"),
       T::rounded("peak", &R::peak, "V", "largest magnitude"),
       T::rounded("threshold", &R::threshold, "V", "when the event ended"),
       T::rounded("train_time", &R::train_time, "s", "from first to last discharge of its trains"),
       T::column("heard", &R::heard, "1", "1 where the participant could hear the channel")});
  return table;
}

template <>
const Table<NerveThresholdRow>& table_of<NerveThresholdRow>() {
  using R = NerveThresholdRow;
  using T = Table<R>;
  static const T table(
      {"nerve_thresholds",
       "how the channels of the nerve monitor were set, a row for each change",
       96,
       RowsOf::kTick,
       {"sequence", "channel"},
       kGroup,
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick from which on it was so"),
       T::column("channel", &R::channel, "1", "of /nerve_channels"),
       T::rounded("threshold", &R::threshold, "V", "of an event"),
       T::column("muted", &R::muted, "1", "1 where the channel is silent"),
       T::word("cause", &R::cause, kKind, causes(), "start, monitor or technician")});
  return table;
}

template <>
const Table<NerveDischargeRow>& table_of<NerveDischargeRow>() {
  using R = NerveDischargeRow;
  using T = Table<R>;
  static const T table(
      {"nerve_discharges",
       "what was put into the simulated electromyograms: the truth that events are held against",
       112,
       RowsOf::kTick,
       {"sequence", "channel"},
       kGroup,
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick on which the discharge began"),
       T::column("channel", &R::channel, "1", "of /nerve_channels; -1: all"),
       T::word("kind", &R::kind, kKind, kinds(), "burst, train, response or artefact"),
       T::column("end", &R::end, "1", "tick of its last sample"),
       T::rounded("amplitude", &R::amplitude, "V", "peak"),
       T::rounded("distance", &R::distance, "m", "of the tool's surface from the nerve; 1: far"),
       T::rounded("warmth", &R::warmth, "K", "of the nerve, above the body's"),
       T::rounded("current", &R::current, "A", "of the pulse that it answers to; 0: none")});
  return table;
}

template <>
const Table<NerveStimulusRow>& table_of<NerveStimulusRow>() {
  using R = NerveStimulusRow;
  using T = Table<R>;
  static const T table(
      {"nerve_stimuli",
       "how the probe's current was set or searched, and its pulses, a row each",
       104,
       RowsOf::kTick,
       {"sequence"},
       "nerve_probe",
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       T::word("kind", &R::kind, kKind, stimulus_kinds(),
               "set, pulse, search, found or out_of_range"),
       T::column("channel", &R::channel, "1",
                 "of /nerve_channels, whose threshold is searched; -1: none"),
       T::rounded("current", &R::current, "A", "set, of the pulse, or found within 5 %")});
  return table;
}

const TableList& nerve_tables() {
  static const TableList tables{&table_of<NerveChannelRow>(),   &table_of<EmgRow>(),
                                &table_of<NerveEventRow>(),     &table_of<NerveThresholdRow>(),
                                &table_of<NerveDischargeRow>(), &table_of<NerveStimulusRow>()};
  return tables;
}

void NerveRows::append(const NerveRows& more) {
  join(emg, more.emg);
  join(events, more.events);
  join(thresholds, more.thresholds);
  join(discharges, more.discharges);
  join(stimuli, more.stimuli);
}

void NerveRows::clear() {
  emg.clear();
  events.clear();
  thresholds.clear();
  discharges.clear();
  stimuli.clear();
}

}  // namespace haptrial::record
