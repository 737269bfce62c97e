#pragma once

#include <memory>
#include <string>

#include "analysis/psychophysics/fit/track_estimate.h"
#include "analysis/psychophysics/fit/trials_plan.h"
#include "core/base/definition/table.h"
#include "experiments/studies/study.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::experiments {

/// The report of an experiment that its definition states whole, for simulated participants. Of
/// power.responses:
///
///     met   formula of what an interval presents to the sense [unit of observer.senses]
///
/// Bootstrap, Bayesian fits, intervals of tracks, a mixed model that has no conditions to test and,
/// unless the watched test is one, permutation tests and those of drift and repetition are left
/// out: none of them changes a p value of another test.
/// @param definition  outlives what comes back
/// @param asked_in    file with [power]
/// @param watched     name of the test
/// @throws InputError for analyses that it cannot make, such as of movements
std::unique_ptr<StudySimulation> trials_study_simulation(
    const protocols::StudiedDefinition& definition, analysis::trials::TrialsPlan plan,
    const std::string& asked_in, const std::string& watched);

}  // namespace haptrial::experiments
