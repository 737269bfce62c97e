#include "protocols/interface/recorded_definition.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/definition/translations.h"
#include "core/record/read/definition_versions.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/languages.h"

namespace haptrial::protocols {
namespace {

/// When the last attempt at a trial began, or the first trial of all where there is no such one, on
/// the clock of /samples [ns].
std::int64_t begin_of(const record::SessionReader& reader, int trial) {
  const std::vector<record::PassRow> passes = reader.passes();
  if (passes.empty() || reader.sample_count() == 0) {
    return std::numeric_limits<std::int64_t>::max();
  }
  std::uint64_t first = passes.front().first_sample;
  for (const record::PassRow& pass : passes) {
    const bool is_asked_for = trial > 0 && pass.trial == trial && !pass.practice;
    first = is_asked_for ? pass.first_sample : first;
  }
  const std::uint64_t row = record::row_of_tick(reader, record::samples_table(), first);
  return row < reader.sample_count() ? reader.samples(row, 1).front().time_ns
                                     : std::numeric_limits<std::int64_t>::max();
}

}  // namespace

Table recorded_definition(const record::SessionReader& reader, int trial) {
  const record::SessionInfo& info = reader.info();
  std::string definition = info.definition;
  std::string language;
  std::string texts;
  const std::int64_t begin = begin_of(reader, trial);
  for (record::EventRow& event : reader.events()) {
    if (event.time_ns > begin) {
      break;
    }
    if (event.kind == record::kNewDefinition) {
      definition = std::move(event.text);
    } else if (event.kind == record::kSessionResumed) {
      language.clear();
    } else if (event.kind == kLanguageEvent) {
      language = std::move(event.text);
      texts.clear();
    } else if (event.kind == kLanguageTextsEvent) {
      texts = std::move(event.text);
    }
  }
  Table root = Table::parse(definition, info.definition_name);
  if (!language.empty()) {
    root.translate(recorded_translations(language, std::move(texts), reader.path().string()));
  }
  return root;
}

void show_as_recorded(const record::SessionReader& reader, Definition& definition) {
  definition.display.mirrored = record::is_mirrored(reader);
}

}  // namespace haptrial::protocols
