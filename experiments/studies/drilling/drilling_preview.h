#pragma once

#include <memory>
#include <vector>

#include "experiments/preview/preview.h"
#include "experiments/preview/space_objects.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/placement_legend.h"

namespace haptrial::experiments {

/// The procedure that is shown. @throws InputError for a number beyond the session
protocols::PlannedTrial procedure_of(const protocols::BoneDefinition& definition,
                                     const PreviewRequest& request);
/// The place in definition.bones of that procedure's bone.
std::size_t bone_of(const protocols::BoneDefinition& definition,
                    const protocols::PlannedTrial& trial);

/// The parts of a drilling on the page that shows an experiment before anybody runs it.
/// @throws InputError for a trial beyond the session; RunError where a picture cannot be made
void add_drilling_preview(const protocols::BoneDefinition& definition,
                          const PreviewRequest& request, Preview& preview);

/// Stimuli, procedure and trials as planned of a study of drillings, for a methods section.
/// @param definition  its bones need not be loaded
void add_drilling_methods(const protocols::BoneDefinition& definition, std::uint64_t seed,
                          analysis::Document& document);

/// The bone and each of its structures as lines where a hand feels them, in W. Made when it is
/// first asked for; takes a second for a large bone.
/// @param scale  from lengths of the bone to those of the hand
std::shared_ptr<const std::vector<SpaceObject>> objects_of(const protocols::PlacedBone& bone,
                                                           double scale);

}  // namespace haptrial::experiments
