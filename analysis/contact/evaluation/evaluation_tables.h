#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/contact/evaluation/evaluate_rendering.h"

namespace haptrial::evaluation {

/// Texts in rows as long as the heading; the first one of each names the renderer.
struct TextTable {
  std::vector<std::string> heading;
  std::vector<std::vector<std::string>> rows;
};

TextTable error_table(const Evaluation& evaluation);
TextTable cost_table(const Evaluation& evaluation);
/// Root mean square of the force error on each recording (column) with the friction that was fitted
/// on each (row). @param cross  of Evaluation
TextTable cross_table(const NamedCrossFit& cross);
/// Operations a tick, of what any of them did: the mean, and the most in one tick.
TextTable operation_table(const Evaluation& evaluation);
/// The counts that are not zero in all.
std::vector<contact::OperationCount> counted(std::span<const contact::Operations> all);
/// Columns under each other, the first one to the left.
std::vector<std::string> text_lines(const TextTable& table);

/// A line for each identified parameter.
std::vector<std::string> identified_lines(const IdentifiedContact& found);

}  // namespace haptrial::evaluation
