#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/given_values.h"
#include "core/base/definition/table.h"

namespace haptrial::protocols {

/// The tables of a definition that describe machines and not the study: devices and the screen. A
/// lab file may hold these and no others.
const std::vector<std::string>& machine_tables();

/// Loads a definition, and the lab file that it may name, which holds the tables of a laboratory's
/// machines (machine_tables()) and nothing of the study:
///
///     [lab]
///     use = "lab.toml"   # a path from the definition
///
/// The lab file's text follows the definition's, and then a table [certificate] with the key
/// figures of the certificate that device.certificate names, so that source() is a definition that
/// needs no other file: session files keep it so.
/// @param given  keys of the definition that have these values instead; source() has them
/// @throws InputError as Table::load() does for either file, and when the lab file holds another
/// table, one that the definition has as well, or a key outside a table, or the certificate is
/// none.
Table load_with_lab(const std::filesystem::path& definition, std::span<const GivenKey> given = {});

/// The lab file that holds the table of this key; empty if none does, so that the key belongs to
/// the definition itself. @throws InputError as Table::load() does for either file
std::filesystem::path lab_with(const std::filesystem::path& definition, const std::string& key);

/// The lab file that a definition's text names; empty if none, or if the text is not TOML.
std::string lab_of(std::string_view definition);

}  // namespace haptrial::protocols
