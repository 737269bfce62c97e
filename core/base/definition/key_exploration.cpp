#include "core/base/definition/key_exploration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "core/base/definition/table.h"

namespace haptrial {
namespace {

std::string path_of(std::string_view table, std::string_view key) {
  std::string path(table);
  if (!path.empty()) {
    path += '.';
  }
  return path += key;
}

/// Adds what is asked for another way. Bounds that follow from other keys have no end of ways.
void join(std::string& all, const std::string& another) {
  if (all == another) {
    return;
  }
  constexpr const char* kDepends = ", or as other keys say";
  constexpr std::size_t kMost = 2;
  std::size_t ways = 1;
  for (std::size_t at = all.find(" or a"); at != std::string::npos;
       at = all.find(" or a", at + 1)) {
    ++ways;
  }
  if (another.empty() || all.find(another) != std::string::npos || all.ends_with(kDepends)) {
    return;
  }
  all += all.empty() ? another : ways < kMost ? " or " + another : kDepends;
}

Bounds widest(const Bounds& a, const Bounds& b) {
  const bool open =
      a.low == b.low ? a.open_low && b.open_low : (a.low < b.low ? a.open_low : b.open_low);
  return {std::min(a.low, b.low), std::max(a.high, b.high), open};
}

/// Joins forms of one type: what either allows.
void join(std::vector<KeyForm>& all, const KeyForm& another) {
  const auto same = std::find_if(all.begin(), all.end(),
                                 [&](const KeyForm& each) { return each.type == another.type; });
  if (same == all.end()) {
    all.push_back(another);
    return;
  }
  same->bounds = widest(same->bounds, another.bounds);
  if (same->words == another.words) {
    return;
  }
  std::copy_if(another.words.begin(), another.words.end(), std::back_inserter(same->words),
               [&](const std::string& word) {
                 return std::find(same->words.begin(), same->words.end(), word) ==
                        same->words.end();
               });
}

}  // namespace

void KeyExploration::begin(Plan plan) {
  plan_ = std::move(plan);
  taken_.clear();
  keep_chosen();
  chosen_.clear();
}

void KeyExploration::keep_chosen() {
  for (const auto& [table, choices] : chosen_) {
    read_[table].insert(choices);
  }
}

/// Whether a key goes with some words of a choice alone: it is asked for after the choice always,
/// with some words only, and a reading that agrees in every other such choice took another word
/// and did not ask. Without that reading the word may only be the one that came along.
bool KeyExploration::bound_by(const Known& known, const std::string& choice) const {
  const auto words = words_.find(known.key.table);
  const auto limits = [&](const std::string& name) {
    return known.with.at(name).size() < words->second.at(name).size() &&
           known.with_count.at(name) == known.askings;
  };
  if (!limits(choice)) {
    return false;
  }
  const auto agrees = [&](const Choices& reading) {
    return std::all_of(known.with.begin(), known.with.end(), [&](const auto& other) {
      const auto word = reading.find(other.first);
      const bool in = word != reading.end() && other.second.contains(word->second);
      return other.first == choice ? word != reading.end() && !in : in || !limits(other.first);
    });
  };
  const auto readings = read_.find(known.key.table);
  return readings != read_.end() &&
         std::any_of(readings->second.begin(), readings->second.end(), agrees);
}

std::vector<KeyExploration::Plan> KeyExploration::further() {
  keep_chosen();
  std::vector<Plan> plans;
  for (const auto& [name, ways] : taken_) {
    std::size_t& planned = planned_.try_emplace(name, 1).first->second;  // the first needs none
    for (; planned < ways; ++planned) {
      plans.push_back(plan_);
      plans.back()[name] = planned;
    }
  }
  return plans;
}

std::size_t KeyExploration::take(std::string name, std::size_t ways) {
  const auto at = plan_.find(name);
  taken_.emplace_back(std::move(name), ways);
  return at != plan_.end() ? std::min(at->second, ways - 1) : 0;
}

bool KeyExploration::is_there(std::string_view table, std::string_view key, std::string_view what,
                              bool first) {
  if (what == "there") {
    optional_.insert(path_of(table, key));
  }
  std::string name = path_of(table, key);
  (name += " is ") += what;
  const std::size_t way = take(std::move(name), 2);
  return (way == 0) == first;
}

std::string KeyExploration::choose(std::string_view table, std::string_view key,
                                   const std::vector<std::string>& allowed,
                                   const std::string& first) {
  std::vector<std::string> words = allowed;
  const auto at = std::find(words.begin(), words.end(), first);
  if (at != words.end()) {
    std::rotate(words.begin(), at, at + 1);
  }
  words_[std::string(table)][std::string(key)] = allowed;
  const std::string& word = words.at(take(path_of(table, key), words.size()));
  chosen_[std::string(table)][std::string(key)] = word;
  return word;
}

void KeyExploration::ask(const KnownKey& key) {
  Known& known = known_[key.path()];
  if (known.askings == 0) {
    known.key = key;
    known.order = known_.size();
  } else {
    join(known.key.type, key.type);
    join(known.key.unit, key.unit);
    join(known.key.allowed, key.allowed);
    join(known.key.forms, key.forms.at(0));
  }
  ++known.askings;
  for (const auto& [choice, word] : chosen_[key.table]) {
    if (choice != key.key) {
      known.with[choice].insert(word);
      ++known.with_count[choice];
    }
  }
}

void KeyExploration::describe(std::string_view table, const KeyDescription& key) {
  const std::string path = path_of(table, key.name);
  std::string& known = described_[path];
  if (known.find(key.text) == std::string::npos) {
    known += known.empty() ? key.text : "; " + key.text;  // kinds of one table may share a key
  }
  if (key.required) {
    required_.insert(path);
  }
  if (key.tunable) {
    tunable_.insert(path);
  }
  if (!key.otherwise.empty()) {
    note_default(table, key.name, key.otherwise);
  }
}

void KeyExploration::note_default(std::string_view table, std::string_view key,
                                  const std::string& value) {
  std::string& known = defaults_[path_of(table, key)];
  constexpr const char* kDepends = ", or as other keys say";
  if (known.empty()) {
    known = value;
  } else if (known != value && !known.ends_with(kDepends)) {
    known += kDepends;
  }
  optional_.insert(path_of(table, key));
}

std::optional<double> KeyExploration::default_of(std::string_view table,
                                                 std::string_view key) const {
  const auto at = defaults_.find(path_of(table, key));
  double value = 0.0;
  if (at == defaults_.end() ||
      std::from_chars(at->second.data(), at->second.data() + at->second.size(), value).ec !=
          std::errc()) {
    return std::nullopt;
  }
  return value;
}

void KeyExploration::note_text(std::string_view table, std::string_view key) {
  texts_.insert(path_of(table, key));
}

std::string KeyExploration::chosen(std::string_view table, std::string_view key) const {
  const auto at = chosen_.find(std::string(table));
  if (at == chosen_.end()) {
    return "";
  }
  const auto word = at->second.find(std::string(key));
  return word != at->second.end() ? word->second : "";
}

std::vector<KnownKey> KeyExploration::keys() const {
  std::vector<const Known*> all;
  for (const auto& [path, known] : known_) {
    all.push_back(&known);
  }
  std::sort(all.begin(), all.end(),
            [](const Known* a, const Known* b) { return a->order < b->order; });
  std::vector<KnownKey> keys;
  for (const Known* known : all) {
    KnownKey key = known->key;
    const std::string path = key.path();
    key.optional =
        (optional_.contains(path) && !required_.contains(path)) || !key.otherwise.empty();
    if (const auto at = defaults_.find(path); at != defaults_.end() && key.otherwise.empty()) {
      key.otherwise = at->second;
    }
    key.tunable = tunable_.contains(path);
    if (const auto at = described_.find(path); at != described_.end()) {
      key.words = at->second;
    }
    if (texts_.contains(path) && key.type != "choice" &&
        key.type.find("text") == std::string::npos) {
      key.type += " or text";
      key.forms.push_back({"text", {}, {}});
    }
    const auto choices = words_.find(key.table);
    for (const auto& [choice, with] : known->with) {
      const std::vector<std::string>& words = choices->second.at(choice);
      if (bound_by(*known, choice)) {
        std::vector<std::string> own;
        std::copy_if(words.begin(), words.end(), std::back_inserter(own),
                     [&](const std::string& word) { return with.contains(word); });
        key.when.push_back(fmt::format("{}: {}", choice, fmt::join(own, ", ")));
      }
    }
    keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace haptrial
