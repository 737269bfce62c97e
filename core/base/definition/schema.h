#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"

namespace haptrial {

/// The keys of one table of a definition, and the members of a struct that they set. A schema is
/// written once, beside its struct, and is all that the program knows of these keys: reading with
/// bounds, units and defaults, the sentences about mistakes, and the lists of keys follow from it.
///
///     const Schema<EnvelopeLimits>& envelope_schema() {
///       static const auto schema =
///           Schema<EnvelopeLimits>()
///               .number("max_force", &EnvelopeLimits::max_force, {0.0, 100.0, true}, "N",
///                       "Greatest force that is commanded")
///               .required()
///               .number("ramp_in", &EnvelopeLimits::ramp_in, {0.05, 10.0}, "s",
///                       "Time over which the force of a pass grows");
///       return schema;
///     }
///
/// A key may be left out unless it is required(); its default is that of a default-constructed T.
/// Descriptions are noun phrases that a stranger understands without the neighbouring keys: what it
/// is, and what follows from it. Not for the servo thread; const once it is built.
template <class T>
class Schema {
 public:
  /// A number, or nothing while the key is left out.
  Schema& number(std::string name, double T::*member, const Bounds& bounds, std::string unit,
                 std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table, into.*member)) {
                   into.*member = table.number(key.name, bounds, unit);
                 }
                 table.note_tunable(key, into.*member, bounds, unit);
               });
  }
  Schema& number(std::string name, std::optional<double> T::*member, const Bounds& bounds,
                 std::string unit, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = table.number(key.name, bounds, unit);
                 }
               });
  }
  template <class Integer>
  requires std::is_integral_v<Integer> Schema& integer(std::string name, Integer T::*member,
                                                       long low, long high,
                                                       std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table, static_cast<double>(into.*member))) {
                   into.*member = static_cast<Integer>(table.integer(key.name, low, high));
                 }
               });
  }
  Schema& integer(std::string name, std::optional<int> T::*member, long low, long high,
                  std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = static_cast<int>(table.integer(key.name, low, high));
                 }
               });
  }
  Schema& flag(std::string name, bool T::*member, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table, into.*member ? "true" : "false")) {
                   into.*member = table.boolean(key.name);
                 }
               });
  }
  Schema& text(std::string name, std::string T::*member, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table, into.*member)) {
                   into.*member = table.text(key.name);
                 }
               });
  }
  /// A text that participants read, which translations may replace.
  Schema& shown_text(std::string name, std::string T::*member, std::string description) {
    return shown_text(std::move(name), member, std::string::npos, std::move(description));
  }
  /// The same, in bytes no longer than `most`.
  Schema& shown_text(std::string name, std::string T::*member, std::size_t most,
                     std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table, into.*member)) {
                   into.*member = table.shown_text(key.name);
                 } else if (!(into.*member).empty()) {
                   into.*member = table.shown_as(key.name, into.*member);
                 }
                 if ((into.*member).size() > most) {
                   table.reject(key.name, std::to_string((into.*member).size()) + " bytes long",
                                "at most " + std::to_string(most) + " bytes");
                 }
               });
  }
  /// Words in braces that stand for something in the shown text that was added last: "{time}".
  Schema& placeholders(std::vector<std::string> words) {
    return check([key = keys_.back().description.name, words = std::move(words)](Table& table, T&) {
      table.note_placeholders(key, words);
    });
  }
  /// One of some words, each of which stands for a value of the member.
  template <class E>
  Schema& choice(std::string name, E T::*member, std::vector<std::pair<std::string, E>> words,
                 std::string description) {
    return add(
        std::move(name), std::move(description),
        [member, words = std::move(words)](Table& table, const KeyDescription& key, T& into) {
          std::vector<std::string> allowed;
          std::string usual;
          for (const auto& [word, value] : words) {
            allowed.push_back(word);
            usual = value == into.*member && usual.empty() ? word : usual;
          }
          if (key.stands_in(table, usual)) {
            const std::string word = table.choice(key.name, allowed);
            for (const auto& [each, value] : words) {
              into.*member = each == word ? value : into.*member;
            }
          }
        });
  }
  Schema& texts(std::string name, std::vector<std::string> T::*member, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = table.texts(key.name);
                 }
               });
  }
  Schema& numbers(std::string name, std::vector<double> T::*member, const Bounds& bounds,
                  std::string unit, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = table.numbers(key.name, bounds, unit);
                 }
               });
  }
  /// Three numbers, x, y and z.
  Schema& vector(std::string name, Eigen::Vector3d T::*member, const Bounds& bounds,
                 std::string unit, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = read_vector(table, key.name, bounds, unit, into.*member);
                 }
               });
  }
  /// Three numbers of any length above 0, which the member keeps.
  Schema& any_direction(std::string name, Eigen::Vector3d T::*member, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = read_any_direction(table, key.name);
                 }
               });
  }
  /// A whole number that may be computed, as that of a random stream.
  Schema& seed(std::string name, std::uint64_t T::*member, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = read_seed(table, key.name);
                 }
               });
  }
  /// Three numbers from -1 to 1, made a direction of length 1.
  Schema& direction(std::string name, Eigen::Vector3d T::*member, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = read_direction(table, key.name);
                 }
               });
  }
  /// Bits of a list of whole numbers, as those of buttons.
  Schema& bits(std::string name, std::uint32_t T::*member, std::string description) {
    return add(std::move(name), std::move(description),
               [=](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   into.*member = read_bits(table, key.name);
                 }
               });
  }
  /// Keys of this same table that set a member's members.
  template <class U>
  Schema& keys_of(U T::*member, const Schema<U>& schema) {
    return check([member, &schema](Table& table, T& into) { schema.read(table, into.*member); });
  }
  /// A table within this one, whose keys another schema describes.
  template <class U>
  Schema& table(std::string name, U T::*member, const Schema<U>& schema, std::string description) {
    return add(std::move(name), std::move(description),
               [member, &schema](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   Table inner = table.table(key.name);
                   schema.read(inner, into.*member);
                 } else if (std::optional<Table> inner = table.left_out(key.name)) {
                   schema.note_tunable(*inner, into.*member);
                 }
               });
  }
  /// Likewise; nothing while the table is left out.
  template <class U>
  Schema& table(std::string name, std::optional<U> T::*member, const Schema<U>& schema,
                std::string description) {
    return add(std::move(name), std::move(description),
               [member, &schema](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   Table inner = table.table(key.name);
                   into.*member = schema.read(inner);
                 }
               });
  }
  /// A key with a form of its own. @param read  is called if the key stands there or is required
  Schema& custom(std::string name, std::string description,
                 std::function<void(Table& table, const std::string& key, T& into)> read) {
    return add(std::move(name), std::move(description),
               [read = std::move(read)](Table& table, const KeyDescription& key, T& into) {
                 if (key.stands_in(table)) {
                   read(table, key.name, into);
                 }
               });
  }
  /// Members that follow from the keys so far, such as defaults of the keys below.
  Schema& derive(std::function<void(T& value)> derive) {
    return check([derive = std::move(derive)](Table&, T& into) { derive(into); });
  }
  /// A check of keys together, which notes problems by Table::reject; it may also change the value.
  Schema& check(std::function<void(Table& table, T& value)> check) {
    return add({}, {}, [check = std::move(check)](Table& table, const KeyDescription&, T& into) {
      check(table, into);
    });
  }

  /// The key that was added last must be there.
  Schema& required() {
    keys_.back().description.required = true;
    return *this;
  }
  /// The key that was added last, a number, may be changed while a pilot runs.
  Schema& tunable() {
    keys_.back().description.tunable = true;
    return *this;
  }
  /// Words for lists of keys on the absence of the key that was added last: "none".
  Schema& otherwise(std::string words) {
    keys_.back().description.otherwise = std::move(words);
    return *this;
  }

  /// The key that was added last is read only if the members so far say so; elsewhere it is not
  /// known.
  Schema& only_if(std::function<bool(const T&)> applies) {
    keys_.back().applies = std::move(applies);
    return *this;
  }

  /// Problems are noted in the table.
  void read(Table& table, T& into) const {
    for (const Key& key : keys_) {
      if (!key.applies || key.applies(into)) {
        key.read_from(table, into);
      }
    }
  }
  /// Each key is read from `own` if it stands there, and else from `shared`; checks see `own`.
  void read(Table& own, Table& shared, T& into) const {
    for (const Key& key : keys_) {
      if (!key.applies || key.applies(into)) {
        const std::string& name = key.description.name;
        const bool here = name.empty() || own.has(name);
        if (here) {
          shared.pass_over(name);
        }
        key.read_from(here ? own : shared, into);
      }
    }
  }
  /// Notes the defaults of tunable keys. @param left_out  as Table::left_out() gives it
  void note_tunable(Table& left_out, T& defaults) const {
    for (const Key& key : keys_) {
      if (key.description.tunable) {
        key.read_from(left_out, defaults);
      }
    }
  }
  T read(Table& table) const {
    T value{};
    read(table, value);
    return value;
  }

 private:
  using Reader = std::function<void(Table&, const KeyDescription&, T&)>;
  struct Key {
    KeyDescription description;
    Reader read;
    std::function<bool(const T&)> applies;  // none: always

    void read_from(Table& table, T& into) const {
      if (!description.name.empty()) {
        table.describe(description);
      }
      read(table, description, into);
    }
  };
  Schema& add(std::string name, std::string description, Reader read) {
    keys_.push_back({{std::move(name), std::move(description), "", false}, std::move(read), {}});
    return *this;
  }

  std::vector<Key> keys_;
};

}  // namespace haptrial
