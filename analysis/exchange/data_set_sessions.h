#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/exchange/bids_text.h"
#include "analysis/exchange/columns.h"
#include "analysis/exchange/export_sessions.h"

// Sessions of a data set of BIDS or Psych-DS; for the exports alone.
namespace haptrial::exchange {

class NewFolder;

/// The sessions of one study with the labels that they have in a data set, by subject and start.
/// @throws InputError when there is no file, one is damaged or given twice, the files are of
/// several experiments, or two subjects have the same letters and digits.
std::vector<bids::Session> data_set_sessions(std::span<const std::filesystem::path> files,
                                             const CompareDefinitions& compare);

/// Columns of what passes presented and what was answered, over all sessions.
std::vector<ColumnDoc> fact_columns(std::span<const bids::Session> sessions);

/// Writes every version of the definition that a session was recorded with, more than one where
/// texts, say, were changed. @param folder  of the data set
void write_definitions(const NewFolder& out, std::span<const bids::Session> sessions,
                       const std::string& folder);

}  // namespace haptrial::exchange
