#include <fmt/format.h>

#include "analysis/document/document.h"
#include "analysis/document/html.h"
#include "analysis/document/report_style.h"

namespace haptrial::analysis {
namespace {

/// Each kind of block as HTML.
struct HtmlBlock {
  std::string operator()(const Document::Heading& h) const {
    return fmt::format("<h{0}>{1}</h{0}>\n", h.level, escape_html(h.text));
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

}  // namespace

std::string to_html(const Document& document) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}{}</title>\n<style>{}</style>\n</head>\n<body>\n<h1>{}</h1>\n"
      "<p class=\"lead\">{}</p>\n",
      document.simulated ? "SIMULATED: " : "", escape_html(document.title), kReportStyle,
      escape_html(document.title), escape_html(document.subtitle));
  for (const Document::Block& block : document.blocks) {
    html += std::visit(HtmlBlock{}, block);
  }
  return html + "</body>\n</html>\n";
}

}  // namespace haptrial::analysis
