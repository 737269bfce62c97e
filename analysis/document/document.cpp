#include "analysis/document/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "analysis/document/html.h"
#include "analysis/document/report_style.h"

namespace haptrial::analysis {

void Document::heading(const std::string& text) { blocks.emplace_back(Heading{2, text}); }

void Document::subheading(const std::string& text) { blocks.emplace_back(Heading{3, text}); }

void Document::paragraph(const std::string& text) { blocks.emplace_back(Paragraph{text}); }

void Document::alarm(const std::string& text) { blocks.emplace_back(Alarm{text}); }

void Document::points(const std::vector<std::string>& lines) { blocks.emplace_back(Points{lines}); }

void Document::table(const std::vector<std::string>& names,
                     const std::vector<std::vector<std::string>>& rows,
                     const std::string& folded_under) {
  blocks.emplace_back(Table{names, rows, folded_under});
}

void Document::source(const std::string& name, const std::string& text) {
  blocks.emplace_back(Source{name, text});
}

void Document::picture(const Drawing& drawing) { blocks.emplace_back(Picture{&drawing}); }

namespace {

/// Each kind of block as HTML; headings are numbered for the table of contents.
struct HtmlBlock {
  int headings{0};

  std::string operator()(const Document::Heading& h) {
    return fmt::format("<h{0} id=\"part-{1}\">{2}</h{0}>\n", h.level, ++headings,
                       escape_html(h.text));
  }
  std::string operator()(const Document::Paragraph& p) const {
    return "<p>" + escape_html(p.text) + "</p>\n";
  }
  std::string operator()(const Document::Alarm& a) const {
    return "<div class=\"banner\" role=\"note\">" + escape_html(a.text) + "</div>\n";
  }
  std::string operator()(const Document::Points& p) const {
    std::string html = "<ul class=\"lines\">\n";
    for (const std::string& line : p.lines) {
      html += "<li>" + escape_html(line) + "</li>\n";
    }
    return html + "</ul>\n";
  }
  std::string operator()(const Document::Table& t) const {
    const std::string table = html_table(t.heading, t.rows);
    return t.folded_under.empty() ? table
                                  : fmt::format("<details><summary>{}</summary>\n{}</details>\n",
                                                escape_html(t.folded_under), table);
  }
  std::string operator()(const Document::Source& s) const {
    return fmt::format("<details><summary>{}</summary>\n<pre>{}</pre></details>\n",
                       escape_html(s.name), escape_html(s.text));
  }
  std::string operator()(const Document::Picture& p) const {
    const Figure& figure = p.drawing->figure;
    return fmt::format("<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n",
                       inline_svg(p.drawing->svg, figure.name, figure.title + ". " + figure.alt),
                       escape_html(figure.caption));
  }
};

/// Links to the headings of a long document; empty for a short one.
std::string contents_of(const Document& document) {
  constexpr int kFew = 3;
  std::string links;
  int number = 0;
  int parts = 0;
  for (const Document::Block& block : document.blocks) {
    const auto* heading = std::get_if<Document::Heading>(&block);
    if (heading == nullptr) {
      continue;
    }
    ++number;
    parts += heading->level == 2 ? 1 : 0;
    links += fmt::format("<li class=\"level-{}\"><a href=\"#part-{}\">{}</a></li>\n",
                         heading->level, number, escape_html(heading->text));
  }
  return parts <= kFew ? ""
                       : "<details class=\"contents\" open><summary>Contents</summary>\n<ul>\n" +
                             links + "</ul></details>\n";
}

}  // namespace

std::string to_html(const Document& document) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n<h1>{}</h1>\n"
      "<p class=\"lead\">{}</p>\n",
      document.simulated ? "SIMULATED: " : "", escape_html(document.title), kReportStyle,
      escape_html(document.title), escape_html(document.subtitle));
  html += contents_of(document);
  HtmlBlock writer;
  for (const Document::Block& block : document.blocks) {
    html += std::visit(writer, block);
  }
  return html + "</main>\n</body>\n</html>\n";
}

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
