#include "analysis/files/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <iterator>
#include <numeric>
#include <optional>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/nearest.h"
#include "core/base/utf8.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;

/// Text of the file, on one line and short enough for a sentence.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result(cut_text(text, kLongest));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
      c = ' ';
    }
  }
  return result.size() < text.size() ? result + "..." : result;
}

std::optional<double> number(std::string_view text) {
  if (text.starts_with('+') && text.size() > 1 && text[1] != '-' && text[1] != '+') {
    text.remove_prefix(1);
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

std::optional<double> number(std::string_view text, char decimal_mark) {
  if (decimal_mark == '.') {
    return number(text);
  }
  if (text.find('.') != text.npos) {
    return std::nullopt;
  }
  std::string copy(text);
  std::replace(copy.begin(), copy.end(), decimal_mark, '.');
  return number(copy);
}

/// A number, or what stands for one that is missing: such a row names no columns.
bool is_like_a_number(std::string_view text, char separator) {
  if (text.empty() || text == "NA" || text == "n/a" || number(text)) {
    return true;
  }
  return separator != ',' && number(text, ',');
}

bool is_digits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// How a number would be written with a separator of thousands.
enum class Thousands : std::uint8_t { kSeparated, kHundreds, kBelow, kOther };

Thousands thousands_of(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    text.remove_prefix(1);
  }
  const std::size_t at = text.find_first_of(".,");
  const std::string_view whole = text.substr(0, at);
  if (!is_digits(whole) || whole.size() > 3) {
    return Thousands::kOther;
  }
  if (at == std::string_view::npos) {
    return whole.size() == 3 && whole.front() != '0' ? Thousands::kHundreds : Thousands::kBelow;
  }
  const std::string_view behind = text.substr(at + 1);
  return whole.front() != '0' && behind.size() == 3 && is_digits(behind) ? Thousands::kSeparated
                                                                         : Thousands::kOther;
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }

}  // namespace

/// Cuts the text into fields; quoted ones are unquoted where they stand.
class CsvTable::Parser {
 public:
  explicit Parser(CsvTable& table) : table_(table), text_(table.text_) {}

  void run() {
    skip_preamble();
    table_.separator_ = separator_of_first_row();
    std::vector<Field> row;
    std::size_t width = 0;
    while (at_ < text_.size()) {
      const std::size_t line = line_;
      const std::size_t start = at_;
      read_row(row);
      if (row.size() == 1 && row[0].length == 0 && !quoted_) {
        require_end(line, start);
        break;
      }
      if (width == 0) {
        width = row.size();
        first_line_ = line;
        if (take_names(row)) {
          continue;
        }
      }
      if (row.size() != width) {
        fail(line, fmt::format("the row has {} fields; allowed: {}, as in line {}", row.size(),
                               width, first_line_));
      }
      table_.lines_.push_back(line);
      table_.fields_.insert(table_.fields_.end(), row.begin(), row.end());
    }
  }

 private:
  [[noreturn]] void fail(std::size_t line, std::string_view what) const {
    throw InputError(fmt::format("{}:{}: {}", table_.name_, line, what));
  }

  bool at_line_end() const {
    return at_ == text_.size() || text_[at_] == '\n' || text_[at_] == '\r';
  }

  void pass_line_end() {
    if (at_ == text_.size()) {
      return;
    }
    const bool pair = text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n';
    at_ += pair ? 2 : 1;
    ++line_;
  }

  void skip_preamble() {
    if (text_.starts_with("\xef\xbb\xbf")) {
      at_ = 3;
    }
    while (at_ < text_.size() && (text_[at_] == '#' || at_line_end())) {
      while (!at_line_end()) {
        ++at_;
      }
      pass_line_end();
    }
  }

  char separator_of_first_row() const {
    bool inside = false, semicolon = false;
    for (std::size_t k = at_; k < text_.size(); ++k) {
      const char c = text_[k];
      if (c == '"') {
        inside = !inside;
      }
      if (inside) {
        continue;
      }
      if (c == '\n' || c == '\r') {
        break;
      }
      if (c == '\t') {
        return '\t';
      }
      semicolon = semicolon || c == ';';
    }
    return semicolon ? ';' : ',';
  }

  void read_row(std::vector<Field>& row) {
    row.clear();
    quoted_ = false;
    for (;;) {
      row.push_back(read_field());
      if (at_line_end()) {
        break;
      }
      ++at_;  // the separator
    }
    pass_line_end();
  }

  Field read_field() {
    const char separator = table_.separator_;
    while (!at_line_end() && text_[at_] != separator && is_blank(text_[at_])) {
      ++at_;
    }
    if (at_ < text_.size() && text_[at_] == '"') {
      return read_quoted();
    }
    const std::size_t begin = at_;
    while (!at_line_end() && text_[at_] != separator) {
      ++at_;
    }
    std::size_t end = at_;
    while (end > begin && is_blank(text_[end - 1])) {
      --end;
    }
    return field(begin, end);
  }

  Field read_quoted() {
    const std::size_t line = line_;
    const std::size_t begin = ++at_;
    std::size_t out = begin;
    quoted_ = true;
    for (;; ++at_) {
      if (at_ == text_.size()) {
        fail(line, "a quote is opened and never closed; close it");
      }
      if (text_[at_] == '"') {
        if (at_ + 1 == text_.size() || text_[at_ + 1] != '"') {
          break;
        }
        ++at_;
      }
      line_ += text_[at_] == '\n' ? 1 : 0;
      text_[out++] = text_[at_];
    }
    ++at_;  // the closing quote
    while (!at_line_end() && text_[at_] != table_.separator_) {
      if (!is_blank(text_[at_])) {
        fail(line_, "text follows a closing quote; allowed: a separator or the end of the line");
      }
      ++at_;
    }
    return field(begin, out);
  }

