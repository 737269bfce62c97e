#include "analysis/exchange/bids_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/exchange/pass_facts.h"
#include "analysis/files/delimited.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"

namespace haptrial::exchange {

std::string bids_label(std::string_view text) {
  std::string label;
  for (const char c : text) {
    if ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z')) {
      label += c;
    }
  }
  return label;
}

}  // namespace haptrial::exchange

namespace haptrial::exchange::bids {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) {
  // Bytes that are not UTF-8 came from a file: shown as the replacement character.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json json_of(const ColumnDoc& doc) {
  Json json;
  json["Description"] = doc.description;
  if (!doc.unit.empty()) {
    json["Units"] = doc.unit;
  }
  for (const auto& [value, meaning] : doc.levels) {
    json["Levels"][value] = meaning;
  }
  return json;
}

bool any_stimuli(std::span<const Session> sessions) {
  return std::any_of(sessions.begin(), sessions.end(),
                     [](const auto& s) { return s.source.stimuli; });
}

constexpr const char* kPilotNotice = "PILOT SESSION: no part of the study.";

std::string participant_pilots(std::span<const Session> sessions, const Session& participant) {
  std::size_t all = 0;
  std::size_t pilots = 0;
  for (const Session& session : sessions) {
    if (session.subject == participant.subject) {
      ++all;
      pilots += session.source.info.pilot ? 1 : 0;
    }
  }
  return pilots == 0 ? "false" : pilots == all ? "true" : "some";
}

// ---- participants

/// The column's name in BIDS where all values are among those that BIDS allows there, else one of
/// our own: the study's form decides what people can answer.
std::string person_column(std::span<const Session> sessions, const char* name,
                          std::string record::Participant::*field,
                          const std::set<std::string>& allowed) {
  const bool all = std::all_of(sessions.begin(), sessions.end(), [&](const Session& s) {
    const std::string& value = s.source.info.participant.*field;
    return value.empty() || allowed.contains(value);
  });
  return all ? name : std::string("reported_") + name;
}

const std::set<std::string> kSexes{"male",   "m", "M", "MALE",   "Male",
                                   "female", "f", "F", "FEMALE", "Female",
                                   "other",  "o", "O", "OTHER",  "Other"};
/// BIDS has another word for people who use both hands.
std::string bids_hand(const std::string& handedness) {
  return handedness == "both" ? "ambidextrous" : handedness;
}

const std::set<std::string> kHands{
    "both",  "left",         "l", "L", "LEFT",         "Left",        "right", "r", "R", "RIGHT",
    "Right", "ambidextrous", "a", "A", "AMBIDEXTROUS", "Ambidextrous"};

std::vector<ColumnDoc> participant_docs(std::span<const Session> sessions) {
  return {{"participant_id", "", "the subject's label in this data set"},
          {"subject", "", "the subject's identifier in the session files"},
          {person_column(sessions, "sex", &record::Participant::sex, kSexes), "",
           "as the participant gave it"},
          {person_column(sessions, "handedness", &record::Participant::handedness, kHands), "",
           "as the participant gave it"},
          {"age_band", "", "range of ages in years, as the participant gave it"},
          {"simulated",
           "",
           "whether the participant is a virtual subject",
           {{"true", "SIMULATED: a virtual subject"}, {"false", "a person"}}},
          {"pilot",
           "",
           "whether the participant's sessions are pilots; the recordings say which",
           {{"true", "all are pilots, no part of the study"},
            {"some", "some are pilots"},
            {"false", "none is a pilot"}}}};
}

// ---- events

