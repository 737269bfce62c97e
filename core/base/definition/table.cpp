#include "core/base/definition/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/definition/table_internal.h"
#include "core/base/definition/table_words_internal.h"
#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/nearest.h"

namespace haptrial {

namespace {

bool lacks(const toml::table& table, const toml::table& defaults) {
  return std::any_of(defaults.begin(), defaults.end(), [&](const auto& each) {
    const toml::node* there = table.get(each.first.str());
    return there == nullptr || (there->is_table() && each.second.is_table() &&
                                lacks(*there->as_table(), *each.second.as_table()));
  });
}

/// Copies have no place in a file: sentences about them name no line.
void fill_in_table(toml::table& table, const toml::table& defaults) {
  for (const auto& [key, value] : defaults) {
    toml::node* there = table.get(key.str());
    if (there == nullptr) {
      table.insert(key.str(), value);
    } else if (there->is_table() && value.is_table()) {
      fill_in_table(*there->as_table(), *value.as_table());
    }
  }
}

}  // namespace

Table::Table(std::shared_ptr<Document> document, std::shared_ptr<Node> node,
             const NumberSource* numbers)
    : document_(std::move(document)), node_(std::move(node)), numbers_(numbers) {}

Table Table::with(const NumberSource& numbers) const { return {document_, node_, &numbers}; }

Table Table::parse(std::string_view text, std::string_view file_name) {
  return parse(std::vector<NamedText>{{std::string(text), std::string(file_name)}});
}

Table Table::parse(const std::vector<NamedText>& parts) {
  auto document = std::make_shared<Document>();
  for (const NamedText& part : parts) {
    const auto lines = std::count(document->source.begin(), document->source.end(), '\n');
    document->parts.push_back({static_cast<unsigned>(lines), part.file_name});
    document->source += part.text;
  }
  const std::string& file_name = parts.front().file_name;
  document->root = std::make_shared<toml::table>(parse_toml(document->source, file_name));
  if (document->root->empty()) {
    throw InputError(
        fmt::format("{}: the definition is empty; write at least one KEY = VALUE", file_name));
  }
  return root_of(std::move(document));
}

Table Table::root_of(std::shared_ptr<Document> document) {
  auto root = std::make_shared<Node>(Node{document->root.get(), "", {}, {}, ""});
  document->nodes.push_back(root);
  return {std::move(document), std::move(root)};
}

Table Table::unread() const {
  auto document = std::make_shared<Document>();
  document->parts = document_->parts;
  document->source = document_->source;
  document->root = document_->root;
  return root_of(std::move(document));
}

Table Table::load(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(
        fmt::format("{}: no such file; give the name of a definition (.toml)", file.string()));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(
        fmt::format("{}: is {}; give the name of a definition (.toml)", file.string(),
                    std::filesystem::is_directory(status) ? "a directory" : "not a regular file"));
  }
  constexpr std::uintmax_t kLargest = 1 << 20;
  if (const auto size = std::filesystem::file_size(file, error); size > kLargest) {
    throw InputError(
        fmt::format("{}: has {} bytes; allowed: at most {}", file.string(), size, kLargest));
  }
  return parse(file_text(file), file.string());
}

void Table::fill_in(std::string_view defaults) {
  const toml::table all = parse_toml(defaults, "defaults");
  if (!lacks(*document_->root, all)) {
    return;
  }
  if (document_->root.use_count() > 1) {  // others read it as it is; a copy would have no lines
    document_->root = std::make_shared<toml::table>(
        parse_toml(document_->source, document_->parts.front().file_name));
    node_->table = document_->root.get();
  }
  fill_in_table(*document_->root, all);
}

const std::string& Table::source() const { return document_->source; }

bool Table::is_array(std::string_view key) const {
  if (exploration() != nullptr && !states(key)) {
    return exploration()->is_there(node_->path, key, "an array", false);
  }
  return node_->table != nullptr && node_->table->get(key) != nullptr &&
         node_->table->get(key)->is_array();
}

bool Table::is_nested(std::string_view key) const {
  return states(key) && is_array(key) && !node_->table->get(key)->as_array()->empty() &&
         node_->table->get(key)->as_array()->get(0)->is_array();
}

bool Table::is_table(std::string_view key) const {
  if (exploration() != nullptr && !states(key)) {
    return exploration()->is_there(node_->path, key, "a table", false);
  }
  return node_->table != nullptr && node_->table->get(key) != nullptr &&
         node_->table->get(key)->is_table();
}

bool Table::has(std::string_view key) const {
  node_->asked.emplace(key);
  if (exploration() != nullptr && !states(key)) {
    return exploration()->is_there(node_->path, key, "there", true);
  }
  return node_->table != nullptr && node_->table->contains(key);
}

std::vector<std::string> Table::keys() const {
  std::vector<std::string> names;
  if (node_->table != nullptr) {
    for (const auto& [key, value] : *node_->table) {
      names.emplace_back(key.str());
    }
  } else if (exploration() != nullptr) {
    names.emplace_back("NAME");
  }
  return names;
}

