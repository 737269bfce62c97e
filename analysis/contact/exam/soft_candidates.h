#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/contact/exam/candidate.h"

namespace haptrial::evaluation {

/// Models of this program for soft bodies:
///
///     springs          springs of length, area and volume that move (core/deformable/springs),
///                      with constants that are calibrated when a body is prepared
///     implicit         elements that move by implicit steps (core/deformable/elements)
///     linear-elements  the response of linear elements to the tool and to the forces, at rest
///
/// @returns null for another word
std::unique_ptr<Candidate> soft_candidate(const std::string& word);
std::vector<std::string> soft_candidate_words();

}  // namespace haptrial::evaluation
