// What a table of definitions tells an exploration of its keys.
#include <fmt/format.h>

#include <deque>
#include <exception>

#include "core/base/definition/table_internal.h"
#include "core/base/definition/table_words_internal.h"

namespace haptrial {
namespace {

constexpr std::size_t kMostReadings = 50000;

}  // namespace

Table Table::explore(std::string_view text, KeyExploration& exploration) {
  Table root = parse(text, "definition");
  root.document_->exploration = &exploration;
  return root;
}

KeyExploration* Table::exploration() const { return document_->exploration; }

/// Whether a value stands there, of whatever kind.
bool Table::states(std::string_view key) const {
  return node_->table != nullptr && node_->table->contains(key);
}

/// What an exploration is to know of a key.
void Table::tell(std::string_view key, const KeyForm& form, std::string_view allowed,
                 std::string_view unit) const {
  exploration()->ask({node_->path,
                      std::string(key),
                      form.type,
                      std::string(allowed),
                      std::string(unit),
                      states(key) ? shown(*node_->table->get(key)) : "",
                      false,
                      {},
                      "",
                      {form}});
}

void Table::otherwise(std::string_view key, double value) const {
  if (exploration() != nullptr) {
    exploration()->note_default(node_->path, key, fmt::format("{}", value));
  }
}

void Table::otherwise(std::string_view key, std::string_view value) const {
  if (exploration() != nullptr) {
    exploration()->note_default(node_->path, key, std::string(value));
  }
}

void Table::describe(const KeyDescription& key) const {
  if (exploration() != nullptr) {
    exploration()->describe(node_->path, key);
  }
}

bool KeyDescription::stands_in(const Table& table) const { return required || table.has(name); }

bool KeyDescription::stands_in(const Table& table, double usual) const {
  if (!required && otherwise.empty()) {
    table.otherwise(name, usual);
  }
  return stands_in(table);
}

bool KeyDescription::stands_in(const Table& table, std::string_view usual) const {
  if (!required && otherwise.empty() && !usual.empty()) {
    table.otherwise(name, usual);
  }
  return stands_in(table);
}

double Table::number_or(std::string_view key, double value, const Bounds& bounds,
                        std::string_view unit) {
  otherwise(key, value);
  return has(key) ? number(key, bounds, unit) : value;
}

int Table::integer_or(std::string_view key, int value, long low, long high) {
  otherwise(key, value);
  return has(key) ? static_cast<int>(integer(key, low, high)) : value;
}

std::vector<KnownKey> known_keys(std::string_view text,
                                 const std::function<void(Table& root)>& reader,
                                 const std::vector<KeyExploration::Plan>& beginnings) {
  KeyExploration exploration;
  std::deque<KeyExploration::Plan> plans(beginnings.begin(), beginnings.end());
  for (std::size_t reading = 0; !plans.empty() && reading < kMostReadings; ++reading) {
    exploration.begin(std::move(plans.front()));
    plans.pop_front();
    try {
      Table root = Table::explore(text, exploration);
      reader(root);
    } catch (const std::exception&) {
      // Values that no definition would have; what was asked for before counts.
    }
    for (KeyExploration::Plan& plan : exploration.further()) {
      plans.push_back(std::move(plan));
    }
  }
  return exploration.keys();
}

}  // namespace haptrial
