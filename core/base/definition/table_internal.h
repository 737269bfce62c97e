#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "core/base/definition/key_exploration.h"
#include "core/base/definition/table.h"

namespace haptrial {

// Parts of a Table; for the files that implement it.

/// 0 where nothing is written.
inline unsigned line_of(const toml::node* node) {
  return node == nullptr ? 0u : static_cast<unsigned>(node->source().begin.line);
}

struct Table::Document {
  struct Part {
    unsigned lines_before;
    std::string file_name;
  };
  KeyExploration* exploration{nullptr};  // off but for lists of keys
  std::vector<Part> parts;               // in order; at least one
  std::string source;
  std::shared_ptr<toml::table> root;              // shared by those who read the same document
  std::multimap<unsigned, std::string> problems;  // of one value each, by line
  std::multimap<unsigned, std::string> together;  // of values taken together, by line

  /// Notes a problem once, on one line of text whatever the definition holds.
  void note(std::multimap<unsigned, std::string>& in, unsigned line, std::string_view problem) {
    const auto part = std::find_if(parts.rbegin(), parts.rend() - 1,
                                   [line](const Part& each) { return each.lines_before < line; });
    std::string sentence =
        line == 0 ? fmt::format("{}: {}", parts.front().file_name, problem)
                  : fmt::format("{}:{}: {}", part->file_name, line - part->lines_before, problem);
    for (char& c : sentence) {
      const bool control = (c >= 0 && c < ' ') || c == '\x7f';
      c = control ? ' ' : c;
    }
    const auto [begin, end] = in.equal_range(line);
    if (std::none_of(begin, end, [&](const auto& noted) { return noted.second == sentence; })) {
      in.emplace(line, std::move(sentence));
    }
  }

  std::vector<std::shared_ptr<Node>> nodes;                // tables that somebody asked for
  std::map<std::string, AngularUnits, std::less<>> units;  // of tables that state_in(), by path
  Translations translations;
  std::vector<ShownText> shown;
  std::vector<TunableKey> tunable;
};

struct Table::Node {
  const toml::table* table;  // null where the definition lacks it
  std::string path;          // "trajectory", "gains.plane"; empty for the root
  std::set<std::string, std::less<>> read;
  std::set<std::string, std::less<>> asked;  // by has(): known, but not known to be read
  std::string named{path};                   // the path with names in place of numbers

  std::string full(std::string_view key) const {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }
  std::string full_name(std::string_view key) const {
    return named.empty() ? std::string(key) : fmt::format("{}.{}", named, key);
  }
};

}  // namespace haptrial
