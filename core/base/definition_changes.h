#pragma once

#include <cstdint>
#include <optional>
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

/// What two definitions differ in. Comments, layout, the order of keys, and whether a number is
/// written 1 or 1.0, are no differences.
struct DefinitionChanges {
  std::vector<DefinitionChange> binding;  // of what is presented, recorded or scored
  std::vector<DefinitionChange> free;     // of what may change within a study; free_to_change()
  bool same_text{true};

  /// Whether sessions of both belong to one study.
  bool same_study() const { return binding.empty(); }
};

/// Whose hand held the tool. If it was a person's, the tables of the virtual hand were not used.
enum class Hand { kPerson, kVirtual };

/// Whether a key may change within a study: participants' texts, the screen's window, the set-up of
/// devices, the number of participants, the planned tests, and the virtual hand and device if no session used them.
/// Unknown keys may not. docs/guide-experimenter.md lists them.
bool free_to_change(std::string_view key, Hand hand);

/// Both texts are taken as they are where one of them is not TOML: files may hold anything.
DefinitionChanges definition_changes(std::string_view before, std::string_view after, Hand hand);

/// A number that equal values of a table of the definition share and different values, but for one
/// case in 2^64, do not; comments, layout and the order of keys do not count.
/// @returns nothing when the definition has no such table or is not TOML.
std::optional<std::uint64_t> table_fingerprint(std::string_view definition, std::string_view table);

/// "guidance.wait was 0.5, is 1; texts.rest was absent, is "Rest""; long lists are cut.
std::string sentence_of(const std::vector<DefinitionChange>& changes);

}  // namespace haptrial
