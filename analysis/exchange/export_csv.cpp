#include "analysis/exchange/export_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <variant>

#include "analysis/exchange/columns.h"
#include "analysis/exchange/other_devices.h"
#include "analysis/exchange/pass_facts.h"
#include "analysis/exchange/sample_text.h"
#include "analysis/files/delimited.h"
#include "analysis/files/gzip_file.h"
#include "analysis/files/new_folder.h"
#include "analysis/quality/channel_quality.h"
#include "analysis/quality/trial_quality.h"
#include "core/channel/channel_row.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;
using Docs = std::vector<ColumnDoc>;

const ColumnDoc kSubject{"subject", "", "identifier of the participant"};
const ColumnDoc kSession{"session", "", "number of the participant's session, from 1"};
const ColumnDoc kIsSimulated{
    "simulated", "", "whether the participant is a virtual subject", {{"true", "SIMULATED"}}};

const ColumnDoc kPilot{
    "pilot", "", "whether the session is no part of the study", {{"true", "a pilot"}}};

ColumnDoc pass_doc(const char* name) { return doc_of(record::trials_table().schema(), name); }

/// Column `practice` with the meaning of both values.
ColumnDoc practice_doc() {
  ColumnDoc doc = pass_doc("practice");
  doc.levels = {{"0", "part of the study"}, {"1", "practice, never scored"}};
  return doc;
}

Docs session_docs() {
  return {kSubject,
          kSession,
          {"file", "", "session file"},
          kIsSimulated,
          {"device", "", "name"},
          {"clock", "", "real or simulated"},
          {"rate", "Hz", "of the servo loop, so of the samples"},
          {"seed", "", "of the session; 64 bits: to be read as text where numbers are doubles"},
          {"start_utc", "", "ISO 8601"},
          {"definition", "", "file of the experiment's definition"},
          {"program_version", "", "what recorded the session"},
          {"samples", "", "rows of /samples"},
          {"passes", "", "rows of trials.csv; 0 of a session recovered without any"},
          kPilot,
          {"sex", "", "as the participant gave it"},
          {"handedness", "", "as the participant gave it"},
          {"age_band", "", "range of ages in years, as the participant gave it"}};
}

Docs trial_docs(const Levels& phases) {
  return {kSubject,
          kSession,
          {"pass", "", "number of the pass from 0, as in the samples"},
          pass_doc("trial"),
          pass_doc("condition"),
          phase_doc(phases),
          pass_doc("block"),
          pass_doc("repetition"),
          pass_doc("attempt"),
          practice_doc(),
          pass_doc("status"),
          pass_doc("stimulus_seed"),
          pass_doc("first_sample"),
          pass_doc("last_sample"),
          {"onset", "s", "since the first tick of the session"},
          {"duration", "s", "with approach, wait and return"},
          kIsSimulated,
          kPilot};
}

Docs happening_docs() {
  return {kSubject,
          kSession,
          {"time", "s", "since the first tick of the session"},
          {"kind", "", "what happened, in one word"},
          {"text", "", "details"}};
}

Docs score_docs() {
  Docs docs{kSubject,
            pass_doc("trial"),
            pass_doc("block"),
            pass_doc("repetition"),
            pass_doc("condition"),
            {"score", "", "recall error; 0 is perfect recall"},
            {"alignment_cost", "", "cost of the alignment for each pair of its path"},
            {"rms_force", "N", "root mean square difference of forces after the alignment"},
            {"rms_slope", "N/s", "the same of their slopes"},
            {"rms_unaligned", "N", "root mean square difference of forces before it"}};
  for (const auto& column : analysis::quality_columns()) {
    docs.push_back({column.name, column.unit, column.description});
  }
  docs.push_back({"flags", "", "what is wrong with the recording, in single words"});
  docs.push_back({"path_error", "m", "of a recalled path: its distance from the path, rms"});
  docs.push_back({"kept", "m", "of a led hand: its distance from the path in training, rms"});
  docs.push_back({"session", "", "number of the session, if several train"});
  return docs;
}

void add_session(RowText& row, const ExportSession& s) {
  row.add(s.info.subject).add(s.number).add(s.file.filename().string());
  row.add(truth(s.info.simulated)).add(s.info.device).add(s.info.clock);
  row.add(s.info.rate).add(s.info.seed).add(s.info.start_utc).add(s.info.definition_name);
  row.add(s.info.program_version).add(s.samples);
  row.add(static_cast<std::uint64_t>(s.passes)).add(truth(s.info.pilot));
  const auto& person = s.info.participant;
  row.add(person.sex).add(person.handedness).add(person.age_band).end();
}

