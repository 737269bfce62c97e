#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace haptrial::analysis {

/// An SVG file that shows a PNG file and holds all its bytes.
/// @throws InputError when the file is absent or no PNG.
std::string svg_of_png(const std::filesystem::path& png);
/// The same of the bytes of such a file. @param name  in the sentence of the error
std::string svg_of_png_bytes(std::string_view bytes, std::string_view name);

}  // namespace haptrial::analysis
