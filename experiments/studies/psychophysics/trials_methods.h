#pragma once

#include <cstdint>

#include "analysis/document/document.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::experiments {

/// Stimuli, levels and procedure of an experiment that a definition states whole, and its trials as
/// planned, for a methods section. @param seed  of the study
void add_trials_methods(const protocols::StudiedDefinition& definition, std::uint64_t seed,
                        analysis::Document& document);

}  // namespace haptrial::experiments
