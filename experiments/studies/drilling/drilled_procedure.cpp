#include "experiments/studies/drilling/drilled_procedure.h"

#include <fmt/format.h>

#include <cctype>
#include <utility>
#include <vector>

#include "core/base/counted.h"

namespace haptrial::experiments {
namespace {

std::string clock(double seconds) {
  const auto whole = static_cast<long>(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// A bone without known structures has no all-clear.
std::string injured(const analysis::drilling::LiveFigures& figures) {
  if (figures.injuries.empty()) {
    return "vital structures unknown: the bone has none by a known name";
  }
  std::string list;
  for (const analysis::drilling::Injury& injury : figures.injuries) {
    if (injury.voxels + injury.crumbled > 0) {
      list += fmt::format("{} {} {}", list.empty() ? "" : ",", injury.structure,
                          injury.voxels + injury.crumbled);
    }
  }
  return list.empty() ? "nothing vital injured" : fmt::format("INJURED:{}", list);
}

std::string of_the_plan(const analysis::drilling::Achieved& achieved) {
  if (achieved.fragment) {
    const analysis::drilling::FragmentFit& fit = *achieved.fragment;
    return fit.came_off ? fmt::format("gap {:.1f} mm, step {:.1f} mm, {} hold, ", 1e3 * fit.gap,
                                      1e3 * fit.step, counted(fit.screws, "screw", "screws"))
                        : "no fragment has come off, ";
  }
  const auto share = achieved.plan ? achieved.plan->share() : std::nullopt;
  return share ? fmt::format("{:.0f} % of the cavity, {:.1f} mm3 beyond it, ", 100.0 * *share,
                             1e9 * *achieved.beyond())
               : "";
}

std::string line_of(const DrilledProcedure& procedure) {
  const analysis::drilling::LiveFigures& f = procedure.figures;
  return fmt::format(
      "{}: {}, drilling {}, {:.1f} mm3 of bone, {} voxels, {}{}{}{}",
      procedure.practice ? "practice" : fmt::format("procedure {}", procedure.trial), clock(f.time),
      clock(f.drilling), 1e9 * f.removed, f.voxels, of_the_plan(f.achieved),
      f.visible_share ? fmt::format("{:.0f} % in sight, ", 100.0 * *f.visible_share) : "",
      f.mean_force ? fmt::format("{:.2f} N, ", *f.mean_force) : "", injured(f));
}

std::string capital(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

void add_figure(const analysis::drilling::AchievedFigure& figure, record::LiveState& state) {
  const std::string unit = figure.unit == "mm3"     ? "mm\u00b3"
                           : figure.unit == "mm3/m" ? "mm\u00b3/m"
                                                    : figure.unit;
  state.figures.push_back(
      {capital(figure.title),
       fmt::format("{:.{}f} {}", *figure.value, figure.unit == "screws" ? 0 : 1, unit), false});
}

}  // namespace

record::LiveState state_of(const DrilledProcedure& procedure) {
  const analysis::drilling::LiveFigures& f = procedure.figures;
  record::LiveState state;
  state.trial = procedure.trial;
  state.practice = procedure.practice;
  state.title = procedure.practice ? "Practice" : fmt::format("Procedure {}", procedure.trial);
  state.line = line_of(procedure);
  const auto add = [&state](const char* name, std::string value, bool alarm = false) {
    state.figures.push_back({name, std::move(value), alarm});
  };
  add("Time (drilling)", fmt::format("{} ({})", clock(f.time), clock(f.drilling)));
  add("Bone removed", fmt::format("{:.1f} mm\u00b3", 1e9 * f.removed));
  add("Voxels removed (visible)",
      fmt::format("{}{}", f.voxels,
                  f.visible_share ? fmt::format(" ({:.0f} %)", 100.0 * *f.visible_share) : ""));
  for (const analysis::drilling::AchievedFigure& figure :
       analysis::drilling::figures_of(f.achieved)) {
    if (figure.value) {
      add_figure(figure, state);
    }
  }
  add("Mean force while drilling",
      f.mean_force ? fmt::format("{:.2f} N", *f.mean_force) : "\u2013");
  std::vector<record::LiveState::Figure> injuries;
  for (const analysis::drilling::Injury& injury : f.injuries) {
    if (const auto voxels = injury.voxels + injury.crumbled; voxels > 0) {
      injuries.push_back({capital(injury.structure), fmt::format("{} voxels", voxels), true});
    }
  }
  const bool unknown = f.injuries.empty();
  add("Vital structures",
      unknown            ? "unknown: none by a known name"
      : injuries.empty() ? "none injured"
                         : fmt::format("{} injured", injuries.size()),
      unknown || !injuries.empty());
  state.figures.insert(state.figures.end(), injuries.begin(), injuries.end());
  return state;
}

}  // namespace haptrial::experiments
