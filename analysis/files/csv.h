#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::analysis {

/// A table of comma-separated values, checked as it is read, with the line of every row for the
/// sentences about it.
///
/// The separator is the tab, else the semicolon, else the comma, whichever the first row holds.
/// Lines end in LF, CRLF or CR; a field in quotes may hold anything, "" for a quote. A byte order
/// mark and lines starting with '#' before the first row are passed over; so are empty lines at the
/// end. The first row names the columns unless all of it is numbers; without names a column goes by
/// its number, from "1". Threads: any, for reading.
class CsvTable {
 public:
  /// @param file  "-" reads the standard input.
  /// @throws InputError when the file cannot be read, is larger than kLargest, is not text, holds
  ///   no rows, or a row is empty or has more or fewer fields than the first.
  static CsvTable load(const std::filesystem::path& file);
  /// @param name  stands in sentences in place of a file's.
  static CsvTable parse(std::string text, std::string name);

  const std::string& name() const { return name_; }
  std::size_t rows() const { return lines_.size(); }  // without the one that names the columns
  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t line(std::size_t row) const { return lines_[row]; }  // in the file, from 1

  bool has(std::string_view column) const;
  /// @returns its place. @throws InputError when no column or more than one has that name.
  std::size_t column(std::string_view name) const;

  /// The field without the blanks around it, unless they were quoted.
  std::string_view text(std::size_t row, std::size_t column) const;
  /// A whole column of finite numbers. The decimal mark is a point, or throughout a column a comma
  /// where commas do not separate.
  /// @throws InputError for anything else: empty, NaN, "1.5 N", a number too large; and as
  ///   refuse_thousands() does.
  std::vector<double> numbers(std::size_t column) const;
  /// The same for some of the rows, which alone decide about the decimal mark.
  std::vector<double> numbers(std::size_t column, const std::vector<std::size_t>& rows) const;

  /// @throws InputError where the marks of a column separate thousands: "1.304" beside "994", where
  /// every number with a mark has three digits behind it and no other reaches 1,000.
  void refuse_thousands(std::size_t column, const std::vector<std::size_t>& rows) const;

  /// @throws InputError  FILE:LINE: COLUMN is 'FOUND'; allowed: ALLOWED
  [[noreturn]] void refuse(std::size_t row, std::size_t column, std::string_view allowed) const;

  static constexpr std::size_t kLargest = std::size_t{1} << 28;  // bytes

 private:
  struct Field {
    std::uint32_t begin, length;  // in text_
  };
  class Parser;
  CsvTable(std::string text, std::string name);
  std::string_view view(Field field) const;

  std::string name_;
  std::string text_;
  char separator_{','};
  std::vector<std::string> columns_;
  std::vector<std::size_t> lines_;  // (rows)
  std::vector<Field> fields_;       // (rows x columns)
};

}  // namespace haptrial::analysis
