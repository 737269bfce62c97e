#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/files/delimited.h"

namespace haptrial::record {
struct TableSchema;
}

namespace haptrial::exchange {

using Levels = std::vector<std::pair<std::string, std::string>>;  // value, meaning

/// Meaning of a column of an exported table.
struct ColumnDoc {
  std::string name;
  std::string unit;  // "" for a text or a pure number
  std::string description;
  Levels levels{};
};

/// The column of that name as the session file describes it.
/// @throws std::invalid_argument when the schema has none.
ColumnDoc doc_of(const record::TableSchema& schema, std::string_view column);

/// The phase of a pass. @param phases  that protocols have, each with its meaning
ColumnDoc phase_doc(const Levels& phases);

/// The names as the heading of a table.
std::string heading(const std::vector<ColumnDoc>& docs, Delimited kind);

/// Columns of the exported samples: those of /samples with the time in seconds.
const std::vector<ColumnDoc>& sample_docs();
/// The same, and behind them those of every further device, "device_1_position_x".
/// @param others  devices after the first
std::vector<ColumnDoc> sample_docs(std::size_t others);
/// Columns of the exported stimuli.
const std::vector<ColumnDoc>& stimulus_docs();

}  // namespace haptrial::exchange