std::vector<ColumnDoc> event_docs(const Levels& phases, const std::vector<ColumnDoc>& facts) {
  const auto pass = [](const char* name) { return doc_of(record::trials_table().schema(), name); };
  std::vector<ColumnDoc> docs{
      {"onset", "s",
       "of the pass or event since the first tick of the session: tick number / rate"},
      {"duration", "s", "of the whole pass with approach, wait and return; 0 for an event"},
      {"trial_type", "", "training condition of the block; n/a for an event"},
      {"stim_file", "",
       "the ideal movement and force of the block, below stimuli/: block, time [s] since the run "
       "began, position_x, position_y, position_z [m], force [N]"},
      {"pass", "", "number of the pass from 0, as in the recording"},
      phase_doc(phases),
      pass("trial"),
      pass("block"),
      pass("repetition"),
      pass("attempt"),
      pass("practice"),
      pass("status"),
      pass("stimulus_seed"),
      {"run_onset", "s", "when the run began"},
      {"run_duration", "s", "how long it ran"},
      {"event", "", "what happened, in one word; n/a for a pass"},
      {"text", "", "details of the event"}};
  docs[10].levels = {{"0", "part of the study"}, {"1", "practice, never scored"}};
  docs[11].levels = status_levels();
  merge_columns(facts, docs);
  return docs;
}

struct EventLine {
  double onset{0.0};
  std::string text;
};

EventLine line_of(const Session& session, const record::PassRow& pass, std::size_t index,
                  const char* status, const RunSpan& run, bool stimulus) {
  const double rate = session.source.info.rate;
  const auto seconds = [&](std::uint64_t ticks) { return static_cast<double>(ticks) / rate; };
  EventLine line;
  line.onset = seconds(pass.first_sample);
  RowText row(line.text, Delimited::kTsv);
  const bool any = pass.last_sample >= pass.first_sample;
  row.add(line.onset).add(any ? seconds(pass.last_sample - pass.first_sample + 1) : 0.0);
  row.add(pass.condition).add(stimulus ? session.stimulus(pass.block) : "");
  row.add(static_cast<std::uint64_t>(index));
  row.add(record::name_of(pass.phase));
  row.add(pass.trial).add(pass.block).add(pass.repetition).add(pass.attempt);
  row.add(pass.practice ? 1 : 0);
  row.add(status);
  row.add(pass.stimulus_seed);
  if (run.ticks > 0) {
    row.add(seconds(run.first)).add(seconds(run.ticks));
  } else {
    row.add_missing().add_missing();
  }
  row.add_missing().add_missing();
  return line;
}

EventLine line_of(const record::EventRow& event, std::int64_t time_ns) {
  EventLine line;
  line.onset = 1e-9 * static_cast<double>(time_ns);
  RowText row(line.text, Delimited::kTsv);
  row.add_seconds(time_ns).add(0);
  for (std::size_t i = 0; i < 13; ++i) {
    row.add_missing();
  }
  row.add(event.kind).add(event.text);
  return line;
}

/// Ends a line with what the pass presented and what was answered.
void add_facts(const std::map<std::string, std::string>& cells,
               const std::vector<ColumnDoc>& columns, EventLine& line) {
  for (const ColumnDoc& column : columns) {
    std::string cell;
    RowText field(cell, Delimited::kTsv);
    const auto at = cells.find(column.name);
    field.add(at != cells.end() ? at->second : std::string());
    line.text += "\t" + cell;
  }
  line.text += "\n";
}

}  // namespace

bool any_simulated(std::span<const Session> sessions) {
  return std::any_of(sessions.begin(), sessions.end(),
                     [](const auto& s) { return s.source.info.simulated; });
}

std::string sidecar_of(const std::vector<ColumnDoc>& docs) {
  Json json;
  for (const auto& doc : docs) {
    json[doc.name] = json_of(doc);
  }
  return text_of(json);
}

std::string Session::folder() const { return session.empty() ? subject : subject + "/" + session; }

std::string Session::stem() const {
  return subject + (session.empty() ? "" : "_" + session) + "_task-" + task;
}

std::string Session::stimulus(std::int32_t block) const {
  return fmt::format("{}{}_{}-{:02}.tsv.gz", subject, session.empty() ? "" : "_" + session,
                     block < 0 ? "practice" : "block", std::abs(block));
}

std::string dataset_description(std::span<const Session> sessions, const DataSetOptions& options) {
  const bool simulated = any_simulated(sessions);
  const std::string name =
      options.name.empty() ? experiment_name(sessions.front().source.info) : options.name;
  Json json;
  json["Name"] = (simulated ? "SIMULATED: " : "") + name;
  json["BIDSVersion"] = "1.11.0";
  json["DatasetType"] = "raw";
  if (!options.authors.empty()) {
    json["Authors"] = options.authors;
  }
  json["GeneratedBy"] = {{{"Name", "haptrial"},
                          {"Version", options.program_version},
                          {"Description", "haptrial export --bids"}}};
  json["Simulated"] = simulated;
  return text_of(json);
}

