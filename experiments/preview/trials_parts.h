#pragma once

#include <string>
#include <vector>

#include "experiments/preview/preview.h"
#include "experiments/preview/preview_page.h"
#include "protocols/definition/definition.h"
#include "protocols/psychophysics/preview/felt_forces.h"
#include "protocols/psychophysics/preview/planned_trials.h"
#include "protocols/psychophysics/preview/previewed_trial.h"
#include "protocols/psychophysics/preview/seen_stages.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::experiments {

// The parts of an experiment that a definition states whole (protocol "trials"), from the data that
// protocols/psychophysics/preview computes. Each adds a heading and what stands below it.

void add_timeline(const protocols::TrialsDefinition& definition,
                  const protocols::PreviewedTrial& trial, Preview& preview);
void add_seen(const protocols::PreviewedTrial& trial, const std::vector<protocols::SeenStage>& seen,
              Preview& preview);
/// With what the handle carries of the trial's forces (HandleReport).
void add_felt(const protocols::TrialsDefinition& definition, const protocols::PreviewedTrial& trial,
              const std::vector<protocols::FeltStage>& stages, Preview& preview);
void add_planned(const protocols::TrialsDefinition& definition,
                 const protocols::PlannedTrials& planned, analysis::Document& document);
/// The stages of a trial with what ends, moves and shows them, as a table.
void add_stage_table(const protocols::PreviewedTrial& trial, analysis::Document& document);

/// All of them.
void add_trials_parts(const protocols::StudiedDefinition& definition, const PreviewRequest& request,
                      Preview& preview);

/// A demand of an experiment on the device.
struct DeviceDemand {
  std::string name;       // of a field, a spring, a burr
  double stiffness{0.0};  // infinite: the force jumps [N/m]
  double damping{0.0};    // [N·s/m]
};

/// Compares demands with the certificate that the definition names (device.certificate); a sentence
/// if it names none.
void add_certified(const protocols::Definition& definition,
                   const std::vector<DeviceDemand>& demands, Preview& preview);

}  // namespace haptrial::experiments
