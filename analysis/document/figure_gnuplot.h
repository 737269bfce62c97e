#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "analysis/document/figure.h"

namespace haptrial::analysis {

/// The gnuplot program that draws the figure into NAME.svg and NAME.png of its working folder.
/// Text from outside cannot leave its quotes.
/// @param paper  width of a NAME.pdf for a paper [mm], without title and in 8 pt; 0: none
/// @throws std::invalid_argument when the columns of a series do not fit its mark or the name is
/// not one of letters, digits, '-' and '_'.
std::string gnuplot_script(const Figure& figure, int paper = 0);

/// Draws every figure as NAME.svg and NAME.png into an existing folder, in one run of gnuplot. The
/// same figures give the same SVG bytes. @param paper  as above
/// @throws RunError when gnuplot is absent or fails, or a picture is missing or cut short.
void draw_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder,
                  int paper = 0);

/// The figures with their pictures, without files that stay: for a page that has them inside.
/// @throws RunError as above
std::vector<Drawing> drawn(const std::vector<Figure>& figures);

}  // namespace haptrial::analysis
