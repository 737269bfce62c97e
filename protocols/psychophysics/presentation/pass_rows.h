#pragma once

#include <cstdint>
#include <vector>

#include "core/record/rows/trial_rows.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/presentation/trial_pass.h"

namespace haptrial::protocols {

// Rows of a pass that has ended for the session file. The rows of out_of_time_rows() and
// stage_rows() name it by `row`, its own row in /trials.

/// The answers that were given.
/// @param right  (questions) the choice that is correct, -1 where there is none
std::vector<record::ResponseRow> response_rows(const TrialPass& pass,
                                               const std::vector<TrialQuestion>& questions,
                                               const std::vector<int>& right);

/// What was measured in stages that have ended, an answer each. Measures without a value have none.
std::vector<record::ResponseRow> measure_rows(const TrialPass& pass);

/// The answers that came too early or too late.
std::vector<record::OutOfTimeRow> out_of_time_rows(const TrialPass& pass,
                                                   const std::vector<TrialQuestion>& questions,
                                                   std::int32_t row);

/// The stages that were begun.
/// @param stages  (intervals) those of each interval of the pass
std::vector<record::StageRow> stage_rows(const TrialPass& pass,
                                         const std::vector<std::vector<NamedStage>>& stages,
                                         std::int32_t row);

}  // namespace haptrial::protocols
