#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/definition/bounds.h"

namespace haptrial {

class Table;
struct KeyDescription;

/// A kind of value that a key takes.
struct KeyForm {
  std::string type;                // one of KnownKey::type
  Bounds bounds{};                 // of each number; the widest, if other keys choose between some
  std::vector<std::string> words;  // of a choice
};

/// A key that a reader of definitions knows.
struct KnownKey {
  std::string table;  // "fields.NAME", "blocks[]"; NAME stands for any; empty: the root
  std::string key;
  std::string type;     // "number", "whole number", "true or false", "text", "list of numbers", …
  std::string allowed;  // in the words of sentences: "a number above 0 [m/s]"
  std::string unit;     // as in definitions, "m/s"; empty: none
  std::string otherwise;  // what it is worth if it is left out; empty: the reader does not say
  bool optional{false};   // the reader asks whether it is there
  std::vector<std::string> when;  // "type: wall, box": only with these choices of the same table
  std::string words;              // what it is; empty: its reader has no schema
  std::vector<KeyForm> forms;     // `type` and `allowed` for programs, each type once
  bool tunable{false};            // a pilot may change it while it runs

  std::string path() const { return table.empty() ? key : table + "." + key; }
};

/// What a Table asks while a definition is explored; see known_keys().
class KeyExploration {
 public:
  /// One reading: which way was taken where, by name; the ways that are not named are the first.
  using Plan = std::map<std::string, std::size_t>;
  void begin(Plan plan);
  /// Plans for the ways that this reading saw and no reading has taken.
  std::vector<Plan> further();

  bool is_there(std::string_view table, std::string_view key, std::string_view what, bool first);
  std::string choose(std::string_view table, std::string_view key,
                     const std::vector<std::string>& allowed, const std::string& first);
  void ask(const KnownKey& key);
  void describe(std::string_view table, const KeyDescription& key);
  void note_default(std::string_view table, std::string_view key, const std::string& value);
  /// What note_default() said in any reading, if it is a number.
  std::optional<double> default_of(std::string_view table, std::string_view key) const;
  void note_text(std::string_view table, std::string_view key);  // a text may stand there too
  /// What choose() took in this reading; empty: nothing was chosen.
  std::string chosen(std::string_view table, std::string_view key) const;

  std::vector<KnownKey> keys() const;

 private:
  using Choices = std::map<std::string, std::string>;  // word by key
  std::size_t take(std::string name, std::size_t ways);
  void keep_chosen();

  Plan plan_;
  std::vector<std::pair<std::string, std::size_t>> taken_;  // of this reading: name, ways
  std::unordered_map<std::string, std::size_t> planned_;    // ways that have a plan, by name
  std::map<std::string, Choices> chosen_;                   // of this reading, by table
  std::map<std::string, std::set<Choices>> read_;           // what readings chose, by table
  struct Known {
    KnownKey key;
    std::size_t order{0};
    std::size_t askings{0};
    std::map<std::string, std::set<std::string>> with;  // words by key, of the same table
    std::map<std::string, std::size_t> with_count;
  };
  bool bound_by(const Known& known, const std::string& choice) const;
  std::unordered_map<std::string, Known> known_;                                  // by path
  std::map<std::string, std::map<std::string, std::vector<std::string>>> words_;  // table, key
  std::unordered_set<std::string> optional_, required_, texts_, tunable_;
  std::unordered_map<std::string, std::string> defaults_;
  std::unordered_map<std::string, std::string> described_;  // words, by path
};

/// Finds every key that a reader asks for, by reading definitions that are not there: each key that
/// is looked for is found, or not, and each choice takes each of its words, until no reading has
/// anything new. What the reader does with the values does not matter; its problems are dropped.
///
///     const auto keys = known_keys("[experiment]\n", [](Table& root) { read(root); });
///
/// @param text        keys with values that the reader is to find, as its defaults are
/// @param beginnings  first readings, where one change after another does not lead everywhere
std::vector<KnownKey> known_keys(std::string_view text,
                                 const std::function<void(Table& root)>& reader,
                                 const std::vector<KeyExploration::Plan>& beginnings = {{}});

}  // namespace haptrial
