#include "analysis/exchange/export_psych_ds.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "analysis/exchange/bids_pages.h"
#include "analysis/exchange/data_set_sessions.h"
#include "analysis/exchange/pass_facts.h"
#include "analysis/files/new_folder.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;
using bids::any_simulated;
using bids::Session;
using Json = nlohmann::ordered_json;

std::vector<ColumnDoc> pass_docs(const Levels& phases, const std::vector<ColumnDoc>& facts) {
  const auto pass = [](const char* name) { return doc_of(record::trials_table().schema(), name); };
  std::vector<ColumnDoc> docs{
      {"subject", "", "the subject's identifier in the session files"},
      {"session", "", "number of the subject's session, from 1"},
      {"simulated",
       "",
       "whether the subject is virtual",
       {{"true", "virtual"}, {"false", "a person"}}},
      {"pilot",
       "",
       "whether the session is no part of the study",
       {{"true", "a pilot"}, {"false", "part of the study"}}},
      {"pass", "", "number of the pass of the session, from 0"},
      {"onset", "s", "of the pass, since the first tick of the session; empty if nobody knows it"},
      {"duration", "s", "of the whole pass; empty if nobody knows it"},
      {"trial_type", "", "condition of the block"},
      phase_doc(phases)};
  for (const char* name : {"trial", "block", "repetition", "attempt"}) {
    docs.push_back(pass(name));
  }
  docs.push_back(pass("practice"));
  docs.back().levels = {{"0", "part of the study"}, {"1", "practice, never scored"}};
  docs.push_back(pass("status"));
  docs.back().levels = status_levels();
  merge_columns(facts, docs);
  return docs;
}

void add_pass_cells(const Session& session, const record::PassRow& pass, std::size_t index,
                    const char* status, const std::optional<PassSpan>& span, RowText& row) {
  const ExportSession& source = session.source;
  row.add(source.info.subject).add(source.number);
  row.add(truth(source.info.simulated)).add(truth(source.info.pilot));
  row.add(static_cast<std::uint64_t>(index));
  if (span && pass.last_sample >= pass.first_sample) {
    row.add(span->onset).add(span->duration);
  } else {
    row.add_missing().add_missing();
  }
  row.add(pass.condition).add(record::name_of(pass.phase));
  row.add(pass.trial).add(pass.block).add(pass.repetition).add(pass.attempt);
  row.add(pass.practice ? 1 : 0);
  row.add(status);
}

/// The passes of a session. @returns how many there are
std::size_t write_pass_table(const NewFolder& out, const Session& session,
                             const std::vector<ColumnDoc>& facts) {
  const record::SessionReader reader(session.source.file);
  const bool timed = record::imported_from(reader).empty();
  const PassFacts own = pass_facts(reader);
  const std::vector<record::PassRow> passes = reader.passes();
  const std::vector<const char*> statuses = pass_statuses(reader);
  const std::vector<PassSpan> spans = pass_spans(reader);
  std::string text = heading(pass_docs({}, facts), Delimited::kCsv);
  RowText row(text, Delimited::kCsv);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    add_pass_cells(session, passes[i], i, statuses[i],
                   timed ? std::optional(spans.at(i)) : std::nullopt, row);
    for (const ColumnDoc& column : facts) {
      const auto cell = own.cells[i].find(column.name);
      row.add(cell != own.cells[i].end() ? cell->second : std::string());
    }
    row.end();
  }
  const std::string label = bids_label(session.source.info.subject);
  out.write(fmt::format("data/subject-{}_session-{}_data.csv", label, session.source.number), text);
  return passes.size();
}

/// A column as schema.org's PropertyValue.
Json variable_of(const ColumnDoc& doc) {
  Json variable{{"@type", "PropertyValue"}, {"name", doc.name}, {"description", doc.description}};
  if (!doc.unit.empty()) {
    variable["unitText"] = doc.unit;
  }
  for (const auto& [value, meaning] : doc.levels) {
    variable["valueReference"].push_back(
        {{"@type", "DefinedTerm"}, {"termCode", value}, {"description", meaning}});
  }
  return variable;
}

