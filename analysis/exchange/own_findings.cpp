#include "analysis/exchange/own_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/document/finding_json_internal.h"
#include "analysis/exchange/certificate_findings.h"
#include "analysis/exchange/channel_findings.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis {
namespace {

std::vector<FindingSource>& sources() {
  static std::vector<FindingSource> all{{"certificates", certificate_findings},
                                        {"channels", channel_findings}};
  return all;
}

/// A number is in own_findings.csv under its name unless it has another one there.
void complete(const std::string& list, FindingRow& row) {
  for (Finding& f : row) {
    if (f.name.empty()) {
      throw RunError(fmt::format("the findings '{}' have one without a name: '{}'", list, f.title));
    }
    if (f.csv.empty()) {
      f.csv = f.name;
    }
  }
  row.insert(row.begin(), Finding{.name = "findings", .value = list, .form = JsonForm::kAbsent});
}

FindingList found_by(const FindingSource& source,
                     const std::vector<std::filesystem::path>& sessions, bool simulated) {
  FindingList list = source.find(sessions);
  list.name = source.name;
  list.heading += simulated ? " (simulated)" : "";
  complete(list.name, list.findings);
  for (FindingTable& table : list.tables) {
    for (FindingRow& row : table.rows) {
      complete(list.name, row);
    }
  }
  for (Figure& figure : list.figures) {
    figure.name = fmt::format("own-{}-{}", list.name, figure.name);
    figure.simulated = simulated;
  }
  try {
    json_of(std::vector{list});
  } catch (const nlohmann::json::exception&) {
    throw RunError(fmt::format("the findings '{}' have a name that is a value and a group at once",
                               list.name));
  }
  return list;
}

}  // namespace

void add_finding_source(FindingSource source) {
  const bool plain = std::ranges::all_of(
      source.name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
  if (source.name.empty() || !plain) {
    throw std::invalid_argument(
        fmt::format("add_finding_source: the name is '{}'; allowed: letters, digits, '-' and '_'",
                    source.name));
  }
  if (std::ranges::find(sources(), source.name, &FindingSource::name) != sources().end()) {
    throw std::invalid_argument(
        fmt::format("add_finding_source: there is a source '{}' already", source.name));
  }
  sources().push_back(std::move(source));
}

std::vector<FindingList> own_findings(const std::vector<std::filesystem::path>& sessions) {
  std::vector<FindingList> lists;
  const bool simulated = std::ranges::any_of(sessions, [](const std::filesystem::path& file) {
    return record::SessionReader(file).info().simulated;
  });
  for (const FindingSource& source : sources()) {
    FindingList list = found_by(source, sessions, simulated);
    if (list.has_values() || !list.blocks.empty()) {
      lists.push_back(std::move(list));
    }
  }
  return lists;
}

}  // namespace haptrial::analysis
