// The texts that people are shown, which a language may replace.

#include <algorithm>

#include "core/base/definition/table.h"
#include "core/base/definition/table_internal.h"

namespace haptrial {

std::string Table::shown_text(std::string_view key) {
  const bool absent = node_->table == nullptr && exploration() == nullptr;
  return absent ? "" : shown_as(key, text(key));
}

std::string Table::shown_text(std::string_view key, std::string_view otherwise) {
  return shown_as(key, has(key) ? text(key) : std::string(otherwise));
}

std::string Table::shown_as(std::string_view key, std::string text) {
  const std::string name = node_->full_name(key);
  const std::string* found = document_->translations.of(name, text);
  std::vector<ShownText>& all = document_->shown;
  ShownText entry{name, found != nullptr ? *found : text, found != nullptr};
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const ShownText& each) { return each.key == name; });
  if (known == all.end()) {
    all.push_back(entry);
  } else {
    *known = entry;
  }
  return entry.text;
}

void Table::translate(const Translations& translations) { document_->translations = translations; }

std::vector<ShownText> Table::shown_texts() const { return document_->shown; }

void Table::name_entry(std::string_view name) {
  const std::size_t dot = node_->named.rfind('.');
  node_->named = node_->named.substr(0, dot == std::string::npos ? 0 : dot + 1) + std::string(name);
}

}  // namespace haptrial
