#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::analysis {

/// Text as HTML shows it: & < > " ' escaped, control characters other than line ends dropped.
std::string escape_html(std::string_view text);

/// A table of texts, which it escapes; columns after the first are right-aligned when numeric.
/// @param rows  as long as the heading.
std::string html_table(const std::vector<std::string>& heading,
                       const std::vector<std::vector<std::string>>& rows);

/// An SVG file as an element within a page: no XML prologue, its ids behind `prefix` so that
/// several pictures on a page do not share them, and `alt` as its name for those who cannot see it.
std::string inline_svg(const std::string& svg, const std::string& prefix, std::string_view alt);

/// Bytes as text for data: addresses and for scripts (RFC 4648, with padding).
std::string base64(std::string_view bytes);

/// An SVG file that shows a PNG file and holds all its bytes.
/// @throws InputError when the file is absent or no PNG.
std::string svg_of_png(const std::filesystem::path& png);

}  // namespace haptrial::analysis