static bool any_mirrored(std::span<const Session> sessions) {
  return std::ranges::any_of(sessions, [](const Session& each) { return each.source.mirrored; });
}

std::string readme(std::span<const Session> sessions, double motion) {
  std::string text;
  if (any_simulated(sessions)) {
    text = std::string(kSimulatedNotice) + "\n\n";
  }
  const bool targets = any_stimuli(sessions);
  const char* passes = "passes (a trial has one of each phase, more if it was interrupted)";
  const char* stimuli =
      targets ? "stimuli/           the ideal movement and target force of each block\n" : "";
  const std::string moved =
      motion > 0.0 ? fmt::format(
                         "motion/            the movement of every device's tip, {} of its samples "
                         "a second\n"
                         "                   (picked, not filtered), and the events again\n",
                         motion)
                   : "";
  const char* force = targets ? "\nThe learnt force points down and is given as a magnitude." : "";
  text += fmt::format(
      "{}: a force-feedback experiment, exported from session files of haptrial.\n\n"
      "beh/*_events.tsv   {}\n"
      "                   and what else happened\n"
      "                   (what was presented and answered in further columns)\n"
      "phenotype/         answers to questionnaires, where there are any\n"
      "beh/*_physio.*     the recording: a row for each tick of the servo loop, without heading;\n"
      "                   columns, units and rate stand in the .json beside it\n"
      "{}{}"
      "code/              the definition of the experiment\n\n"
      "Row k of a recording is tick k after the one of StartTime, also where the session file\n"
      "lacks the tick (a row of n/a), so an onset in the events is exact; the column time is what\n"
      "the clock read. A recording of a channel begins with the onset of each sample on the time\n"
      "base of the events; its time_ns is the clock's. World frame: origin at the centre of the\n"
      "device's workspace, x to the participant's right, y up, z towards the participant.{}{}\n"
      "Reals have 32 bits, as in the session files. Left out on purpose: consent and free notes\n"
      "about participants.\n"
      "Practice passes have practice = 1 in the events, and negative numbers of blocks. "
      "Recordings\n"
      "of pilot sessions have Pilot = true in the .json beside them.\n",
      experiment_name(sessions.front().source.info), passes, stimuli, moved,
      any_mirrored(sessions) ? "\nIn sessions with the event \"mirrored\", those of left-handed "
                               "participants, x runs to the\nparticipant's left."
                             : "",
      force);
  return text;
}

std::string participants_table(std::span<const Session> sessions) {
  std::string text = heading(participant_docs(sessions), Delimited::kTsv);
  RowText row(text, Delimited::kTsv);
  for (const Session& session : sessions) {
    const ExportSession& source = session.source;
    if (source.first) {
      const auto& person = source.info.participant;
      row.add(session.subject).add(source.info.subject).add(person.sex);
      row.add(bids_hand(person.handedness));
      row.add(person.age_band).add(truth(source.info.simulated));
      row.add(participant_pilots(sessions, session)).end();
    }
  }
  return text;
}

std::string participants_sidecar(std::span<const Session> sessions) {
  return sidecar_of(participant_docs(sessions));
}

std::string sessions_table(std::span<const Session> of_subject) {
  std::string text = "session_id\tacq_time\n";
  RowText row(text, Delimited::kTsv);
  for (const auto& session : of_subject) {
    row.add(session.session).add(session.source.info.start_utc).end();
  }
  return text;
}

std::string scans_table(const Session& session, const std::string& motion) {
  std::string text = "filename\tacq_time\n";
  RowText row(text, Delimited::kTsv);
  row.add("beh/" + session.stem() + "_physio.tsv.gz").add(session.source.info.start_utc).end();
  if (!motion.empty()) {
    row.add(motion).add(session.source.info.start_utc).end();
  }
  return text;
}