Json schema_org_data_set(const std::string& name, const std::string& description,
                         const std::vector<ColumnDoc>& columns) {
  Json json{{"@context", "https://schema.org/"},
            {"@type", "Dataset"},
            {"name", name},
            {"description", description}};
  for (const ColumnDoc& column : columns) {
    json["variableMeasured"].push_back(variable_of(column));
  }
  return json;
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string data_set_name(std::span<const Session> sessions, const DataSetOptions& options) {
  const std::string name =
      options.name.empty() ? experiment_name(sessions.front().source.info) : options.name;
  return (any_simulated(sessions) ? "SIMULATED: " : "") + name;
}

std::string dataset_description(std::span<const Session> sessions, const DataSetOptions& options,
                                const std::vector<ColumnDoc>& columns) {
  const std::string mark = any_simulated(sessions) ? std::string(kSimulatedNotice) + " " : "";
  Json json = schema_org_data_set(
      data_set_name(sessions, options),
      mark + "Trials of an experiment, exported from session files of haptrial.", columns);
  for (const std::string& author : options.authors) {
    json["author"].push_back({{"@type", "Person"}, {"name", author}});
  }
  json["measurementTechnique"] = "haptrial " + options.program_version + ", export --psych-ds";
  json["keywords"] = {"Psych-DS", experiment_name(sessions.front().source.info)};
  return json_text(json);
}

std::string readme(std::span<const Session> sessions, const DataSetOptions& options) {
  return fmt::format(
      "# {}\n\n{}A data set of Psych-DS, exported from session files of haptrial.\n\n"
      "- `data/subject-*_data.csv`: a row for each pass (a trial has one of each phase, more if it "
      "was interrupted), with what was presented and answered. Practice has `practice` 1.\n"
      "- `data/questionnaire-*_data.csv`: answers to pages, if there are any.\n"
      "- `dataset_description.json`: what the columns mean; those of questionnaires stand beside "
      "them.\n"
      "- `materials/`: the definition of the experiment.\n\n"
      "Left out on purpose: samples, consent and free notes about participants.\n",
      data_set_name(sessions, options),
      any_simulated(sessions) ? std::string(kSimulatedNotice) + "\n\n" : "");
}

void write_questionnaires(const NewFolder& out, std::span<const Session> sessions) {
  for (const bids::Phenotype& page : bids::phenotypes(sessions, Delimited::kCsv)) {
    const std::string stem = fmt::format("data/questionnaire-{}_data", page.name);
    out.write(stem + ".csv", page.table);
    out.write(stem + ".json", json_text(schema_org_data_set(
                                  page.name, "Answers to the page " + page.name, page.columns)));
  }
}

}  // namespace

PsychDsSummary export_psych_ds(std::span<const fs::path> files, const fs::path& folder,
                               const DataSetOptions& options) {
  const std::vector<Session> sessions = data_set_sessions(files, options.compare);
  NewFolder out(folder);
  const std::vector<ColumnDoc> facts = fact_columns(sessions);
  out.write("dataset_description.json",
            dataset_description(sessions, options, pass_docs(options.phases, facts)));
  out.write("README.md", readme(sessions, options));
  write_definitions(out, sessions, "materials");
  out.write(".psychds-ignore", "materials/\n");  // which validators would not know
  write_questionnaires(out, sessions);
  PsychDsSummary summary;
  std::set<std::string> subjects;
  for (const Session& session : sessions) {
    summary.passes += write_pass_table(out, session, facts);
    subjects.insert(session.subject);
  }
  out.publish();
  summary.sessions = sessions.size();
  summary.subjects = subjects.size();
  summary.simulated = any_simulated(sessions);
  return summary;
}

}  // namespace haptrial::exchange
