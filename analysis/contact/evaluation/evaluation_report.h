#pragma once

#include <string>
#include <vector>

#include "analysis/contact/evaluation/evaluate_rendering.h"
#include "analysis/document/document.h"

namespace haptrial::evaluation {

/// Names of the evaluated files, for titles.
struct EvaluationNames {
  std::string recording, mesh;  // file names
  bool simulated{false};        // the recording is, and the report says so
};

/// A line of text for each fact, for a terminal: no line end.
std::vector<std::string> evaluation_lines(const Evaluation& evaluation);

/// "proxy", "proxy with friction 0.21".
std::string name_of(const EvaluatedRendering& rendering);

/// Force recorded and rendered over time, error by band, residual of the registration (or, in a
/// known frame, of the recorded places).
std::vector<analysis::Figure> evaluation_figures(const Evaluation& evaluation,
                                                 const EvaluationNames& names);

/// @param drawings  of evaluation_figures(); they outlive the document
analysis::Document evaluation_report(const Evaluation& evaluation, const EvaluationNames& names,
                                     const std::vector<analysis::Drawing>& drawings);

/// Every number, unrounded.
std::string evaluation_json(const Evaluation& evaluation, const EvaluationNames& names);

}  // namespace haptrial::evaluation
