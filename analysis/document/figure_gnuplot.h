#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/figure.h"

namespace haptrial::analysis {

/// The gnuplot program that draws the figure into NAME.svg and NAME.png of its working folder.
/// Text from outside cannot leave its quotes.
/// @throws std::invalid_argument when the columns of a series do not fit its mark or the name is
/// not one of letters, digits, '-' and '_'.
std::string gnuplot_script(const Figure& figure);

/// Draws every figure as NAME.svg and NAME.png into an existing folder, in one run of gnuplot. The
/// same figures give the same SVG bytes.
/// @throws RunError when gnuplot is absent or fails, or a picture is missing or cut short.
void draw_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder);

}  // namespace haptrial::analysis
