#include "analysis/force_training/study/identity.h"

#include <fmt/format.h>

#include "analysis/force_training/study/study_result.h"
#include "core/base/definition/definition_changes.h"

namespace haptrial::analysis {
namespace {

Identity identity_of(const record::SessionInfo& info) {
  Identity identity{info.subject, info.simulated};
  if (!info.simulated || info.definition.empty()) {
    return identity;
  }
  identity.seed = info.seed;
  for (const char* table : {"hand", "subject", "pace"}) {
    if (const auto fingerprint = table_fingerprint(info.definition, table)) {
      identity.population[table] = fmt::format("{:016x}", *fingerprint);
    }
  }
  return identity;
}

}  // namespace

std::vector<Identity> identities(const StudyResult& study) {
  std::vector<Identity> all;
  for (const SessionSummary& session : study.sessions) {
    if (all.empty() || all.back().subject != session.info.subject) {
      all.push_back(identity_of(session.info));
    }
  }
  return all;
}

std::string why_another(const Identity& first, const Identity& second) {
  if (first.simulated != second.simulated) {
    return "a virtual subject in one study, a person in the other";
  }
  if (!first.simulated) {
    return "";
  }
  if (!first.seed || !second.seed) {
    return "virtual subjects of unknown seed";
  }
  if (*first.seed != *second.seed) {
    return fmt::format("virtual subjects of different seeds: {} and {}", *first.seed, *second.seed);
  }
  for (const auto& [table, fingerprint] : first.population) {
    const auto other = second.population.find(table);
    if (other != second.population.end() && other->second != fingerprint) {
      return fmt::format(
          "virtual subjects of different populations: [{}] of the definitions differs", table);
    }
  }
  return "";
}

}  // namespace haptrial::analysis
