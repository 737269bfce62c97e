#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychophysics/fit/serial_regression.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::analysis::trials {

/// A track whose procedure chose its levels by the answers, and how to begin it anew.
struct SerialTrack {
  bool finished{true};  // else it was broken off
  std::function<std::unique_ptr<psychometric::Procedure>()> begin;
};

/// A participant's sessions as they went.
struct SerialRecord {
  std::vector<SerialTrial> trials;
  std::vector<int> tracks;  // of each trial, in `adaptive`; -1: its level did not depend on answers
  std::vector<SerialTrack> adaptive;
  SerialFunctions functions;
};

/// Average coefficients of somebody who has these functions, does not drift and does not repeat
/// answers: levels that follow from the answers before pull them from 0. Their tracks are done
/// anew, in the recorded order, their functions are fitted anew.
/// @param seed  of the answers
/// @returns means of those of 25 sessions that have coefficients; not defined of fewer than eight
SerialCoefficients serial_coefficients_by_chance(const SerialRecord& record,
                                                 const LikelihoodOptions& options,
                                                 std::uint64_t seed);

}  // namespace haptrial::analysis::trials
