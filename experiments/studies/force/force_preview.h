#pragma once

#include "experiments/preview/preview.h"
#include "protocols/force_training/force_definition.h"

namespace haptrial::experiments {

/// The parts of a force training on the page that shows an experiment before anybody runs it.
/// @throws InputError for a trial beyond the session; RunError where a picture cannot be made
void add_force_preview(const protocols::ForceDefinition& definition, const PreviewRequest& request,
                       Preview& preview);

/// Stimuli, procedure and trials as planned of a force training, for a methods section.
void add_force_methods(const protocols::ForceDefinition& definition, std::uint64_t seed,
                       analysis::Document& document);

}  // namespace haptrial::experiments
