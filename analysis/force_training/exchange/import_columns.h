#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/files/csv.h"

namespace haptrial::exchange {

/// The columns that an import reads, each by the name that it has in the tables: its own unless
/// given another.
class ImportColumns {
 public:
  ImportColumns() = default;
  /// @param given  "subject=Participant" each.
  /// @throws InputError for a column that no import reads, one that is given twice, or another
  /// form.
  explicit ImportColumns(const std::vector<std::string>& given);

  /// Name that was given to the column; empty if none was.
  const std::string& given(const std::string& column) const;
  std::string name(const std::string& column) const;
  /// Whether the table has it; a column whose name was given is always looked for.
  bool has(const analysis::CsvTable& table, const std::string& column) const;
  /// @returns its place. @throws InputError when the table has no such column.
  std::size_t place(const analysis::CsvTable& table, const std::string& column) const;

 private:
  std::map<std::string, std::string> names_;
};

/// All columns that an import reads.
const std::vector<std::string>& import_columns();

}  // namespace haptrial::exchange
