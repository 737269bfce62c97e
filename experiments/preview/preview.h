#pragma once

#include <cstdint>
#include <string>

#include "experiments/preview/preview_page.h"
#include "experiments/studies/experiment.h"
#include "protocols/interface/trials.h"
#include "protocols/psychophysics/preview/felt_forces.h"

namespace haptrial::experiments {

/// Choice of what a preview shows.
struct PreviewRequest {
  int trial{1};                // of the first session, practice included, from 1
  std::uint64_t seed{1};       // of the study
  bool virtual_trial{true};    // a virtual participant does the trial
  std::string language{};      // of headings and controls, "de"; empty: English
  protocols::FeltLook look{};  // where the forces of fields are drawn
};

/// The session that a preview looks at: the first of a participant. @param participant  from 0
protocols::SessionPlace previewed_session(std::uint64_t seed, int participant = 0);

// The parts of every experiment. Each adds a heading and what stands below it.

/// preview.objects in a view to be turned; nothing where there are none.
void add_objects(Preview& preview);
/// All parts that the experiment has, drawn.
/// @throws InputError for a trial beyond the session; RunError where a picture cannot be made
Preview preview_of(const Experiment& experiment, const PreviewRequest& request);

}  // namespace haptrial::experiments