std::vector<std::string> Table::keys_as_written() const {
  std::vector<std::pair<toml::source_position, std::string>> found;
  if (node_->table != nullptr) {
    for (const auto& [key, value] : *node_->table) {
      found.emplace_back(key.source().begin, key.str());
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  if (node_->table == nullptr && exploration() != nullptr) {
    names.emplace_back("NAME");
  }
  for (const auto& [place, name] : found) {
    names.push_back(name);
  }
  return names;
}

void Table::note(unsigned line, std::string_view problem) {
  document_->note(document_->problems, line, problem);
}

unsigned Table::line(std::string_view key) const {
  const toml::node* node = node_->table == nullptr ? nullptr : node_->table->get(key);
  return node == nullptr ? line_of(node_->table) : line_of(node);
}

void Table::refuse(std::string_view key, std::string_view found, std::string_view allowed) {
  note(line(key), fmt::format("{} is {}; allowed: {}", node_->full(key), found, allowed));
}

void Table::reject(std::string_view key, std::string_view found, std::string_view allowed) {
  document_->note(document_->together, line(key),
                  fmt::format("{} is {}; allowed: {}", node_->full(key), found, allowed));
}

Table Table::table(std::string_view key) {
  const toml::table* inner = nullptr;
  if (exploration() != nullptr) {
    inner = states(key) ? node_->table->get(key)->as_table() : nullptr;
  } else if (node_->table != nullptr) {
    node_->read.emplace(key);
    const toml::node* node = node_->table->get(key);
    inner = node == nullptr ? nullptr : node->as_table();
    if (node == nullptr) {
      note(line_of(node_->table), fmt::format("the table [{}] is missing", node_->full(key)));
    } else if (inner == nullptr) {
      refuse(key, shown(*node), "a table");
    }
  }
  auto child = std::make_shared<Node>(Node{inner, node_->full(key), {}, {}, node_->full_name(key)});
  document_->nodes.push_back(child);
  return Table(document_, child, numbers_);
}

std::optional<Table> Table::left_out(std::string_view key) {
  if (exploration() != nullptr) {
    return std::nullopt;
  }
  const auto child =
      std::make_shared<Node>(Node{nullptr, node_->full(key), {}, {}, node_->full_name(key)});
  document_->nodes.push_back(child);
  return Table(document_, child, numbers_);
}

std::vector<Table> Table::tables(std::string_view key) {
  std::vector<Table> tables;
  if (exploration() != nullptr) {
    auto child = std::make_shared<Node>(Node{nullptr, node_->full(key) + "[]", {}, {}});
    document_->nodes.push_back(child);
    tables.push_back(Table(document_, child, numbers_));
    return tables;
  }
  if (node_->table == nullptr) {
    return tables;
  }
  node_->read.emplace(key);
  const toml::node* node = node_->table->get(key);
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (node == nullptr) {
    note(line_of(node_->table), fmt::format("the tables [[{}]] are missing", node_->full(key)));
  } else if (array == nullptr || array->empty()) {
    refuse(key, array == nullptr ? shown(*node) : "an empty array", "tables, each as [[…]]");
  }
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const toml::table* inner = array->get(i)->as_table();
    if (inner == nullptr) {
      refuse(key, fmt::format("an array with {}", shown_with_kind(*array->get(i))),
             "tables, each as [[…]]");
      continue;
    }
    auto child = std::make_shared<Node>(Node{inner,
                                             fmt::format("{}[{}]", node_->full(key), i + 1),
                                             {},
                                             {},
                                             fmt::format("{}.{}", node_->full_name(key), i + 1)});
    document_->nodes.push_back(child);
    tables.push_back(Table(document_, child, numbers_));
  }
  return tables;
}

void Table::pass_over(std::string_view key) { node_->read.emplace(key); }

void Table::leave(std::string_view key) {
  node_->read.emplace(key);
  if (exploration() != nullptr) {
    tell(key, {"table", {}, {}}, "");
  }
}

void Table::reject(std::string_view key, std::string_view rest) {
  document_->note(document_->together, line(key), fmt::format("{} {}", node_->full(key), rest));
}

bool Table::misspelled(std::string_view key) {
  if (exploration() != nullptr || has(key)) {
    return false;
  }
  for (const std::string& there : keys()) {
    if (nearest(there, {std::string(key)})) {
      note(line(there), fmt::format("{} is not a known key; did you mean {}?", node_->full(there),
                                    node_->full(key)));
      return true;
    }
  }
  return false;
}

void Table::note_unknown_keys() const {
  // The same table may have been asked for twice: a key is unknown if no reader knew it.
  std::map<const toml::table*, std::set<std::string, std::less<>>> read;
  std::map<const toml::table*, std::set<std::string, std::less<>>> known;
  for (const auto& node : document_->nodes) {
    read[node->table].insert(node->read.begin(), node->read.end());
    known[node->table].insert(node->read.begin(), node->read.end());
    known[node->table].insert(node->asked.begin(), node->asked.end());
  }
  std::set<const toml::table*> done;
  for (const auto& node : document_->nodes) {
    if (node->table == nullptr || !done.insert(node->table).second) {
      continue;
    }
    const std::vector<std::string> all(known[node->table].begin(), known[node->table].end());
    for (const auto& [key, value] : *node->table) {
      if (read[node->table].contains(key.str())) {
        continue;
      }
      std::vector<std::string> absent;  // a typo leaves out the key that was meant
      std::copy_if(all.begin(), all.end(), std::back_inserter(absent),
                   [&node](const auto& name) { return !node->table->contains(name); });
      const std::string hint = did_you_mean(key.str(), absent);
      document_->note(
          document_->problems, line_of(&value),
          fmt::format(
              "{} is not a known {}{}{} known here: {}",
              value.is_table() ? fmt::format("[{}]", node->full(key.str())) : node->full(key.str()),
              value.is_table() ? "table" : "key", hint, hint.empty() ? ";" : "", joined(all)));
    }
  }
}

void Table::check() const {
  const auto& problems = document_->problems.empty() ? document_->together : document_->problems;
  if (problems.empty()) {
    return;
  }
  std::string sentences;
  for (const auto& [line, sentence] : problems) {
    sentences += (sentences.empty() ? "" : "\n") + sentence;
  }
  throw InputError(sentences);
}

void Table::finish() const {
  note_unknown_keys();
  check();
}

}  // namespace haptrial
