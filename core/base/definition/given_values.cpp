#include "core/base/definition/given_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"

namespace haptrial {
namespace {

std::vector<std::string> parts_of(std::string_view key) {
  std::vector<std::string> parts(1);
  for (const char c : key) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// The byte of a place of the text; columns count characters.
std::size_t byte_of(std::string_view text, const toml::source_position& place) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < place.line; ++line) {
    at = std::min(text.size(), text.find('\n', at) + 1);
  }
  const auto continues = [&] { return (static_cast<unsigned char>(text[at]) & 0xc0U) == 0x80U; };
  for (toml::source_index column = 1; column < place.column && at < text.size(); ++column) {
    do {
      ++at;
    } while (at < text.size() && continues());
  }
  return at;
}

/// A table of an array by its name or its number; null: there is none.
const toml::table* entry_of(const toml::array& array, const std::string& part) {
  for (const toml::node& each : array) {
    const toml::table* table = each.as_table();
    if (table != nullptr && (*table)["name"].value<std::string>() == part) {
      return table;
    }
  }
  std::size_t number = 0;
  const auto read = std::from_chars(part.data(), part.data() + part.size(), number);
  const bool whole = read.ec == std::errc() && read.ptr == part.data() + part.size();
  return whole && number >= 1 && number <= array.size() ? array[number - 1].as_table() : nullptr;
}

std::string refusal(std::string_view file_name, const std::string& key, const std::string& part) {
  return fmt::format("{}: there is no table {} for the key {}; give a key of the definition",
                     file_name, part, key);
}

/// Offset at which a table's own keys begin: behind its header, or behind the brace of an inline
/// one.
std::size_t inside(std::string_view text, const toml::table& table) {
  const std::size_t begin = byte_of(text, table.source().begin);
  if (table.is_inline()) {
    return begin + 1;
  }
  const std::size_t end = text.find('\n', begin);
  return end == std::string_view::npos ? text.size() : end + 1;
}

std::string with_new_key(std::string text, const toml::table& table, const std::string& name,
                         const std::string& value) {
  const std::size_t at = inside(text, table);
  const char* end = !table.is_inline() ? "\n" : table.empty() ? " " : ",";
  const std::string before = at > 0 && at == text.size() && text.back() != '\n' ? "\n" : "";
  return text.insert(at, before + fmt::format(" {} = {}{}", name, value, end));
}

std::string with_value(std::string text, std::string_view file_name, const GivenKey& given) {
  const toml::table root = parse_toml(text, file_name);
  const std::vector<std::string> parts = parts_of(given.key);
  const toml::table* table = &root;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const toml::node* node = table->get(parts[i]);
    if (node == nullptr) {  // keys below a header that the text has only begun: a table at the end
      const std::size_t cut = given.key.rfind('.');
      return text +
             fmt::format("\n[{}]\n{} = {}\n", given.key.substr(0, cut), parts.back(), given.value);
    }
    const toml::array* array = node->as_array();
    table = array != nullptr ? entry_of(*array, parts[++i]) : node->as_table();
    if (table == nullptr || i + 1 >= parts.size()) {
      throw InputError(refusal(file_name, given.key, parts[std::min(i, parts.size() - 1)]));
    }
  }
  const toml::node* value = table->get(parts.back());
  if (value == nullptr && table == &root) {
    return fmt::format("{} = {}\n", parts.back(), given.value) + text;
  }
  if (value == nullptr) {
    return with_new_key(std::move(text), *table, parts.back(), given.value);
  }
  if (value->is_array_of_tables() || (value->is_table() && !value->as_table()->is_inline())) {
    throw InputError(fmt::format("{}: {} is a table; give a key of it", file_name, given.key));
  }
  const std::size_t begin = byte_of(text, value->source().begin);
  return text.replace(begin, byte_of(text, value->source().end) - begin, given.value);
}

}  // namespace

std::string with_values(std::string_view text, std::string_view file_name,
                        std::span<const GivenKey> given) {
  std::string changed(text);
  for (const GivenKey& each : given) {
    changed = with_value(std::move(changed), file_name, each);
  }
  return changed;
}

}  // namespace haptrial
