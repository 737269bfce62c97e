#pragma once

#include <string>

#include "analysis/contact/demo_study/failure_map.h"
#include "analysis/contact/exam/candidate.h"

namespace haptrial::evaluation {

/// How a candidate does on ridges of all slopes and depths, without friction. Where the contact is
/// follows from its force: the tool, and force over stiffness from there.
/// @param renderer  what the candidate is called. Source: Morris 2006, §7.5 (Figure 65).
FailureMap failure_map_of(Candidate& candidate, const std::string& renderer);

}  // namespace haptrial::evaluation
