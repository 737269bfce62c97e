#include "analysis/bone_drilling/feedback/phase_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/bone_drilling/feedback/page_frame.h"
#include "analysis/bone_drilling/feedback/procedure_tables.h"
#include "analysis/document/html.h"

namespace haptrial::analysis::drilling {
namespace {

/// Colours that people with any colour vision tell apart (Okabe and Ito 2008), black left out.
constexpr std::array kColours{"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                              "#56b4e9", "#d55e00", "#f0e442"};

/// All phases that the participant or an expert had, by when they begin.
std::vector<std::string> all_phases(const Findings& f, const Experts& experts) {
  std::vector<std::vector<PhaseSpan>> all{f.summary.phases};
  for (const ProcedureSummary& summary : experts.summaries) {
    if (!summary.phases.empty()) {
      all.push_back(summary.phases);
    }
  }
  return phases_in_order(all);
}

const char* colour_of(const std::vector<std::string>& phases, const std::string& phase) {
  const auto at = std::find(phases.begin(), phases.end(), phase) - phases.begin();
  return kColours[static_cast<std::size_t>(at) % kColours.size()];
}

/// A rectangle for each stretch, with its phase and times for whoever points at it.
std::string band(const std::vector<PhaseSpan>& spans, const std::vector<std::string>& phases) {
  constexpr double kWidth = 1000.0;
  const double end = std::max(spans.back().end, 1e-9);
  std::string svg =
      "<svg id=\"phases\" role=\"img\" aria-label=\"Phases over the time of the procedure\" "
      "viewBox=\"0 0 1000 40\" preserveAspectRatio=\"none\" style=\"width:100%;height:2.5rem\">\n";
  for (const PhaseSpan& span : spans) {
    svg += fmt::format(
        "<rect x=\"{:.2f}\" y=\"0\" width=\"{:.2f}\" height=\"40\" fill=\"{}\"><title>{}: {:.1f} "
        "to {:.1f} s</title></rect>\n",
        kWidth * span.start / end, kWidth * (span.end - span.start) / end,
        colour_of(phases, span.phase), escape_html(span.phase), span.start, span.end);
  }
  return svg + "</svg>\n";
}

std::string legend(const std::vector<std::string>& phases, double end) {
  std::string html = "<p>";
  for (const std::string& phase : phases) {
    html += fmt::format("<span style=\"color:{}\">&#9632;</span> {} &nbsp; ",
                        colour_of(phases, phase), escape_html(phase));
  }
  return html + fmt::format("from 0 to {:.0f} s</p>\n", end);
}

std::vector<std::string> row_of(const Findings& f, const Experts& experts,
                                const std::string& phase) {
  const std::vector<PhaseTime> own = phase_times(f.summary.phases);
  const auto at = std::find_if(own.begin(), own.end(),
                               [&](const PhaseTime& each) { return each.phase == phase; });
  const bool any = at != own.end();
  const auto range = experts_time(experts, phase);
  return {phase,
          any ? fmt::format("{:.1f}", at->first) : "-",
          fmt::format("{:.1f}", any ? at->time : 0.0),
          any ? std::to_string(at->stretches) : "0",
          range ? number_text(range->median) : "-",
          range ? number_text(range->low) + " to " + number_text(range->high) : "-"};
}

}  // namespace

std::optional<SafeRange> experts_time(const Experts& experts, const std::string& phase) {
  std::vector<double> values;
  for (const ProcedureSummary& summary : experts.summaries) {
    if (!summary.phases.empty()) {
      values.push_back(time_in(summary.phases, phase));
    }
  }
  return range_of(std::move(values));
}

std::string phase_section(const Findings& f, const Experts& experts) {
  if (f.summary.phases.empty()) {
    return "";
  }
  const std::vector<std::string> phases = all_phases(f, experts);
  std::vector<std::vector<std::string>> rows;
  for (const std::string& phase : phases) {
    rows.push_back(row_of(f, experts, phase));
  }
  return heading("Phases") + band(f.summary.phases, phases) +
         legend(phases, f.summary.phases.back().end) +
         html_table({"phase", "began first [s]", "time [s]", "stretches", "experts' median [s]",
                     "experts' range [s]"},
                    rows) +
         paragraph(
             "A model learned from other procedures recognised them by tool, depth, nearest "
             "structure, force, speed and view of each stroke; it errs.");
}

}  // namespace haptrial::analysis::drilling
