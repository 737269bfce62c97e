#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "analysis/exchange/export_sessions.h"

namespace haptrial::exchange {

struct XdfSummary {
  std::size_t sessions{0};
  std::size_t streams{0};
  std::uint64_t samples{0};  // of devices
};

/// Writes each session as a file of the Extensible Data Format, SUBJECT.xdf: every tick of each
/// device, passes with what was presented and answered, events, and each channel, all on the
/// session's clock. Consent and free notes about participants stay out.
/// @param folder  new or empty; it appears whole or not at all.
/// @throws InputError when there is no file, one is damaged, imported or given twice; RunError when
/// the disk is full.
XdfSummary export_xdf(std::span<const std::filesystem::path> files,
                      const std::filesystem::path& folder, int jobs, const Watch& watch);

}  // namespace haptrial::exchange
