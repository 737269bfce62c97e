#include "analysis/exchange/columns.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/record/rows/device_rows.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"

namespace haptrial::exchange {
namespace {

std::vector<ColumnDoc> all_of(const record::TableSchema& schema) {
  std::vector<ColumnDoc> docs;
  for (const auto& column : schema.columns) {
    docs.push_back(doc_of(schema, column.name));
  }
  return docs;
}

std::vector<ColumnDoc> samples() {
  std::vector<ColumnDoc> docs = all_of(record::samples_table().schema());
  for (auto& doc : docs) {
    if (doc.name == "time_ns") {
      doc = {"time", "s", "as the clock had it, since the first tick of the session"};
    } else if (doc.name == "pass") {
      doc.description = "number of the pass from 0, as in the table of passes; -1 between passes";
    } else if (doc.name == "stage") {
      doc.description = "what the hand is going through within a pass";
      doc.levels = {{"0", "idle"},
                    {"1", "approach to the start of the trajectory"},
                    {"2", "wait there"},
                    {"3", "the run, the part that is scored"},
                    {"4", "return"}};
    } else if (doc.name == "saturated") {
      doc.levels = {{"0", "no"}, {"1", "the force limit was reached"}};
    }
  }
  return docs;
}

}  // namespace

ColumnDoc doc_of(const record::TableSchema& schema, std::string_view column) {
  for (const auto& each : schema.columns) {
    if (column == each.name) {
      const std::string unit = each.unit;
      const bool wide = column == "stimulus_seed";
      return {each.name, unit == "1" ? "" : unit,
              std::string(each.description) +
                  (wide ? "; 64 bits: to be read as text where numbers are doubles" : "")};
    }
  }
  throw std::invalid_argument(std::string("no column ") + std::string(column));
}

ColumnDoc phase_doc(const Levels& phases) {
  ColumnDoc doc = doc_of(record::trials_table().schema(), "phase");
  doc.levels = phases;
  return doc;
}

std::string heading(const std::vector<ColumnDoc>& docs, Delimited kind) {
  std::string text;
  RowText row(text, kind);
  for (const auto& doc : docs) {
    row.add(doc.name);
  }
  row.end();
  return text;
}

const std::vector<ColumnDoc>& sample_docs() {
  static const std::vector<ColumnDoc> docs = samples();
  return docs;
}

std::vector<ColumnDoc> sample_docs(std::size_t others) {
  std::vector<ColumnDoc> docs = sample_docs();
  for (std::size_t device = 1; device <= others; ++device) {
    for (ColumnDoc doc : all_of(record::table_of<record::DeviceRow>().schema())) {
      if (doc.name != "sequence" && doc.name != "device") {
        doc.name = fmt::format("device_{}_{}", device, doc.name);
        doc.description += fmt::format("; of device {}, counted from 0", device);
        docs.push_back(std::move(doc));
      }
    }
  }
  return docs;
}

const std::vector<ColumnDoc>& stimulus_docs() {
  static const std::vector<ColumnDoc> docs = all_of(record::stimuli_table().schema());
  return docs;
}

}  // namespace haptrial::exchange
