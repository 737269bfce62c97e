#pragma once

#include <vector>

#include "analysis/document/document.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// The whole report. @param drawings  outlive the document
Document trials_report(const TrialsResult& result, const std::vector<Drawing>& drawings);

/// Adds a table of the means over participants of every quantity and condition.
void add_means(Document& document, const TrialsResult& result);

/// Parts of it, in their order.
void add_apparatus(Document& document, const TrialsResult& result);
void add_results(Document& document, const TrialsResult& result,
                 const std::vector<Drawing>& drawings);
void add_cues(Document& document, const TrialsResult& result, const std::vector<Drawing>& drawings);
void add_reaching(Document& document, const TrialsResult& result,
                  const std::vector<Drawing>& drawings);
void add_reach_quality(Document& document, const TrialsResult& result);
void add_reaching_methods(Document& document, const ReachingPlan& plan);
void add_comparisons(Document& document, const TrialsResult& result);
void add_trial_quality(Document& document, const TrialsResult& result,
                       const std::vector<Drawing>& drawings);

/// Adds those pictures whose names begin so, at most `most`; a sentence names the files of others.
void add_pictures(Document& document, const std::vector<Drawing>& drawings, const char* begin,
                  std::size_t most);
/// A heading that says where participants are simulated.
void add_section(Document& document, const TrialsResult& result, const char* text);

}  // namespace haptrial::analysis::trials
