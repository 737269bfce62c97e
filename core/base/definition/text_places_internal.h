#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace haptrial {

/// A node on the way from the root of a definition to one of its keys.
struct PathStep {
  const toml::node* node;
  const toml::key* key;  // null for the root and for an entry of an array
  std::string name;      // the part of the path; empty for the root
};

/// The nodes that a path of keys leads through, the root first, and the names that the text lacks.
struct KeyPath {
  std::vector<PathStep> steps;
  std::vector<std::string> missing;
};

/// Follows a path such as "blocks.hard.shift" (GivenKey).
/// @throws InputError if it leads through something that is no table
KeyPath follow_path(const toml::table& root, std::string_view file_name, const std::string& key);

/// The byte of a place of the text; columns count characters.
std::size_t byte_of(std::string_view text, const toml::source_position& place);
/// The first byte behind the line of a byte; the size of the text for the last line.
std::size_t next_line(std::string_view text, std::size_t at);
/// The first byte behind a header [NAME] or [[NAME]] that begins at a byte.
std::size_t header_end(std::string_view text, std::size_t begin);

/// Whether a table has no braces and a header of its own. Tables that only a header of a table
/// within them, or a dotted key, implies have none.
bool has_header(std::string_view text, const toml::table& table);
/// Whether a header implies the table: [a.b] implies a.
bool is_implied(std::string_view text, const toml::table& table);
/// Whether entries stand below headers [[NAME]].
bool has_headers(const toml::array& array);

/// A value that the text states with one key, and the key.
struct Statement {
  const toml::key* key;
  const toml::node* value;
};

/// The statements of a table outside of the tables within it that have headers.
std::vector<Statement> own_statements(std::string_view text, const toml::table& table);

/// A name as a key of a text: in quotes if it needs them.
std::string written_name(const std::string& name);
std::string dotted_name(const std::vector<std::string>& names);
/// Names on a path as a header of a table has them: without entries of arrays.
std::vector<std::string> header_names(const KeyPath& path);
/// The line ending that the text uses.
const char* line_ending(std::string_view text);

}  // namespace haptrial
