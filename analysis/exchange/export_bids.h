#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "analysis/exchange/export_sessions.h"

namespace haptrial::exchange {

struct BidsSummary {
  std::size_t subjects{0};
  std::size_t sessions{0};
  std::uint64_t samples{0};
  std::uint64_t missing{0};  // ticks without a sample, rows of "n/a"
  bool simulated{false};
};

/// Writes session files as a data set of the Brain Imaging Data Structure, version 1.11: events,
/// and every tick of the loop as a continuous recording under beh/ (docs/decisions/0007); the tip's
/// movement alone under motion/ if it is asked for. What
/// participants said in free text, and their consent, stays out.
/// @param folder  new or empty; it appears whole or not at all.
/// @throws InputError when there is no file, one is damaged, imported or given twice, the files are
/// of several experiments, or two subjects have the same letters and digits; RunError when the disk
/// is full.
BidsSummary export_bids(std::span<const std::filesystem::path> files,
                        const std::filesystem::path& folder, const DataSetOptions& options,
                        const Watch& watch);

}  // namespace haptrial::exchange
