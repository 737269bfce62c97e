#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/base/definition/expression.h"

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

}  // namespace haptrial::protocols
