#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::analysis {

struct StudyResult;

/// Identity of a participant. A person is known by the identifier. A virtual subject is drawn from
/// the seed, the identifier and the population: only all three together make the same one again.
struct Identity {
  std::string subject;  // identifier
  bool simulated{false};
  std::optional<std::uint64_t> seed{};  // of a virtual subject; unknown for imported curves
  std::map<std::string, std::string> population{};  // table of the definition, its fingerprint
};

/// Identities of a study's participants, in their order.
std::vector<Identity> identities(const StudyResult& study);

/// Why two participants of the same identifier are not the same one, "virtual subjects of different
/// seeds: 1 and 2"; empty when they are. Populations are compared in the tables that both have:
/// only a study at the participants' own pace has [pace].
std::string why_another(const Identity& first, const Identity& second);

}  // namespace haptrial::analysis