std::string events_table(const Session& session, const record::SessionReader& reader,
                         const WrittenSamples& samples, const std::vector<ColumnDoc>& columns) {
  std::set<std::int32_t> blocks;
  for (const auto& row : reader.stimuli()) {
    blocks.insert(row.block);
  }
  std::vector<EventLine> lines;
  const auto passes = reader.passes();
  const std::vector<const char*> statuses = pass_statuses(reader);
  const PassFacts facts = pass_facts(reader);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    lines.push_back(line_of(session, passes[i], i, statuses[i], samples.runs.at(i),
                            blocks.contains(passes[i].block)));
    add_facts(facts.cells[i], columns, lines.back());
  }
  std::vector<record::EventRow> events = reader.events();
  const std::vector<record::EventRow> more = channel_events(reader, true);
  events.insert(events.end(), more.begin(), more.end());
  for (const auto& event : events) {
    lines.push_back(line_of(event, samples.even_time(event.time_ns)));
    add_facts({}, columns, lines.back());
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const auto& a, const auto& b) { return a.onset < b.onset; });
  std::string text = heading(event_docs({}, columns), Delimited::kTsv);
  for (const auto& line : lines) {
    text += line.text;
  }
  return text;
}

std::string events_sidecar(const DataSetOptions& options, const std::vector<ColumnDoc>& columns) {
  return sidecar_of(event_docs(options.phases, columns));
}

namespace {

/// Every recording of a session describes its task in these words.
Json task_json(const Session& session) {
  const auto& info = session.source.info;
  Json json;
  const std::string name = experiment_name(info);
  json["TaskName"] = bids_label(name) == session.task ? name : session.task;
  const std::string marks =
      fmt::format("{}{}{}", info.simulated ? kSimulatedNotice : "",
                  info.simulated && info.pilot ? " " : "", info.pilot ? kPilotNotice : "");
  if (!marks.empty()) {
    json["TaskDescription"] = marks;
  }
  return json;
}

}  // namespace

std::string described_task(const Session& session) { return text_of(task_json(session)); }

std::string recording_sidecar(const Session& session, const WrittenSamples& samples) {
  const auto& info = session.source.info;
  Json json = task_json(session);
  json["SamplingFrequency"] = info.rate;
  json["StartTime"] = static_cast<double>(samples.first_sequence) / info.rate;
  json["Columns"] = Json::array();
  const std::vector<ColumnDoc> columns = sample_docs(samples.other_devices);
  for (std::size_t i = 1; i < columns.size(); ++i) {
    json["Columns"].push_back(columns[i].name);
  }
  json["ManufacturersModelName"] = info.device;
  json["SoftwareVersions"] =
      fmt::format("haptrial {} ({})", info.program_version, info.program_commit);
  json["Simulated"] = info.simulated;
  json["Pilot"] = info.pilot;
  json["Clock"] = info.clock;
  json["Seed"] = std::to_string(info.seed);  // 64 bits are more than a double holds
  json["DeviceMaxForce"] = info.device_max_force;
  json["DeviceWorkspaceRadius"] = info.device_workspace_radius;
  json["MissingTicks"] = samples.missing;
  for (std::size_t i = 1; i < columns.size(); ++i) {
    json[columns[i].name] = json_of(columns[i]);
  }
  return text_of(json);
}

std::string channel_sidecar(const Session& session, const record::TableDescription& table,
                            const analysis::ChannelQuality& channel,
                            const WrittenSamples& samples) {
  Json json = task_json(session);
  json["SamplingFrequency"] = channel.rate();
  json["StartTime"] =
      1e-9 * static_cast<double>(samples.even_time(std::llround(1e9 * channel.first)));
  json["Simulated"] = session.source.info.simulated;
  json["Columns"] = Json::array();
  std::vector<ColumnDoc> columns{{"onset", "s", "of the sample, on the time base of the events"}};
  const std::vector<ColumnDoc> own = exchange::docs_of(table);
  columns.insert(columns.end(), own.begin(), own.end());
  for (const ColumnDoc& doc : columns) {
    json["Columns"].push_back(doc.name);
    json[doc.name] = json_of(doc);
  }
  json["Missing"] = channel.missing;
  json["TimeUncertainty"] = channel.uncertainty;
  return text_of(json);
}

}  // namespace haptrial::exchange::bids