void add_pass(RowText& row, const ExportSession& s, std::size_t index, const record::PassRow& pass,
              const char* status, const PassSpan& span) {
  row.add(s.info.subject).add(s.number).add(static_cast<std::uint64_t>(index)).add(pass.trial);
  row.add(pass.condition).add(record::name_of(pass.phase));
  row.add(pass.block).add(pass.repetition).add(pass.attempt).add(pass.practice ? 1 : 0);
  row.add(status);
  row.add(pass.stimulus_seed).add(pass.first_sample).add(pass.last_sample);
  row.add(span.onset).add(span.duration);
  row.add(truth(s.info.simulated)).add(truth(s.info.pilot)).end();
}

/// The three small tables.
class Tables {
 public:
  Tables()
      : sessions(heading(session_docs(), Delimited::kCsv)),
        trials(heading(trial_docs({}), Delimited::kCsv)),
        events(heading(happening_docs(), Delimited::kCsv)) {}

  void add(const ExportSession& session) {
    const record::SessionReader reader(session.file);
    RowText session_row(sessions, Delimited::kCsv);
    add_session(session_row, session);
    RowText pass_row(trials, Delimited::kCsv);
    const std::vector<PassSpan> spans = pass_spans(reader);
    const std::vector<const char*> statuses = pass_statuses(reader);
    for (const auto& pass : reader.passes()) {
      add_pass(pass_row, session, index_, pass, statuses[index_], spans.at(index_));
      ++index_;
    }
    passes += index_;
    index_ = 0;
    other_devices = std::max(other_devices, OtherDevices(reader).count());
    RowText event_row(events, Delimited::kCsv);
    for (const auto& event : reader.events()) {
      event_row.add(session.info.subject).add(session.number).add_seconds(event.time_ns);
      event_row.add(event.kind).add(event.text).end();
    }
  }

  std::string sessions;
  std::string trials;
  std::string events;
  std::size_t passes{0};
  std::size_t other_devices{0};  // after the first, of the session that has most

 private:
  std::size_t index_{0};
};

/// A table of a protocol, of all sessions together.
struct ProtocolTable {
  const record::TableDescription* table;
  std::string text;  // empty: no session has a row
};

Docs column_docs(const record::TableDescription& table) {
  Docs docs{kSubject, kSession};
  for (const ColumnDoc& doc : docs_of(table)) {
    docs.push_back(doc);
  }
  return docs;
}

/// The columns that every channel has.
Docs channel_docs() {
  const channel::ChannelTable table("NAME", {}, 1);
  return docs_of(table.table());
}

void add_incidents(ProtocolTable& own, const ExportSession& session,
                   const record::SessionReader& reader) {
  RowText row(own.text, Delimited::kCsv);
  for (const channel::IncidentRow& each : analysis::channel_incidents(reader)) {
    row.add(session.info.subject).add(session.number).add(each.time_ns).add(each.channel);
    row.add(channel::name_of(each.what)).add(each.amount).add(each.text).end();
  }
}

void add_rows(ProtocolTable& own, const ExportSession& session,
              const record::SessionReader& reader) {
  if (!reader.has(*own.table) || reader.count(*own.table) == 0) {
    return;
  }
  if (own.text.empty()) {
    own.text = heading(column_docs(*own.table), Delimited::kCsv);
  }
  if (own.table == &record::table_of<channel::IncidentRow>()) {
    add_incidents(own, session, reader);
    return;
  }
  std::vector<bool> counts(reader.count(*own.table), true);
  if (own.table == &record::table_of<record::AnswerRow>()) {
    counts = record::standing_answers(reader.rows<record::AnswerRow>());
  }
  RowText row(own.text, Delimited::kCsv);
  std::size_t place = 0;
  reader.each_row(*own.table, [&](const std::vector<record::Cell>& cells) {
    if (!counts[place++]) {
      return;
    }
    row.add(session.info.subject).add(session.number);
    for (const record::Cell& cell : cells) {
      std::visit([&](const auto& value) { row.add(value); }, cell);
    }
    row.end();
  });
}

/// Tables of passes, of answers to pages and of what befell channels; ticks and facts that a
/// session has from the beginning are too much for a table.
std::vector<ProtocolTable> protocol_tables(const std::vector<ExportSession>& sessions,
                                           const record::TableList& tables) {
  std::vector<ProtocolTable> all;
  for (const record::TableDescription* table : tables) {
    const record::RowsOf of = table->of();
    if (of == record::RowsOf::kPass || of == record::RowsOf::kEndedPass ||
        table == &record::table_of<record::AnswerRow>() ||
        table == &record::table_of<channel::IncidentRow>()) {
      all.push_back({table, ""});
    }
  }
  for (const ExportSession& session : sessions) {
    const record::SessionReader reader(session.file);
    for (ProtocolTable& own : all) {
      add_rows(own, session, reader);
    }
  }
  std::erase_if(all, [](const ProtocolTable& own) { return own.text.empty(); });
  return all;
}

