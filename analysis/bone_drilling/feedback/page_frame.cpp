#include "analysis/bone_drilling/feedback/page_frame.h"

#include <fmt/format.h>

#include "analysis/bone_drilling/feedback/range_plot.h"
#include "analysis/document/html.h"
#include "analysis/document/report_style.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr const char* kPageStyle = R"css(
:root { --band: #dbe7ef; --force: #c2410c; --paper: #fff; color-scheme: light dark; }
body { max-width: 72rem; background: var(--paper); }
a { color: var(--accent); }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8eaed; --soft: #a4abb3; --line: #3c4043; --accent: #6cb6e8; --alarm: #ff8a80;
    --band: #27333d; --force: #ff9f5a; --paper: #15181b; }
  .lines { background: #1d242a; }
}
)css";

}  // namespace

std::string whole_page(std::string_view title, bool simulated, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{}{}</title>\n<style>{}{}{}</style>\n</head>\n<body>\n<h1>{}</h1>\n{}</body>\n"
      "</html>\n",
      simulated ? "SIMULATED: " : "", escape_html(title), kReportStyle, kPageStyle, kPlotStyle,
      escape_html(title), body);
}

std::string banner(std::string_view text) {
  return "<div class=\"banner\" role=\"note\">" + escape_html(text) + "</div>\n";
}

std::string paragraph(std::string_view text) { return "<p>" + escape_html(text) + "</p>\n"; }

std::string heading(std::string_view text) { return "<h2>" + escape_html(text) + "</h2>\n"; }

std::string simulated_banner(bool participant, bool experts) {
  if (!participant && !experts) {
    return "";
  }
  return banner(participant && experts ? "SIMULATED: participant and experts are programs. This "
                                         "page proves nothing about people."
                : participant ? "SIMULATED: the participant is a program. This page proves nothing "
                                "about people."
                              : "SIMULATED EXPERTS: some experts are programs. Their range says "
                                "nothing about surgeons.");
}

}  // namespace haptrial::analysis::drilling
