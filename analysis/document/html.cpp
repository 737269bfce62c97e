#include "analysis/document/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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

}  // namespace haptrial::analysis
