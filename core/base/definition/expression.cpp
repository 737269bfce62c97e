#include "core/base/definition/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include "core/base/error.h"

namespace haptrial {
namespace {

// Numbers of words lie where no quantity of an experiment does, so that a word never equals one.
constexpr double kFirstWord = 1e12;

}  // namespace

double Labels::number_of(std::string_view word) {
  const auto found = std::ranges::find(words_, word);
  const auto place = found - words_.begin();
  if (found == words_.end()) {
    words_.emplace_back(word);
  }
  return kFirstWord + static_cast<double>(place);
}

std::optional<std::string> Labels::word_of(double number) const {
  const double place = number - kFirstWord;
  if (!(place >= 0.0 && place < static_cast<double>(words_.size()))) {
    return std::nullopt;
  }
  return words_[static_cast<std::size_t>(place)];
}

namespace {

constexpr const char* kNameCharacters =
    "0123456789_ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz.";

double both(double a, double b) { return a != 0.0 && b != 0.0 ? 1.0 : 0.0; }
double either(double a, double b) { return a != 0.0 || b != 0.0 ? 1.0 : 0.0; }
double negated(double a) { return a == 0.0 ? 1.0 : 0.0; }
double lies_between(double x, double low, double high) { return x >= low && x <= high ? 1.0 : 0.0; }

/// The share of a standard normal distribution below z.
double normal_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// The formula as muParser takes it: words become numbers, $ goes.
/// @throws InputError for a word without its closing quote
std::string plain(const std::string& text, Labels& labels) {
  std::string result;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '$') {
      continue;
    }
    if (text[at] != '\'') {
      result += text[at];
      continue;
    }
    const std::size_t end = text.find('\'', at + 1);
    if (end == std::string::npos) {
      throw InputError(fmt::format("\"{}\" has a word without its closing '", text));
    }
    result += fmt::format("{}", labels.number_of(text.substr(at + 1, end - at - 1)));
    at = end;
  }
  return result;
}

std::string trouble_of(const std::string& text, const mu::ParserError& error) {
  switch (error.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
      return fmt::format("\"{}\" ends too early", text);
    case mu::ecMISSING_PARENS:
    case mu::ecUNEXPECTED_PARENS:
      return fmt::format("\"{}\" has parentheses that do not match", text);
    case mu::ecTOO_MANY_PARAMS:
    case mu::ecTOO_FEW_PARAMS:
      return fmt::format("\"{}\" gives a function another number of values than it takes", text);
    case mu::ecEMPTY_EXPRESSION:
      return "an empty text is no formula";
    default:
      return fmt::format("\"{}\" cannot be read at '{}'", text, error.GetToken());
  }
}

}  // namespace

struct Expression::Formula {
  explicit Formula(std::string plain_text) : text(std::move(plain_text)) {
    parser.DefineNameChars(kNameCharacters);
    parser.SetDecSep('.');
    parser.SetThousandsSep(0);
    parser.SetVarFactory(&Formula::storage, this);
    parser.DefineOprt("and", both, mu::prLAND);
    parser.DefineOprt("or", either, mu::prLOR);
    parser.DefineFun("not", negated);
    parser.DefineFun("between", lies_between);
    parser.DefineFun("normcdf", normal_below);
    parser.SetExpr(text);
    parser.Eval();  // every variable 1: finds what is wrong with the form
  }
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;

  static double* storage(const char* name, void* self) {
    return &static_cast<Formula*>(self)->values.try_emplace(name, 1.0).first->second;
  }

  /// muParser keeps its decimal point in a static locale that every parser sets as it is made and
  /// read with, so formulas are made one at a time.
  static std::unique_ptr<Formula> make(std::string plain_text) {
    static std::mutex one_at_a_time;
    const std::lock_guard hold(one_at_a_time);
    return std::make_unique<Formula>(std::move(plain_text));
  }

  std::string text;
  std::map<std::string, double> values;  // whose addresses the parser keeps
  mu::Parser parser;
};

Expression::Expression(double constant) : text_(fmt::format("{}", constant)), constant_(constant) {}

Expression::Expression(const std::string& text, Labels& labels) : text_(text) {
  try {
    formula_ = Formula::make(plain(text, labels));
  } catch (const mu::ParserError& error) {
    throw InputError(trouble_of(text, error));
  }
}

Expression::Expression(const Expression& other)
    : text_(other.text_),
      formula_(other.formula_ ? Formula::make(other.formula_->text) : nullptr),
      constant_(other.constant_) {}

Expression::Expression(Expression&&) noexcept = default;
Expression::~Expression() = default;

Expression& Expression::operator=(Expression other) noexcept {
  std::swap(text_, other.text_);
  std::swap(formula_, other.formula_);
  std::swap(constant_, other.constant_);
  return *this;
}

std::vector<std::string> Expression::names() const {
  std::vector<std::string> names;
  if (formula_) {
    for (const auto& [name, value] : formula_->values) {
      names.push_back(name);
    }
  }
  return names;
}

double Expression::value(const std::function<double(const std::string&)>& value_of) const {
  if (!formula_) {
    return constant_;
  }
  for (auto& [name, value] : formula_->values) {
    value = value_of(name);
  }
  return evaluated();
}

double Expression::value_at(std::span<const double> values) const {
  if (!formula_) {
    return constant_;
  }
  std::size_t i = 0;
  for (auto& [name, value] : formula_->values) {
    value = values[i++];
  }
  return evaluated();
}

double Expression::evaluated() const {
  double result = std::nan("");
  try {
    result = formula_->parser.Eval();
  } catch (const mu::ParserError& error) {
    throw InputError(trouble_of(text_, error));
  }
  if (!std::isfinite(result)) {
    throw InputError(fmt::format("\"{}\" is {}; allowed: a finite number", text_, result));
  }
  return result;
}

}  // namespace haptrial
