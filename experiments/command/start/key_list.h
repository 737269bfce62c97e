#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/key_exploration.h"

namespace haptrial::experiments {

class Study;

/// Every key of a definition of a study, each once: what tables share is under one of them, and
/// keys that vary over people are "number or { median, spread }". The readers say what is there.
std::vector<KnownKey> keys_of(const Study& study);

/// Tables that take the keys of another one, which alone are listed: "responses[]", "response".
const std::map<std::string, std::string>& shared_tables();

/// Keys that have one place on the page.
struct KeySection {
  std::string protocol;  // empty: of every protocol
  std::vector<KnownKey> keys;
};

/// All keys of the program; those that every protocol has, with the same bounds and defaults, once.
/// @param protocol  its keys alone, with those of every protocol; empty: all
std::vector<KeySection> key_sections(const std::string& protocol);
/// The keys with a word in their path or in what they are, whatever its case.
/// @throws InputError if no key has it
std::vector<KeySection> sections_with(const std::string& word);

/// A line for each key, for a terminal: whose it is, its path, unit, bounds and what it is.
std::string found_keys(const std::vector<KeySection>& sections);
/// The page docs/keys.md.
std::string key_page(const std::vector<KeySection>& sections);
/// A JSON Schema (draft 7) by which editors complete and check definitions of one protocol. Checks
/// of keys together are left to `haptrial validate`.
std::string key_json_schema(const std::vector<KnownKey>& keys, std::string_view protocol);

}  // namespace haptrial::experiments
