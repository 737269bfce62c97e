#pragma once

#include <string>

#include "analysis/document/document.h"
#include "analysis/document/finding.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Numbers of the group and of each participant with their diagnostics: tables without rows unless
/// the plan asks for them and the chains have converged.
FindingTable hierarchical_group_findings(const TrialsResult& result);
FindingTable hierarchical_people_findings(const TrialsResult& result);

/// A sentence for a paper; why there are no numbers, if there are none; empty: the plan does not
/// ask for the model.
std::string hierarchical_sentence(const TrialsResult& result);

/// Model, priors and chains, tables and replicated answers, under a heading of their own.
void add_hierarchical(Document& document, const TrialsResult& result);

}  // namespace haptrial::analysis::trials
