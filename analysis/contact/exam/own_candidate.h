#pragma once

#include <memory>
#include <string>

#include "analysis/contact/exam/candidate.h"

namespace haptrial::evaluation {

/// A kind of renderer (core/contact/renderer_kinds.h) whose tool may be a point; one without
/// friction renders every task without. Or "rigid-tool" (core/contact/rigid_tool.h), or a model of
/// soft bodies (soft_candidates.h), for exams of these.
/// @param word  as a command line has it: "distance-field"
/// @throws InputError for another word, or one that renders another kind of exam.
std::unique_ptr<Candidate> own_candidate(const std::string& word, ExamKind exam);

}  // namespace haptrial::evaluation
