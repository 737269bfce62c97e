#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/angular_units.h"
#include "core/base/definition/bounds.h"
#include "core/base/definition/translations.h"

namespace haptrial {

class KeyExploration;
struct KeyForm;
class NumberSource;
class Table;

/// A file's text and its name as sentences say it.
struct NamedText {
  std::string text;
  std::string file_name;
};

/// An entry of an array in which variables may stand for numbers.
struct NumberOrText {
  std::optional<double> number;  // nothing: the text counts
  std::string text;
};

/// Description of a key for lists of keys and documents.
struct KeyDescription {
  std::string name;
  std::string text;       // a noun phrase and its consequence
  std::string otherwise;  // what holds if it is left out, where no value says it: "none"
  bool required{false};
  bool tunable{false};  // a pilot may change it while it runs

  /// Whether its value is to be read; an optional key may be absent.
  bool stands_in(const Table& table) const;
  /// Whether a key with a default is to be read; lists of keys show the default.
  bool stands_in(const Table& table, double usual) const;
  bool stands_in(const Table& table, std::string_view usual) const;
};

/// A tunable key of a definition, with the value that its reader took.
struct TunableKey {
  std::string key;   // its path: "tools.cutting.feel.second_gain"
  std::string text;  // what it is
  Bounds bounds{};
  std::string unit;
  double value{0.0};
};

/// A table of a definition file (TOML), read key by key. Each read checks presence, type and bounds
/// and notes a problem instead of throwing, so that a definition is validated whole; finish() on
/// the document then throws one InputError with a sentence for every problem:
///
///     training.toml:12: trajectory.speed is -1.6; allowed: a number above 0 [m/s]
///
/// Keys that nobody read or asked for are problems too; their sentence names the nearest known key.
/// Not thread-safe; never on the servo thread.
class Table {
 public:
  /// @throws InputError when the text is not TOML, with the line.
  static Table parse(std::string_view text, std::string_view file_name);
  /// Texts of several files, as if one held them one after the other; sentences name each with its
  /// own lines. A text must end in a newline, and one that is not the first must begin with a
  /// table's header. @throws InputError as above
  static Table parse(const std::vector<NamedText>& parts);
  /// A definition whose absent keys are there or not as the exploration says, so that a reader
  /// shows what it knows (key_exploration.h). @param exploration  outlives the table
  static Table explore(std::string_view text, KeyExploration& exploration);
  /// @throws InputError when the file is absent, a directory, unreadable, empty or not TOML.
  static Table load(const std::filesystem::path& file);

  /// Gives the same document with nothing read yet; no text is parsed again. Any thread may ask a
  /// table that nobody reads meanwhile.
  Table unread() const;

  /// Required values. Where a problem is noted the smallest allowed finite value comes back.
  /// @param unit  as written in the message, "m/s"; empty for a pure number.
  double number(std::string_view key, const Bounds& bounds, std::string_view unit);
  long integer(std::string_view key, long low, long high);
  bool boolean(std::string_view key);
  std::string text(std::string_view key);
  /// A text that participants read: required, or `otherwise` if the key is left out. After
  /// translate() it is the translation.
  std::string shown_text(std::string_view key);
  std::string shown_text(std::string_view key, std::string_view otherwise);
  /// The same of a text of the program's own, as if it stood under `key`.
  std::string shown_as(std::string_view key, std::string text);
  /// The words in braces that stand for something in the shown text of `key`.
  void note_placeholders(std::string_view key, const std::vector<std::string>& words);
  std::string choice(std::string_view key, const std::vector<std::string>& allowed);
  std::vector<double> numbers(std::string_view key, const Bounds& bounds, std::string_view unit);
  std::vector<std::string> texts(std::string_view key);
  /// An array of numbers and texts as one row, or an array of such arrays: what stands for a vector
  /// or a matrix if entries may be variables. Bounds are the caller's.
  std::vector<std::vector<NumberOrText>> rows(std::string_view key, std::string_view allowed);

  /// The same of a key that may be left out.
  double number_or(std::string_view key, double otherwise, const Bounds& bounds,
                   std::string_view unit);
  int integer_or(std::string_view key, int otherwise, long low, long high);
  /// Says what a key is, and what the reader takes for one that is left out; only lists of keys
  /// listen.
  void describe(const KeyDescription& key) const;
  void otherwise(std::string_view key, double value) const;
  void otherwise(std::string_view key, std::string_view value) const;

