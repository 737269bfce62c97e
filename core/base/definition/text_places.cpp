#include "core/base/definition/text_places_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

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

bool begins_with_bracket(std::string_view text, const toml::table& table) {
  const std::size_t begin = byte_of(text, table.source().begin);
  return !table.is_inline() && begin < text.size() && text[begin] == '[';
}

bool shares_header(const toml::table& table) {
  return std::any_of(table.begin(), table.end(), [&](const auto& child) {
    return (child.second.is_table() || child.second.is_array()) &&
           child.second.source().begin == table.source().begin;
  });
}

}  // namespace

KeyPath follow_path(const toml::table& root, std::string_view file_name, const std::string& key) {
  const std::vector<std::string> parts = parts_of(key);
  KeyPath path{{{&root, nullptr, ""}}, {}};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const toml::node& node = *path.steps.back().node;
    if (const toml::array* array = node.as_array()) {
      const toml::table* entry = entry_of(*array, parts[i]);
      if (entry == nullptr) {
        throw InputError(refusal(file_name, key, parts[i]));
      }
      path.steps.push_back({entry, nullptr, parts[i]});
      continue;
    }
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      throw InputError(refusal(file_name, key, parts[i - 1]));
    }
    const auto found = table->find(parts[i]);
    if (found == table->end()) {
      path.missing.assign(parts.begin() + static_cast<std::ptrdiff_t>(i), parts.end());
      return path;
    }
    path.steps.push_back({&found->second, &found->first, parts[i]});
  }
  return path;
}

std::size_t byte_of(std::string_view text, const toml::source_position& place) {
  constexpr std::string_view kMark = "\ufeff";  // the parser counts no column for it
  std::size_t at = place.line == 1 && text.starts_with(kMark) ? kMark.size() : 0;
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

std::size_t next_line(std::string_view text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string_view::npos ? text.size() : end + 1;
}

std::size_t header_end(std::string_view text, std::size_t begin) {
  std::size_t at = begin;
  char quote = '\0';
  for (; at < text.size() && (quote != '\0' || text[at] != ']'); ++at) {
    if (quote == '"' && text[at] == '\\') {
      ++at;  // what is escaped ends no text
    } else if (quote != '\0') {
      quote = text[at] == quote ? '\0' : quote;
    } else if (text[at] == '"' || text[at] == '\'') {
      quote = text[at];
    }
  }
  return std::min(text.size(), at + (text.substr(begin).starts_with("[[") ? 2 : 1));
}

bool has_header(std::string_view text, const toml::table& table) {
  return begins_with_bracket(text, table) && !shares_header(table);
}

bool is_implied(std::string_view text, const toml::table& table) {
  return begins_with_bracket(text, table) && shares_header(table);
}

bool has_headers(const toml::array& array) {
  return !array.empty() && array.front().is_table() && !array.front().as_table()->is_inline();
}

std::vector<Statement> own_statements(std::string_view text, const toml::table& table) {
  std::vector<Statement> found;
  for (const auto& [key, value] : table) {
    const toml::table* inner = value.as_table();
    if (inner != nullptr && !inner->is_inline()) {
      if (!begins_with_bracket(text, *inner)) {  // a dotted key
        const auto more = own_statements(text, *inner);
        found.insert(found.end(), more.begin(), more.end());
      }
    } else if (!value.is_array() || !has_headers(*value.as_array())) {
      found.push_back({&key, &value});
    }
  }
  return found;
}

std::string written_name(const std::string& name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-';
  });
  const char* quote = bare ? "" : name.find('\'') == std::string::npos ? "'" : "\"";
  return quote + name + quote;
}

std::string dotted_name(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) {
    all += (all.empty() ? "" : ".") + written_name(name);
  }
  return all;
}

std::vector<std::string> header_names(const KeyPath& path) {
  std::vector<std::string> names;
  for (const PathStep& step : path.steps) {
    if (step.key != nullptr) {
      names.push_back(step.name);
    }
  }
  names.insert(names.end(), path.missing.begin(), path.missing.end());
  return names;
}

const char* line_ending(std::string_view text) {
  return text.find("\r\n") != std::string_view::npos ? "\r\n" : "\n";
}

}  // namespace haptrial
