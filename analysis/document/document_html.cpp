#include <fmt/format.h>

#include "analysis/document/document.h"
#include "analysis/document/html.h"
#include "analysis/document/report_style.h"

namespace haptrial::analysis {
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

}  // namespace haptrial::analysis