  /// A view of this table in which texts may stand for numbers, also within its tables.
  /// @param numbers  outlives what is read from it
  Table with(const NumberSource& numbers) const;
  const NumberSource* numbers() const { return numbers_; }  // null: no text may stand for a number
  /// This table states its numbers in angular units, from now on and wherever it is asked for; what
  /// is read comes back in the units that readers ask for.
  void state_in(const AngularUnits& units);
  /// How the table states a number for which readers ask in `unit`; nothing: in this unit.
  std::optional<AngularUnits::GivenUnit> given_for(std::string_view unit) const;

  /// The number that a text within `key` stands for; nothing, with the problem noted, if it has
  /// none or is out of bounds.
  std::optional<double> worth(std::string_view key, std::string_view text, const Bounds& bounds,
                              std::string_view unit);

  /// A required table within this one; an absent one is noted and reads as empty without further
  /// problems.
  Table table(std::string_view key);
  /// A table that is left out, as an empty one and without a problem, for the defaults of its keys;
  /// nothing while a definition is explored.
  std::optional<Table> left_out(std::string_view key);
  /// The tables of a required array, [[key]], in their order; an absent or empty one is noted.
  /// Sentences name the second of them "key[2]".
  std::vector<Table> tables(std::string_view key);
  bool has(std::string_view key) const;
  /// Whether a text stands there, alone or within an array.
  bool has_text(std::string_view key) const;
  /// The text under `key`; nothing, and no problem, if something else is there.
  std::optional<std::string> whole_text(std::string_view key) const;
  bool is_array(std::string_view key) const;   // false of what is not there
  bool is_nested(std::string_view key) const;  // an array of arrays
  bool is_table(std::string_view key) const;   // likewise
  /// Gives the whole document what it lacks of another TOML text: missing tables, and missing keys
  /// within tables; what it states stays. source() does not change. A document that was unread(),
  /// and still lacks something, takes them before any table within it is asked for.
  void fill_in(std::string_view defaults);
  /// From now on shown_text() gives texts in another language. source() does not change.
  void translate(const Translations& translations);
  /// What shown_text() gave so far, each key once, in the order of first reading. Of an entry of an
  /// array of tables the key has the name instead of the number: "response.choices.yes.label".
  std::vector<ShownText> shown_texts() const;
  /// Notes the value of a key if it is tunable.
  void note_tunable(const KeyDescription& key, double value, const Bounds& bounds,
                    std::string_view unit);
  /// The tunable keys of the document that were read so far, in that order.
  const std::vector<TunableKey>& tunable_keys() const;
  /// The name of this table among those of its array, for keys of shown_texts().
  void name_entry(std::string_view name);
  /// A table of this one that another reader knows: its keys are not looked at here.
  void leave(std::string_view key);
  /// A key that is known and has no effect, since another table states it, too.
  void pass_over(std::string_view key);
  /// The keys of this table in the order of their names.
  std::vector<std::string> keys() const;
  /// The same in the order of the text.
  std::vector<std::string> keys_as_written() const;

  /// Notes a problem of values taken together, at the line of `key`. finish() reports these only
  /// if every value is good by itself: a missing value would make them up.
  /// @param found, allowed  complete the sentence "KEY is FOUND; allowed: ALLOWED", in which
  /// ALLOWED
  ///                        is a value, range, list or form
  void reject(std::string_view key, std::string_view found, std::string_view allowed);
  /// The same where no value can be named. @param rest  completes the sentence "KEY REST" and says
  ///                                                    what to do
  void reject(std::string_view key, std::string_view rest);

  /// Whether a key of this table is probably a misspelling of `key`; notes that if so.
  bool misspelled(std::string_view key);

  /// @throws InputError with the problems noted so far, before unknown keys are looked for: for a
  ///         value on which it depends what the other keys mean.
  void check() const;

  /// @throws InputError with every problem of the whole document, one sentence a line, in the order
  ///         of their lines.
  void finish() const;

  /// The text that was parsed, unchanged.
  const std::string& source() const;

 private:
  struct Document;
  struct Node;
  Table(std::shared_ptr<Document> document, std::shared_ptr<Node> node,
        const NumberSource* numbers = nullptr);
  static Table root_of(std::shared_ptr<Document> document);
  void note(unsigned line, std::string_view problem);
  void refuse(std::string_view key, std::string_view found, std::string_view allowed);
  void note_unknown_keys() const;
  unsigned line(std::string_view key) const;
  KeyExploration* exploration() const;
  bool states(std::string_view key) const;
  void tell(std::string_view key, const KeyForm& form, std::string_view allowed,
            std::string_view unit = "") const;
  template <class T>
  std::optional<T> get(std::string_view key, std::string_view allowed, bool any = true);
  template <class T>
  std::vector<T> array(std::string_view key, const std::string& allowed);
  std::shared_ptr<Document> document_;
  std::shared_ptr<Node> node_;
  const NumberSource* numbers_{nullptr};
};

}  // namespace haptrial
