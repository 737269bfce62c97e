#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "analysis/exchange/export_sessions.h"

namespace haptrial::exchange {

struct PsychDsSummary {
  std::size_t subjects{0};
  std::size_t sessions{0};
  std::size_t passes{0};
  bool simulated{false};
};

/// Writes session files as a data set of Psych-DS: a table of passes for each session, a table for
/// each questionnaire, and what their columns mean as JSON-LD. Samples, consent and free notes stay
/// out.
/// @param folder  new or empty; it appears whole or not at all.
/// @throws InputError as export_bids() does, but imported sessions are taken; RunError when the
/// disk is full.
PsychDsSummary export_psych_ds(std::span<const std::filesystem::path> files,
                               const std::filesystem::path& folder, const DataSetOptions& options);

}  // namespace haptrial::exchange
