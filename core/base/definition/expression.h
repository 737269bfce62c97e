#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

/// The words of a definition, each with a number: formulas compute with numbers only. A word gets
/// its number when it is first named.
class Labels {
 public:
  double number_of(std::string_view word);
  /// The word of a number; nothing if there is none.
  std::optional<std::string> word_of(double number) const;

 private:
  std::vector<std::string> words_;
};

/// A number of a definition: a constant, or a formula of variables such as
///
///     "$standard - conflict / 2"        "modality != 'visual' and level > 300"
///
/// Names begin with a letter, an underscore or $, which is left out, and may hold dots. Operators:
/// + - * / ^, comparisons, and, or, not(), a ? b : c. Functions: abs, sqrt, exp, ln, log10, log2,
/// sin, cos, tan, asin, acos, atan, atan2, min, max, sum, rint, between(x, low, high), normcdf(z).
/// Words stand in single quotes. Parser: muParser. Session's thread, never the servo thread: values
/// are taken between trials.
class Expression {
 public:
  explicit Expression(double constant);
  /// @param labels  gets the words of the formula; need not outlive it
  /// @throws InputError saying what is wrong with the formula, and where
  Expression(const std::string& text, Labels& labels);
  Expression(const Expression&);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression) noexcept;
  ~Expression();

  const std::string& text() const { return text_; }
  /// The variables of the formula in alphabetical order, without $; none of a constant.
  std::vector<std::string> names() const;
  /// @param value_of  of a variable; called once for each of names()
  /// @throws InputError if the result is not finite
  double value(const std::function<double(const std::string& name)>& value_of) const;
  /// The same, faster. @param values  of the variables, in the order of names()
  double value_at(std::span<const double> values) const;

 private:
  double evaluated() const;
  struct Formula;
  std::string text_;
  std::unique_ptr<Formula> formula_;  // null: a constant
  double constant_{0.0};
};

}  // namespace haptrial