  static Field field(std::size_t begin, std::size_t end) {
    return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)};
  }

  /// The first row: true when it names the columns.
  bool take_names(const std::vector<Field>& row) {
    const bool numbers = std::all_of(row.begin(), row.end(), [&](Field f) {
      return is_like_a_number(table_.view(f), table_.separator_);
    });
    for (std::size_t k = 0; k < row.size(); ++k) {
      table_.columns_.push_back(numbers ? std::to_string(k + 1) : std::string(table_.view(row[k])));
    }
    return !numbers;
  }

  /// An empty line among rows could be a sample that is missing.
  void require_end(std::size_t line, std::size_t start) const {
    if (text_.find_first_not_of(" \t\r\n", start) != text_.npos) {
      fail(line, "the line is empty; delete it");
    }
  }

  CsvTable& table_;
  std::string& text_;
  std::size_t at_{0}, line_{1}, first_line_{1};
  bool quoted_{false};  // the row holds a quoted field
};

CsvTable::CsvTable(std::string text, std::string name)
    : name_(std::move(name)), text_(std::move(text)) {
  if (text_.size() > kLargest) {
    throw InputError(
        fmt::format("{}: has more than {} bytes; allowed: at most that many", name_, kLargest));
  }
  if (text_.find('\0') != text_.npos) {
    throw InputError(fmt::format(
        "{}: holds zero bytes, so it is not text; save it as comma-separated values in UTF-8",
        name_));
  }
  Parser(*this).run();
  if (lines_.empty()) {
    throw InputError(fmt::format("{}: holds no rows of values; allowed: at least one", name_));
  }
}

CsvTable CsvTable::parse(std::string text, std::string name) {
  return CsvTable(std::move(text), std::move(name));
}

CsvTable CsvTable::load(const fs::path& file) {
  if (file == "-") {
    return parse({std::istreambuf_iterator<char>(std::cin), {}}, "standard input");
  }
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) {
    throw InputError(
        fmt::format("{}: no such file; give a file of comma-separated values", file.string()));
  }
  if (fs::is_directory(status)) {
    throw InputError(
        fmt::format("{}: is a directory; give a file of comma-separated values", file.string()));
  }
  if (fs::is_regular_file(status) && fs::file_size(file, error) > kLargest) {
    throw InputError(fmt::format("{}: has more than {} bytes; allowed: at most that many",
                                 file.string(), kLargest));
  }
  return parse(file_text(file), file.string());
}

std::string_view CsvTable::view(Field field) const {
  return std::string_view(text_).substr(field.begin, field.length);
}

bool CsvTable::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t CsvTable::column(std::string_view name) const {
  const auto count = std::count(columns_.begin(), columns_.end(), name);
  if (count != 1) {
    std::vector<std::string> known;
    for (const std::string& column : columns_) {
      known.push_back(shown(column));
    }
    const std::string hint = count == 0 ? did_you_mean(shown(name), known) : "";
    throw InputError(
        fmt::format("{}: {} '{}'{} allowed: {}{}", name_,
                    count == 0 ? "there is no column" : "several columns are named", shown(name),
                    hint.empty() ? ";" : hint, fmt::join(known, ", "),
                    is_utf8(text_) ? "" : "; the file is not UTF-8, save it as UTF-8"));
  }
  return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), name) -
                                  columns_.begin());
}

std::string_view CsvTable::text(std::size_t row, std::size_t column) const {
  return view(fields_[row * columns_.size() + column]);
}

std::vector<double> CsvTable::numbers(std::size_t column) const {
  std::vector<std::size_t> all(rows());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return numbers(column, all);
}

std::vector<double> CsvTable::numbers(std::size_t column,
                                      const std::vector<std::size_t>& rows) const {
  char mark = '.';
  if (separator_ != ',') {
    for (const std::size_t row : rows) {
      const auto at = text(row, column).find_first_of(".,");
      if (at != std::string_view::npos) {
        mark = text(row, column)[at];
        break;
      }
    }
  }
  refuse_thousands(column, rows);
  std::vector<double> values;
  values.reserve(rows.size());
  for (const std::size_t row : rows) {
    const auto value = number(text(row, column), mark);
    if (!value || !std::isfinite(*value)) {
      refuse(row, column, mark == '.' ? "a finite number" : "a finite number with a decimal comma");
    }
    values.push_back(*value);
  }
  return values;
}

void CsvTable::refuse_thousands(std::size_t column, const std::vector<std::size_t>& rows) const {
  std::optional<std::size_t> separated;
  bool hundreds = false;
  for (const std::size_t row : rows) {
    switch (thousands_of(text(row, column))) {
      case Thousands::kSeparated:
        separated = separated.value_or(row);
        break;
      case Thousands::kHundreds:
        hundreds = true;
        break;
      case Thousands::kBelow:
        break;
      case Thousands::kOther:
        return;
    }
  }
  if (separated && hundreds) {
    refuse(*separated, column,
           "a number without a separator of thousands, which its mark is beside whole numbers of "
           "three digits; a fraction is written with all its digits, 994.000");
  }
}

void CsvTable::refuse(std::size_t row, std::size_t column, std::string_view allowed) const {
  throw InputError(fmt::format("{}:{}: {} is '{}'; allowed: {}", name_, line(row),
                               shown(columns_[column]), shown(text(row, column)), allowed));
}

}  // namespace haptrial::analysis
