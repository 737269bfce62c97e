#pragma once

#include <filesystem>
#include <string>

namespace haptrial::analysis {

/// An SVG file that shows a PNG file and holds all its bytes.
/// @throws InputError when the file is absent or no PNG.
std::string svg_of_png(const std::filesystem::path& png);

}  // namespace haptrial::analysis
