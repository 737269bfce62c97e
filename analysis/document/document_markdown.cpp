#include <fmt/format.h>

#include <algorithm>

#include "analysis/document/document.h"

namespace haptrial::analysis {
namespace {

/// A line of text: nothing in it is read as Markdown or HTML, and it stays one line.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      out += ' ';
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (std::string_view("\\`*_[]|#").find(c) != std::string_view::npos) {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out;
}

std::string row_of(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) {
    row += fmt::format(" {} |", plain(cell));
  }
  return row + "\n";
}

/// A fence that is longer than any within the text.
std::string fence_for(const std::string& text) {
  std::size_t longest = 0;
  std::size_t run = 0;
  for (const char c : text) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return std::string(std::max<std::size_t>(3, longest + 1), '`');
}

/// Each kind of block as Markdown.
struct MarkdownBlock {
  std::string operator()(const Document::Heading& h) const {
    return std::string(static_cast<std::size_t>(h.level), '#') + " " + plain(h.text) + "\n\n";
  }
  std::string operator()(const Document::Paragraph& p) const { return plain(p.text) + "\n\n"; }
  std::string operator()(const Document::Alarm& a) const {
    return "> **" + plain(a.text) + "**\n\n";
  }
  std::string operator()(const Document::Points& p) const {
    std::string text;
    for (const std::string& line : p.lines) {
      text += "- " + plain(line) + "\n";
    }
    return text + "\n";
  }
  std::string operator()(const Document::Table& t) const {
    std::string text =
        t.folded_under.empty() ? std::string() : fmt::format("*{}*\n\n", plain(t.folded_under));
    text += row_of(t.heading) + row_of(std::vector<std::string>(t.heading.size(), "---"));
    for (const auto& row : t.rows) {
      text += row_of(row);
    }
    return text + "\n";
  }
  std::string operator()(const Document::Source& s) const {
    const std::string fence = fence_for(s.text);
    return plain(s.name) + ":\n\n" + fence + "\n" + s.text + (s.text.ends_with('\n') ? "" : "\n") +
           fence + "\n\n";
  }
  std::string operator()(const Document::Picture& p) const {
    const Figure& figure = p.drawing->figure;
    return fmt::format("![{}]({}.svg)\n\n*{}*\n\n", plain(figure.title + ". " + figure.alt),
                       figure.name, plain(figure.caption));
  }
};

}  // namespace

std::string to_markdown(const Document& document) {
  std::string text = "# " + plain(document.title) + "\n\n" + plain(document.subtitle) + "\n\n";
  for (const Document::Block& block : document.blocks) {
    text += std::visit(MarkdownBlock{}, block);
  }
  text.pop_back();  // one line end at the end
  return text;
}

}  // namespace haptrial::analysis
