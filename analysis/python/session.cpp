#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/python/arrays.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/session_tables.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::python {
namespace {

using record::ColumnType;
using record::SessionReader;
using record::TableDescription;
using Description = std::shared_ptr<const TableDescription>;

constexpr std::uint64_t kRowsAtOnce = 65536;  // of one piece of work: some 4 MB of /samples

py::dict info_of(const SessionReader& reader) {
  const record::SessionInfo& info = reader.info();
  const record::Participant& person = info.participant;
  py::dict result;
  result["path"] = reader.path().string();
  result["subject"] = info.subject;
  result["session"] = info.session;
  result["simulated"] = info.simulated;
  result["pilot"] = info.pilot;
  result["rate"] = info.rate;
  result["clock"] = info.clock;
  result["start_utc"] = info.start_utc;
  result["seed"] = info.seed;
  result["device"] = info.device;
  result["device_max_force"] = info.device_max_force;
  result["device_workspace_radius"] = info.device_workspace_radius;
  result["definition"] = info.definition;
  result["definition_name"] = info.definition_name;
  result["handedness"] = person.handedness;
  result["age_band"] = person.age_band;
  result["sex"] = person.sex;
  result["notes"] = person.notes;
  result["program_version"] = info.program_version;
  result["program_commit"] = info.program_commit;
  result["schema_version"] = reader.version();
  result["rows"] = reader.sample_count();
  return result;
}

/// A table by its name: one of ours, or as the file describes it.
Description description_of(const SessionReader& reader, const std::string& name) {
  for (const record::TableList* list : {&record::session_tables(), &record::common_tables()}) {
    for (const TableDescription* table : *list) {
      if (table->name() == name) {
        return {Description(), table};  // lives as long as the program
      }
    }
  }
  const std::vector<std::string> has = reader.table_names();
  if (std::find(has.begin(), has.end(), name) != has.end()) {
    return reader.description(name);
  }
  std::string names;
  for (const std::string& each : has) {
    names += (names.empty() ? "" : ", ") + each;
  }
  throw InputError(reader.path().string() + ": has no table '" + name + "'; allowed: " + names);
}

/// The table as the first file that has it describes it.
Description description_of(const std::vector<SessionReader>& readers, const std::string& name) {
  for (const SessionReader& reader : readers) {
    const std::vector<std::string> has = reader.table_names();
    if (std::find(has.begin(), has.end(), name) != has.end()) {
      return description_of(reader, name);
    }
  }
  return description_of(readers.front(), name);
}

py::dtype dtype_of(const record::Field& field) {
  switch (field.column.type) {
    case ColumnType::kI32:
      return py::dtype::of<std::int32_t>();
    case ColumnType::kI64:
      return py::dtype::of<std::int64_t>();
    case ColumnType::kU64:
      return py::dtype::of<std::uint64_t>();
    case ColumnType::kF32:
      return py::dtype::of<float>();
    case ColumnType::kF64:
      return py::dtype::of<double>();
    case ColumnType::kText:
      return py::dtype("S" + std::to_string(field.column.bytes));
    case ColumnType::kU8:
      break;
  }
  return field.member == record::MemberType::kBool ? py::dtype::of<bool>()
                                                   : py::dtype::of<std::uint8_t>();
}

/// The fields of a table that are asked for, all without names.
std::vector<std::size_t> fields_of(const TableDescription& table,
                                   const std::optional<std::vector<std::string>>& names) {
  std::vector<std::size_t> fields;
  std::string known;
  for (std::size_t i = 0; i < table.fields().size(); ++i) {
    known += std::string(i == 0 ? "" : ", ") + table.fields()[i].column.name;
    if (!names) {
      fields.push_back(i);
    }
  }
  for (const std::string& name : names.value_or(std::vector<std::string>{})) {
    const auto at =
        std::find_if(table.fields().begin(), table.fields().end(),
                     [&](const record::Field& field) { return name == field.column.name; });
    if (at == table.fields().end()) {
      throw InputError("/" + table.name() + " has no column '" + name + "'; allowed: " + known);
    }
    fields.push_back(static_cast<std::size_t>(at - table.fields().begin()));
  }
  return fields;
}

/// Rows of one file, and where they go.
struct Piece {
  std::size_t file;
  std::uint64_t first, count;
  std::uint64_t to;
};

/// A table of several files, one after the other, as arrays of Python.
class TableRead {
 public:
  /// Construct with Python's lock, which is let go while files are read.
  TableRead(const std::vector<std::string>& paths, const std::string& name,
            const std::optional<std::vector<std::string>>& columns, int threads)
      : threads_(threads_or_all(threads)) {
    const py::gil_scoped_release release;
    for (const std::string& path : paths) {
      readers_.emplace_back(path);
    }
    table_ = description_of(readers_, name);
    fields_ = fields_of(*table_, columns);
  }

