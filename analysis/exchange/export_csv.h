#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/exchange/export_sessions.h"
#include "core/record/table/table_description.h"

namespace haptrial::exchange {

struct CsvOptions {
  bool samples{false};  // also every tick and every stimulus, a .csv.gz for each session
  std::vector<std::pair<std::string, std::string>> phases{};  // of protocols, with meanings
  record::TableList tables{};  // that sessions may have beside those of every session
  int jobs{1};
};

struct CsvSummary {
  std::size_t sessions{0};
  std::size_t passes{0};
  std::uint64_t samples{0};  // written
};

/// Writes session files as tidy tables: sessions.csv, trials.csv (a row for each pass), events.csv,
/// a table for each of `tables` that has rows for passes (responses.csv, levels.csv, ...) and
/// answers.csv of pages, and what each column of them and of scores.csv means in dictionary.json.
/// @param folder  new or empty; it appears whole or not at all.
/// @throws InputError when there is no file, or one is damaged or given twice; RunError when the
/// disk is full.
CsvSummary export_csv(std::span<const std::filesystem::path> files,
                      const std::filesystem::path& folder, const CsvOptions& options,
                      const Watch& watch);

}  // namespace haptrial::exchange
