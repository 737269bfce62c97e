#pragma once

#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {

// The parts of a study's report, each added to the document in its place.

void add_design(Document& document, const StudyResult& study);
void add_recall(Document& document, const StudyResult& study, const std::vector<Drawing>& drawings);
void add_tests(Document& document, const StudyResult& study);
/// Tests with participants as the unit. @param what  was measured, "Recall error"
void add_participants(Document& document, const StudyStatistics& statistics,
                      const std::string& what);
/// How well paths were recalled, and how far led hands kept to the expert's; nothing where none
/// were.
void add_path(Document& document, const StudyResult& study);
void add_mixed(Document& document, const StudyStatistics& statistics);
void add_learning(Document& document, const StudyResult& study,
                  const std::vector<Drawing>& drawings);
void add_alignments(Document& document, const StudyResult& study,
                    const std::vector<Drawing>& drawings);
void add_quality(Document& document, const StudyResult& study,
                 const std::vector<Drawing>& drawings);
/// Which recordings of scored trials went wrong.
void add_trial_quality(Document& document, const StudyResult& study);
void add_methods(Document& document, const StudyResult& study);

/// The figure of that name; nothing where the study has none.
void add_picture(Document& document, const std::vector<Drawing>& drawings, const std::string& name);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

}  // namespace haptrial::analysis