  py::dict read(std::uint64_t first, std::optional<std::uint64_t> count) {
    const std::vector<Piece> pieces = pieces_of(first, count);
    std::vector<record::ColumnTarget> targets;
    py::list columns;
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows_)};
    for (const std::size_t field : fields_) {
      py::array values(dtype_of(table_->fields()[field]), shape);
      targets.push_back({field, static_cast<std::uint8_t*>(values.mutable_data())});
      columns.append(described(table_->fields()[field], std::move(values)));
    }
    {
      const py::gil_scoped_release release;
      parallel_for(pieces.size(), threads_, [&](std::size_t i) { read(pieces[i], targets); });
      readers_.clear();
    }
    py::dict result;
    result["description"] = table_->schema().description;
    result["counts"] = counts_;
    result["columns"] = columns;
    return result;
  }

 private:
  std::vector<Piece> pieces_of(std::uint64_t first, std::optional<std::uint64_t> count) {
    const std::uint64_t chunk = readers_.front().chunk_rows();
    const std::uint64_t step = std::max(chunk, kRowsAtOnce / chunk * chunk);
    std::vector<Piece> pieces;
    for (std::size_t file = 0; file < readers_.size(); ++file) {
      const std::uint64_t all = readers_[file].count(*table_);
      const std::uint64_t from = std::min(first, all);
      const std::uint64_t end = from + std::min(count.value_or(all), all - from);
      for (std::uint64_t row = from; row < end;) {
        const std::uint64_t next = std::min(end, row - row % step + step);
        pieces.push_back({file, row, next - row, rows_ + row - from});
        row = next;
      }
      counts_.push_back(end - from);
      rows_ += end - from;
    }
    return pieces;
  }

  void read(const Piece& piece, std::vector<record::ColumnTarget> targets) const {
    for (record::ColumnTarget& target : targets) {
      target.values += piece.to * table_->fields()[target.field].column.bytes;
    }
    readers_[piece.file].columns(*table_, piece.first, piece.count, targets);
    for (const record::ColumnTarget& target : targets) {
      const std::string_view column = table_->fields()[target.field].column.name;
      if (table_->name() == "trials" && column == "status") {
        take_back(piece, table_->fields()[target.field].column.bytes, target.values);
      }
    }
  }

  /// A pass whose answer the experimenter took back counts as aborted, as SessionReader has it.
  /// @param bytes  of each status, a word
  void take_back(const Piece& piece, std::size_t bytes, std::uint8_t* status) const {
    constexpr std::string_view kAborted = "aborted";
    for (const record::TakenBackRow& row : readers_[piece.file].rows<record::TakenBackRow>()) {
      const auto pass = static_cast<std::uint64_t>(row.pass);
      if (pass >= piece.first && pass < piece.first + piece.count && bytes >= kAborted.size()) {
        std::uint8_t* word = status + (pass - piece.first) * bytes;
        std::fill_n(word, bytes, std::uint8_t{0});
        std::ranges::copy(kAborted, word);
      }
    }
  }

  py::dict described(const record::Field& field, py::array values) const {
    py::dict column;
    column["name"] = field.column.name;
    column["unit"] = field.column.unit;
    column["description"] = field.column.description;
    py::dict words;
    for (const record::EnumText::Entry& entry : field.words.entries()) {
      words[py::int_(entry.value)] = entry.word;
    }
    column["words"] = words;
    column["values"] = std::move(values);
    return column;
  }

  int threads_;
  std::vector<SessionReader> readers_;
  Description table_;
  std::vector<std::size_t> fields_;
  std::vector<std::uint64_t> counts_;  // rows of each file
  std::uint64_t rows_{0};
};

}  // namespace

void bind_session(py::module_& module) {
  module.def(
      "info",
      [](const std::string& path) {
        std::optional<SessionReader> reader;
        {
          const py::gil_scoped_release release;
          reader.emplace(path);
        }
        return info_of(*reader);
      },
      py::arg("path"));
  module.def(
      "tables",
      [](const std::string& path) {
        const py::gil_scoped_release release;
        return SessionReader(path).table_names();
      },
      py::arg("path"));
  module.def(
      "read",
      [](const std::vector<std::string>& paths, const std::string& table,
         const std::optional<std::vector<std::string>>& columns, std::uint64_t first,
         std::optional<std::uint64_t> count,
         int threads) { return TableRead(paths, table, columns, threads).read(first, count); },
      py::arg("paths"), py::arg("table"), py::arg("columns"), py::arg("first"), py::arg("count"),
      py::arg("threads"));
}

}  // namespace haptrial::python
