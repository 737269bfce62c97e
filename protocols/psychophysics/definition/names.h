#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/labels.h"
#include "core/base/definition/number_source.h"
#include "protocols/psychophysics/definition/variables.h"

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

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

}  // namespace haptrial::protocols
