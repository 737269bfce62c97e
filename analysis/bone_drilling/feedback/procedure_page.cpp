#include "analysis/bone_drilling/feedback/procedure_page.h"

#include <fmt/format.h>

#include <utility>

#include "analysis/bone_drilling/feedback/achieved_tables.h"
#include "analysis/bone_drilling/feedback/page_frame.h"
#include "analysis/bone_drilling/feedback/phase_tables.h"
#include "analysis/bone_drilling/feedback/procedure_tables.h"
#include "analysis/document/html.h"

namespace haptrial::analysis::drilling {
namespace {

/// view.html with its marks replaced, of which what is put in may hold any.
std::string view(const ProcedurePage& page) {
  const std::string picture =
      page.picture.empty() ? "<p>Nothing was removed, so there is no picture.</p>"
                           : "<img alt=\"Removed voxels among vital structures, whole and cut "
                             "open\" src=\"data:image/png;base64," +
                                 base64(page.picture) + "\">";
  const std::string scenes =
      "[" + page.scene + (page.expert_scene.empty() ? "" : "," + page.expert_scene) + "]";
  std::string html;
  std::string_view left = view_html();
  for (const auto& [mark, value] :
       {std::pair<std::string_view, std::string>("{{PICTURE}}", picture),
        {"{{OWN}}",
         page.findings->summary.simulated ? "This procedure (simulated)" : "This procedure"},
        {"{{EXPERT}}", escape_html(page.expert_name)},
        {"{{SCENES}}", scenes}}) {
    const std::size_t at = left.find(mark);
    html.append(left.substr(0, at)).append(value);
    left.remove_prefix(at + mark.size());
  }
  return html.append(left);
}

std::string lead(const ProcedurePage& page) {
  const ProcedureSummary& s = page.findings->summary;
  std::string text = fmt::format("Participant {}, procedure {}{}, session {}", s.participant,
                                 s.number, s.completed ? "" : " (not completed)", s.session);
  if (!page.started.empty()) {
    text += ", started " + page.started;
  }
  std::string html = "<p class=\"lead\">" + escape_html(text + ".") + "</p>\n";
  if (!page.overview.empty()) {
    html += fmt::format("<p><a id=\"overview\" href=\"{}\">All procedures of {}</a></p>\n",
                        escape_html(page.overview), escape_html(s.participant));
  }
  return html;
}

std::string experts_sentence(const Experts& experts) {
  if (experts.participants.empty()) {
    return paragraph(
        "There are no experts to compare with: what was hidden and what was injured is marked, "
        "forces and speeds are not judged.");
  }
  return paragraph(fmt::format(
      "Compared with {} of {} (never with the participant's own). Safe forces and speeds are "
      "learned from their removals, by the nearest vital structure and the distance to it: the "
      "grey line is the value that 95 % of them stay below, the band holds 90 % of them, the "
      "dashed line is their median. A range of a metric runs from the smallest to the largest of "
      "their procedures.",
      experts.summaries.size() == 1 ? std::string("1 procedure")
                                    : fmt::format("{} procedures", experts.summaries.size()),
      experts.participants.size() == 1 ? std::string("1 expert")
                                       : fmt::format("{} experts", experts.participants.size())));
}

}  // namespace

std::string procedure_page(const ProcedurePage& page) {
  const Findings& f = *page.findings;
  const Experts& experts = *page.experts;
  std::string body =
      injury_banners(f) + lead(page) + simulated_banner(f.summary.simulated, experts.simulated);
  if (f.structures.empty()) {
    body += banner(
        "Vital structures are unknown: this bone has none by a known name. Nothing here is an "
        "all-clear.");
  }
  body += summary_points(f, experts) + view(page) + experts_sentence(experts);
  body += page.curriculum + page.score + page.checklist + achieved_section(f, experts) +
          phase_section(f, experts);
  body += heading("Near vital structures");
  body += f.structures.empty()
              ? paragraph("Vital structures of this bone are unknown.")
              : structures_table(f) + near_plots(f, experts) + worst_table(f, experts);
  body += heading("Injuries") + injuries_table(f);
  body += heading("Figures") + metrics_table(f, experts);
  return whole_page("After a procedure: " + f.summary.participant, f.summary.simulated, body);
}

}  // namespace haptrial::analysis::drilling
