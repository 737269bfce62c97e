#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

/// A key whose value is another in a second definition.
struct DefinitionChange {
  std::string key;     // "guidance.force_limit"
  std::string before;  // as a definition would write it, shortened; "absent"
  std::string after;
};

/// A key that may not change although its table may.
struct BoundKey {
  std::string key;       // "device.force_delay"
  std::string absent{};  // the value that leaving the key out means, "1"; empty: none is known
};

/// Changes that sessions of one study may have, which the caller knows from the meaning of its
/// tables. A key that no list has may not change, an unknown one neither. '*' in a name is any part
/// between two dots.
struct DefinitionRules {
  std::vector<std::string> free{};  // tables with all they hold, "screen", and keys, "design.seats"
  std::vector<BoundKey> bound{};    // exceptions among them
  std::vector<std::string> ordered{};  // tables of the root in which the order of keys counts
  std::vector<std::string> kept{};     // free keys that may come and go, but not have another value

  bool may_change(std::string_view key) const;
  /// Adds what other rules have.
  void add(const DefinitionRules& more);
};

/// Differences of two definitions. Comments, layout, the order of keys, and whether a number is
/// written 1 or 1.0, are no differences.
struct DefinitionChanges {
  std::vector<DefinitionChange> binding;  // of what is presented, recorded or scored
  std::vector<DefinitionChange> free;     // of what may change within a study
  bool same_text{true};

  /// Whether sessions of both belong to one study.
  bool same_study() const { return binding.empty(); }
};

/// Compares two definitions by what they mean. Both texts are taken as they are where one of them
/// is not TOML: files may hold anything.
DefinitionChanges definition_changes(std::string_view before, std::string_view after,
                                     const DefinitionRules& rules);

/// Values of some tables and keys of a definition by the keys' full paths, each in one form, as
/// definition_changes() compares them. @throws InputError for a text that is not TOML
std::map<std::string, std::string> definition_values(std::string_view definition,
                                                     std::span<const std::string> names);

/// The keys of a definition that may not change, each with its value, in one form: equal for two
/// definitions of one study, but for kept keys, which count for nothing.
/// @throws InputError for a text that is not TOML
std::string binding_text(std::string_view definition, const DefinitionRules& rules);

/// A number that equal values of a table of the definition share and different values, but for one
/// case in 2^64, do not; comments, layout and the order of keys do not count.
/// @returns nothing when the definition has no such table or is not TOML.
std::optional<std::uint64_t> table_fingerprint(std::string_view definition, std::string_view table);

/// "guidance.wait was 0.5, is 1; texts.rest was absent, is "Rest""; long lists are cut.
std::string sentence_of(const std::vector<DefinitionChange>& changes);

}  // namespace haptrial
