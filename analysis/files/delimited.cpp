#include "analysis/files/delimited.h"

#include <array>
#include <charconv>
#include <cmath>

namespace haptrial::exchange {
namespace {

// Appends a number without an exponent. The buffer is longer than the longest of the numbers that
// sessions hold, and than 64 bits.
template <class Number, class... Format>
void append_number(std::string& text, Number number, Format... format) {
  std::array<char, 400> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, format...).ptr;
  text.append(buffer.data(), end);
}

}  // namespace

void RowText::next() {
  if (!first_) {
    text_ += kind_ == Delimited::kCsv ? ',' : '\t';
  }
  first_ = false;
}

RowText& RowText::add(std::string_view field) {
  if (field.empty()) {
    return add_missing();
  }
  next();
  if (kind_ == Delimited::kTsv) {
    for (const char c : field) {
      text_ += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return *this;
  }
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
    text_ += field;
    return *this;
  }
  text_ += '"';
  for (const char c : field) {
    text_.append(c == '"' ? 2 : 1, c);
  }
  text_ += '"';
  return *this;
}

RowText& RowText::add(std::int64_t number) {
  next();
  append_number(text_, number);
  return *this;
}

RowText& RowText::add(std::uint64_t number) {
  next();
  append_number(text_, number);
  return *this;
}

template <class Real>
RowText& RowText::add_real(Real number) {
  if (!std::isfinite(number)) {
    return add_missing();
  }
  next();
  append_number(text_, number, std::chars_format::fixed);
  return *this;
}

RowText& RowText::add(double number) { return add_real(number); }

RowText& RowText::add(float number) { return add_real(number); }

RowText& RowText::add_seconds(std::int64_t nanoseconds) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  next();
  if (nanoseconds < 0) {
    text_ += '-';
  }
  const std::int64_t whole = nanoseconds / kSecond;
  append_number(text_, whole < 0 ? -whole : whole);
  std::int64_t rest = nanoseconds % kSecond;
  rest = rest < 0 ? -rest : rest;
  if (rest > 0) {
    std::array<char, 9> digits;
    std::size_t last = 0;
    for (std::size_t i = digits.size(); i-- > 0; rest /= 10) {
      digits[i] = static_cast<char>('0' + rest % 10);
      last = last == 0 && digits[i] != '0' ? i + 1 : last;
    }
    text_ += '.';
    text_.append(digits.data(), last);
  }
  return *this;
}

RowText& RowText::add_missing() {
  next();
  if (kind_ == Delimited::kTsv) {
    text_ += "n/a";
  }
  return *this;
}

void RowText::end() {
  text_ += '\n';
  first_ = true;
}

}  // namespace haptrial::exchange
