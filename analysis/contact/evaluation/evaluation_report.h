#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/contact/evaluation/evaluate_rendering.h"
#include "analysis/document/document.h"

namespace haptrial::evaluation {

/// Names of the evaluated files, for titles.
struct EvaluationNames {
  std::string recording, mesh;  // file names
  bool simulated{false};        // the recording is, and the report says so
  double mesh_unit{1.0};        // of the mesh's file [m]
};

/// A line of text for each fact, for a terminal: no line end.
std::vector<std::string> evaluation_lines(const Evaluation& evaluation);

/// Names of the forces in contact_csv(), in its order: the recorded one, those of renderings and of
/// other programs.
std::vector<std::string> force_names(const Evaluation& evaluation);

/// A table of the contact, a row for each tick: out- and in-trajectory in the mesh's frame [m], the
/// recorded force on the probe [N] and that of every rendering.
std::string contact_csv(const Evaluation& evaluation);

/// The identified object as the table [objects.recorded] of a definition of trials. A value that
/// the recording does not fix has a comment in its place.
std::string objects_toml(const Evaluation& evaluation, const EvaluationNames& names);

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

/// evaluation.json, contact.csv, objects.toml, report.html and its pictures (.svg, .png), all of
/// them or none.
/// @throws InputError when `folder` holds anything or cannot be made; RunError as draw_figures().
void write_evaluation(const Evaluation& evaluation, const EvaluationNames& names,
                      const std::filesystem::path& folder);

}  // namespace haptrial::evaluation