nlohmann::ordered_json described(const char* what, const Docs& docs) {
  nlohmann::ordered_json json{{"description", what}};
  for (const auto& doc : docs) {
    auto& column = json["columns"][doc.name];
    column["description"] = doc.description;
    if (!doc.unit.empty()) {
      column["unit"] = doc.unit;
    }
    for (const auto& [value, meaning] : doc.levels) {
      column["levels"][value] = meaning;
    }
  }
  return json;
}

/// @param other_devices  after the first, of the session that has most
std::string dictionary(const CsvOptions& options, const std::vector<ProtocolTable>& own,
                       bool simulated, std::size_t other_devices) {
  nlohmann::ordered_json json;
  json["simulated"] = simulated;
  json["missing"] = "an empty field";
  auto& files = json["files"];
  files["sessions.csv"] = described("a row for each session", session_docs());
  files["trials.csv"] =
      described("a row for each pass; a trial has one of each phase, more if it was interrupted",
                trial_docs(options.phases));
  files["events.csv"] = described("what happened when", happening_docs());
  for (const ProtocolTable& table : own) {
    files[table.table->name() + ".csv"] =
        described(table.table->schema().description, column_docs(*table.table));
  }
  if (options.samples) {
    files["samples/*.csv.gz"] =
        described("a row for each tick of the servo loop", sample_docs(other_devices));
    files["stimuli/*.csv.gz"] =
        described("the ideal movement and target force of each block", stimulus_docs());
    files["channels/*.csv.gz"] =
        described("a row for each sample of a channel; the columns after these are its quantities",
                  channel_docs());
  }
  files["scores.csv"] =
      described("a row for each scored trial, which haptrial analyze writes", score_docs());
  return json.dump(2) + "\n";
}

/// "P01", or "P01-2" for a second session; other characters than in identifiers become '_'.
std::string file_stem(const ExportSession& session) {
  std::string stem = session.info.subject;
  for (char& c : stem) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    c = plain || c == '-' || c == '_' ? c : '_';
  }
  return session.of > 1 ? fmt::format("{}-{}", stem, session.number) : stem;
}

/// One for each session, all different.
std::vector<std::string> file_stems(const std::vector<ExportSession>& sessions) {
  std::vector<std::string> stems;
  std::set<std::string> taken;
  for (const auto& session : sessions) {
    std::string stem = file_stem(session);
    while (!taken.insert(stem).second) {
      stem += '_';
    }
    stems.push_back(stem);
  }
  return stems;
}

void write_channels(const NewFolder& out, const record::SessionReader& reader,
                    const std::string& stem) {
  for (const analysis::ChannelQuality& channel : analysis::channel_quality(reader)) {
    GzipFile file(out.place(fmt::format("channels/{}_{}.csv.gz", stem, channel.name)));
    write_channel(reader, *reader.description("channel_" + channel.name), Delimited::kCsv, nullptr,
                  file);
    file.close();
  }
}

void write_ticks(const NewFolder& out, const ExportSession& session, const std::string& stem,
                 Counter& counter) {
  const record::SessionReader reader(session.file);
  GzipFile samples(out.place("samples/" + stem + ".csv.gz"));
  write_samples(reader, Delimited::kCsv, samples, counter);
  samples.close();
  GzipFile stimuli(out.place("stimuli/" + stem + ".csv.gz"));
  stimuli.write(stimulus_text(reader.stimuli(), Delimited::kCsv));
  stimuli.close();
  write_channels(out, reader, stem);
}

}  // namespace

CsvSummary export_csv(std::span<const fs::path> files, const fs::path& folder,
                      const CsvOptions& options, const Watch& watch) {
  const std::vector<ExportSession> sessions = sessions_to_export(files);
  NewFolder out(folder);
  Tables tables;
  bool simulated = false;
  for (const auto& session : sessions) {
    tables.add(session);
    simulated = simulated || session.info.simulated;
    watch(0);
  }
  out.write("sessions.csv", tables.sessions);
  out.write("trials.csv", tables.trials);
  out.write("events.csv", tables.events);
  const std::vector<ProtocolTable> own = protocol_tables(sessions, options.tables);
  for (const ProtocolTable& table : own) {
    out.write(table.table->name() + ".csv", table.text);
  }
  out.write("dictionary.json", dictionary(options, own, simulated, tables.other_devices));
  if (options.samples) {
    const auto stems = file_stems(sessions);
    share_out(
        sessions.size(), options.jobs,
        [&](std::size_t i, Counter& counter) { write_ticks(out, sessions[i], stems[i], counter); },
        watch);
  }
  out.publish();
  return {sessions.size(), tables.passes, options.samples ? total_samples(sessions) : 0};
}

}  // namespace haptrial::exchange
