#pragma once

#include <string>
#include <vector>

#include "analysis/bone_drilling/feedback/findings.h"

namespace haptrial::analysis::drilling {

/// One of a trainee's procedures.
struct TraineeProcedure {
  ProcedureSummary summary;
  std::size_t judged{0};  // of them: experts say what is safe there
  std::size_t too_hard{0};
  std::size_t too_fast{0};
  std::string page;     // file name of its page beside this one
  std::string started;  // UTC
};

/// Learning: each metric over the procedures of one trainee, in their order, in front of the
/// experts' range, with links to the pages of the procedures. One HTML file that needs nothing
/// else. @param curriculum  as curriculum_section() has it; empty: there is none
std::string trainee_page(const std::string& participant,
                         const std::vector<TraineeProcedure>& procedures, const Experts& experts,
                         const std::string& curriculum = "");

}  // namespace haptrial::analysis::drilling
