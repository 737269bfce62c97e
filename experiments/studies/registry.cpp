#include "experiments/studies/registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "analysis/document/document.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/channel/channel_row.h"
#include "core/record/rows/common_tables.h"

namespace haptrial::experiments {
namespace {

std::vector<const Study*>& all() {
  static std::vector<const Study*> studies;
  return studies;
}

}  // namespace

std::unique_ptr<StudySimulation> Study::study_simulation(const protocols::Definition& definition,
                                                         const std::string& asked_in,
                                                         const std::string& watched) const {
  static_cast<void>(asked_in);
  static_cast<void>(watched);
  throw InputError(fmt::format(
      "{}: power by simulation does not know the report of protocol '{}'; see haptrial power t, "
      "anova and repeated",
      definition.file_name, protocol().name()));
}

void Study::add_methods(const protocols::Definition& definition, std::uint64_t seed,
                        analysis::Document& document) const {
  static_cast<void>(seed);
  document.heading("Procedure");
  document.points(definition.description());
}

const std::vector<const Study*>& studies() { return all(); }

std::vector<std::string> protocol_words() {
  std::vector<std::string> words;
  for (const Study* study : all()) {
    words.emplace_back(study->protocol().name());
    if (!study->protocol().synonym().empty()) {
      words.emplace_back(study->protocol().synonym());
    }
  }
  return words;
}

const Study* find_study(std::string_view word) {
  const auto found = std::find_if(all().begin(), all().end(), [&](const Study* study) {
    const std::string_view synonym = study->protocol().synonym();
    return study->protocol().name() == word || (!synonym.empty() && synonym == word);
  });
  return found != all().end() ? *found : nullptr;
}

void add_study(const Study& study) {
  if (find_study(study.protocol().name()) != nullptr) {
    throw std::invalid_argument(
        fmt::format("add_study: there is a protocol '{}' already", study.protocol().name()));
  }
  record::check_chunk_sizes(study.protocol().tables());
  all().push_back(&study);
}

record::TableList known_tables() {
  record::TableList tables =
      record::with_tables(record::common_tables(), {&record::table_of<channel::IncidentRow>()});
  for (const Study* study : all()) {
    tables = record::with_tables(std::move(tables), study->protocol().tables());
  }
  return tables;
}

std::vector<std::pair<std::string, std::string>> known_phases() {
  std::vector<std::pair<std::string, std::string>> known;
  for (const Study* study : all()) {
    for (const auto& [phase, meaning] : study->protocol().phases()) {
      const std::string name = phase.name();
      if (std::none_of(known.begin(), known.end(),
                       [&](const auto& each) { return each.first == name; })) {
        known.emplace_back(name, meaning);
      }
    }
  }
  return known;
}

const Study& study_of(Table& root) {
  if (root.misspelled("experiment")) {
    root.check();
  }
  Table experiment = root.table("experiment");
  const bool said = !experiment.misspelled("protocol") && experiment.has("protocol");
  const std::string name =
      said ? experiment.choice("protocol", protocol_words()) : protocol_words().front();
  root.check();
  return *find_study(name);
}

const Study& study_of(const record::SessionInfo& session) {
  Table root = Table::parse(session.definition, session.definition_name);
  return study_of(root);
}

const protocols::Protocol& protocol_of(const record::SessionInfo& session) {
  return study_of(session).protocol();
}

}  // namespace haptrial::experiments
