#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/definition/expression.h"
#include "core/base/definition/number_source.h"
#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// The variables of a definition: each a number or a formula of others. What is given from outside
/// (the procedure's level, a factor of the block, the participant's data) stands before what the
/// definition states; a name may have both.
class Variables {
 public:
  /// @throws InputError if the name is taken
  void define(const std::string& name, Expression meaning);
  /// A name that may get its value from outside, as a defined one may; again: nothing happens.
  void declare(const std::string& name);
  bool knows(const std::string& name) const;
  /// All names, in alphabetical order.
  std::vector<std::string> names() const;

  /// @throws InputError naming a variable that nothing defines, or the circle that a formula is in
  void check(const Expression& expression) const;

  /// Values of declared names, until they are set anew or forgotten. @throws std::invalid_argument
  /// unless `name` is declared
  void set(const std::string& name, double value);
  void forget_given();
  /// All names that have a value, with it: given, or by a formula of others that have one.
  std::map<std::string, double> known() const;
  /// @throws InputError as check() does, if a declared name has no value yet, or if a value is not
  /// finite
  double value(const Expression& expression) const;
  double value(const std::string& name) const;
  /// Whether a value() has taken this name's value so far.
  bool was_read(const std::string& name) const { return read_.contains(name); }

 private:
  double value(const std::string& name, std::vector<std::string>& way) const;
  void check(const std::string& name, std::vector<std::string>& way) const;
  [[noreturn]] void refuse(const std::string& name) const;

  std::unordered_map<std::string, Expression> meanings_;
  std::unordered_map<std::string, double> given_;  // NaN: no value yet
  mutable std::unordered_set<std::string> read_;
};

/// Values of the names of a definition: its variables and places, and those of the trial at hand.
/// Fields, regions and stages take their numbers from here. Session's thread.
///
///     [variables]
///     jnd   = 0.08                                  # a number
///     side  = "rint($level) - 1"                    # a formula (expression.h)
///     field = "'curl'"                              # a word
///     b     = { from = "group", left = 13.0, right = -13.0 }   # by the word of another
///
///     [places]
///     start  = [0.0, 0.02, 0.0]                     # [m]
///     target = ["0.06 * cos($angle)", 0.0, "-0.06 * sin($angle)"]
class Names final : public NumberSource {
 public:
  /// Reads [variables] and [places], both of which may be left out. Problems are noted.
  void read(Table& root);
  /// A name whose value a trial may give; it stands before what [variables] says.
  void declare(const std::string& name) { variables_.declare(name); }
  /// @throws std::invalid_argument unless declared
  void set(const std::string& name, double value) { variables_.set(name, value); }
  void set(const std::string& name, const std::string& word) {
    variables_.set(name, labels_.number_of(word));
  }
  void forget_given() { variables_.forget_given(); }
  /// All names that have a value now, with it: given by the trial, or stated by [variables].
  std::map<std::string, double> known() const { return variables_.known(); }
  /// A number, or what a text says: the word itself in single quotes, or a formula's worth.
  /// @throws InputError saying what is wrong with it
  double value(const std::string& formula) const;
  /// The word that a text stands for: "$field" a variable's word, any other text itself.
  std::string word(const std::string& text) const;
  /// The word of a value; nothing if it is a number.
  std::optional<std::string> word_of(double value) const { return labels_.word_of(value); }
  double number_of(std::string_view word) { return labels_.number_of(word); }
  bool knows(const std::string& name) const { return variables_.knows(name); }
  /// Whether anything that was read so far depends on this name.
  bool was_read(const std::string& name) const { return variables_.was_read(name); }
  /// Names of [variables], in alphabetical order.
  const std::vector<std::string>& stated() const { return stated_; }
  /// @throws InputError naming a place that is not there
  Eigen::Vector3d place(const std::string& name) const;
  /// Names of [places], in alphabetical order.
  std::vector<std::string> places() const;
  bool has_place(const std::string& name) const { return places_.contains(name); }
  /// Notes formulas with unknown names or circles. Once everything is declared.
  void check(Table& root) const;

  std::optional<double> value_of(std::string_view text) const override;
  std::optional<Eigen::Vector3d> vector_of(std::string_view text) const override;

 private:
  void read_variable(Table& table, const std::string& name);
  void read_place(Table& table, const std::string& name);
  const Expression& formula(const std::string& text) const;

  mutable Labels labels_;
  Variables variables_;
  std::vector<std::string> stated_;
  std::map<std::string, std::vector<Expression>> places_;  // x, y, z [m]
  mutable std::map<std::string, Expression> formulas_;     // by text
};

/// Copies of the names of a definition for those who ask one after the other: a copy reads its
/// formulas once, not for every participant. Any thread.
class NamesPool {
 public:
  explicit NamesPool(Names original) : original_(std::move(original)) {}

  /// Nothing of it is given.
  std::unique_ptr<Names> take();
  void give_back(std::unique_ptr<Names> names);

 private:
  const Names original_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Names>> spare_;
};

}  // namespace haptrial::protocols
