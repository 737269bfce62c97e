#include "analysis/document/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

void replace_all(std::string& text, std::string_view from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

// "3.04", "12 of 90", "-"; but neither a date nor a file name.
bool looks_like_a_number(const std::string& cell) {
  return !cell.empty() && cell.find(':') == std::string::npos &&
         std::string_view("-+.0123456789").find(cell[0]) != std::string_view::npos;
}

// A column of numbers is right-aligned, words are not.
std::vector<bool> numeric_columns(const std::vector<std::vector<std::string>>& rows,
                                  std::size_t count) {
  std::vector<bool> numeric(count, !rows.empty());
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < count; ++c) {
      numeric[c] = numeric[c] && c > 0 && looks_like_a_number(row.at(c));
    }
  }
  return numeric;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') {
          result += c;
        }
    }
  }
  return result;
}

std::string html_table(const std::vector<std::string>& heading,
                       const std::vector<std::vector<std::string>>& rows) {
  const auto numeric = numeric_columns(rows, heading.size());
  const auto cell = [&](const char* tag, std::size_t column, const std::string& text) {
    return fmt::format("<{}{}>{}</{}>", tag, numeric[column] ? " class=\"n\"" : "",
                       escape_html(text), tag);
  };
  std::string html = "<div class=\"scroll\"><table>\n<thead><tr>";
  for (std::size_t c = 0; c < heading.size(); ++c) {
    html += cell("th", c, heading[c]);
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    html += "<tr>";
    for (std::size_t c = 0; c < heading.size(); ++c) {
      html += cell("td", c, row.at(c));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string inline_svg(const std::string& svg, const std::string& prefix, std::string_view alt) {
  const auto start = svg.find("<svg");
  std::string result = start == std::string::npos ? std::string() : svg.substr(start);
  constexpr std::array<const char*, 5> kReferences{"id=\"", "id='", "href='#", "href=\"#", "url(#"};
  for (const char* reference : kReferences) {
    replace_all(result, reference, reference + prefix + "-");
  }
  replace_all(result, "<title>Gnuplot</title>", "");
  const auto label = fmt::format("<svg role=\"img\" aria-label=\"{}\"", escape_html(alt));
  return result.replace(0, std::min<std::size_t>(4, result.size()), label);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kSigns =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kSigns[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

namespace {

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  }
  return value;
}

}  // namespace

std::string svg_of_png(const std::filesystem::path& png) {
  const std::string bytes = file_text(png);
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20, kHeader = 24;
  if (bytes.size() < kHeader || bytes.compare(0, kSignature.size(), kSignature) != 0) {
    throw InputError(fmt::format("{}: is not a PNG file", png.string()));
  }
  const std::uint32_t width = big_endian(bytes, kWidthAt), height = big_endian(bytes, kHeightAt);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\"><image width=\"{0}\" height=\"{1}\" "
      "href=\"data:image/png;base64,{2}\"/></svg>\n",
      width, height, base64(bytes));
}

}  // namespace haptrial::analysis
