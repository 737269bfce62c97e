#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace haptrial::exchange {

/// The two kinds of table text.
enum class Delimited {
  kCsv,  // RFC 4180 with LF; what is missing is an empty field
  kTsv,  // as in BIDS: tabs, "n/a" for what is missing, no quotes; a tab within a text is a space
};

/// Appends rows to a text, field by field. Numbers are the shortest decimals that read back to the
/// same value; what is not a finite number is missing.
class RowText {
 public:
  RowText(std::string& text, Delimited kind) : text_(text), kind_(kind) {}

  RowText& add(std::string_view field);
  RowText& add(std::int64_t number);
  RowText& add(std::uint64_t number);
  RowText& add(int number) { return add(static_cast<std::int64_t>(number)); }
  RowText& add(double number);
  RowText& add(float number);
  /// A number of nanoseconds in seconds, exactly.
  RowText& add_seconds(std::int64_t nanoseconds);
  RowText& add_missing();
  void end();

 private:
  void next();
  template <class Real>
  RowText& add_real(Real number);
  std::string& text_;
  Delimited kind_;
  bool first_{true};
};

}  // namespace haptrial::exchange
