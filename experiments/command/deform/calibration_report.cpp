#include "experiments/command/deform/calibration_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/document/palette.h"
#include "analysis/files/new_folder.h"
#include "core/base/file_text.h"
#include "core/deformable/springs/constants_table.h"
#include "experiments/command/deform/calibration_pictures.h"

namespace haptrial::experiments {
namespace {

using Json = nlohmann::ordered_json;
using deformable::CalibrationStep;

constexpr double kMillimetres = 1e3;
constexpr std::size_t kShownSets = 20;  // unstable ones, in the report
constexpr std::size_t kDrawnLoads = 4;

std::string millimetres(double metres, const char* otherwise = "unstable") {
  return std::isfinite(metres) ? fmt::format("{:.4g}", kMillimetres * metres) : otherwise;
}

const char* word_of(LoadPart part) {
  return part == LoadPart::kSeen ? "seen" : part == LoadPart::kHeldOut ? "held out" : "unseen";
}

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:+.1f} %", 100.0 * share) : "-";
}

std::string with_unit(double metres) {
  return std::isfinite(metres) ? millimetres(metres) + " mm" : millimetres(metres);
}

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::size_t unstable_steps(const CalibrationRun& run) {
  return static_cast<std::size_t>(
      std::count_if(run.result.steps.begin(), run.result.steps.end(),
                    [](const CalibrationStep& step) { return !step.unstable.empty(); }));
}

/// The first evaluation within 5 % of the least error.
std::size_t near_best(const CalibrationRun& run) {
  constexpr double kNear = 1.05;
  const auto& steps = run.result.steps;
  return static_cast<std::size_t>(
      std::find_if(steps.begin(), steps.end(),
                   [&](const CalibrationStep& s) { return s.error <= kNear * run.result.error; }) -
      steps.begin() + 1);
}

std::string json_of(const DeformBody& body, const deformable::SpringBody& springs,
                    const CalibrationRun& run) {
  Json all{{"body", body.setup.file.filename().string()},
           {"tetrahedra", springs.tetrahedra.size()},
           {"vertices", springs.rest.size()},
           {"edges", springs.lengths.size()},
           {"simulated", run.simulated},
           {"method", run.method},
           {"constants", run.constants},
           {"share", run.share},
           {"measure", run.measure},
           {"parameters", run.result.logarithms.size()},
           {"range_log10_J", {run.range.low, run.range.high}},
           {"seed", run.seed},
           {"evaluations", run.result.steps.size()},
           {"evaluations_to_5_percent", near_best(run)},
           {"unstable", unstable_steps(run)},
           {"seconds", run.seconds},
           {"earlier_evaluations", run.earlier},
           {"hand_J", run.hand},
           {"hand_error_m", number(seen_error(run, true))},
           {"error_m", number(seen_error(run, false))},
           {"seen_share_left", number(share_left(run, LoadPart::kSeen))},
           {"unseen_share_left", number(share_left(run, LoadPart::kUnseen))},
           {"change_by_tighter_rest_m", run.tighter},
           {"loads", Json::array()}};
  constexpr std::size_t kListed = 300;
  if (run.result.logarithms.size() <= kListed) {
    all["log10_constants_J"] = run.result.logarithms;
  }
  for (const JudgedLoad& load : run.loads) {
    Json one{{"name", load.name},
             {"unseen", load.part == LoadPart::kUnseen},
             {"held_out", load.part == LoadPart::kHeldOut},
             {"reference", load.reference},
             {"moved_m", load.moved},
             {"hand_error_m", number(load.hand)},
             {"error_m", number(load.found)},
             {"shape_error_m", number(load.shape)},
             {"tool_force_error", number(load.force)}};
    if (!load.unstable.empty()) {
      one["unstable"] = load.unstable;
    }
    all["loads"].push_back(one);
  }
  return all.dump(2) + "\n";
}

/// Least error so far over evaluations (the source's Figure 36).
analysis::Figure error_figure(const CalibrationRun& run) {
  analysis::Figure figure;
  figure.name = "error-by-evaluation";
  figure.title = "Error by evaluation";
  figure.x_label = "evaluations";
  figure.y_label = "error [mm]";
  analysis::Series best{.label = "least so far", .look = {analysis::palette::kBlue}};
  analysis::Series each{.label = "each evaluation",
                        .mark = analysis::Mark::kPoints,
                        .look = {analysis::palette::kGrey}};
  each.look.point_size = 0.4;
  double least = INFINITY;
  const double hand = seen_error(run, true);
  const double most = std::max(std::isfinite(hand) ? hand : 0.0, 3.0 * run.result.error);
  for (std::size_t i = 0; i < run.result.steps.size(); ++i) {
    const double error = run.result.steps[i].error;
    least = std::min(least, error);
    const auto x = static_cast<double>(i + 1);
    if (error <= most) {
      each.x.push_back(x);
      each.y.push_back(kMillimetres * error);
    }
    if (std::isfinite(least)) {
      best.x.push_back(x);
      best.y.push_back(kMillimetres * std::min(least, most));
    }
  }
  figure.y_range = analysis::Range{0.0, 1.05 * kMillimetres * most};
  figure.series = {each, best};
  figure.caption = fmt::format(
      "Error of each evaluation and the least so far; errors above "
      "{} mm and unstable constants are not drawn.",
      millimetres(most));
  figure.alt = "A falling curve; its end is in the table.";
  figure.simulated = false;
  return figure;
}

void add_loads(analysis::Document& page, const CalibrationRun& run) {
  std::vector<std::vector<std::string>> rows;
  for (const JudgedLoad& load : run.loads) {
    rows.push_back(
        {load.name, word_of(load.part), load.reference + (load.markers ? " (places)" : ""),
         millimetres(load.moved), millimetres(load.hand), millimetres(load.found),
         std::isfinite(load.found) ? fmt::format("{:.1f} %", 100.0 * load.found / load.moved)
                                   : load.unstable,
         millimetres(load.shape, "-"), percent(load.force)});
  }
  page.heading("Loads");
  page.table({"load", "calibration", "reference", "moved [mm]", "set by hand [mm]",
              "calibrated [mm]", "of the motion", "shape alone [mm]", "force at the tool"},
             rows);
  page.paragraph(
      "Errors are root mean squares over the vertices, or over the places that were measured. An "
      "unseen load had no part in the calibration; one that was held out only decided which "
      "constants "
      "are kept. Shape alone: what is left after the best rigid motion. Force at the tool: how "
      "much "
      "more force than the reference's moves the places where it acts as far.");
}

void add_unstable(analysis::Document& page, const CalibrationRun& run) {
  std::map<std::string, std::size_t> reasons;
  std::vector<std::vector<std::string>> sets;
  for (std::size_t i = 0; i < run.result.steps.size(); ++i) {
    const CalibrationStep& step = run.result.steps[i];
    if (step.unstable.empty()) {
      continue;
    }
    ++reasons[step.unstable];
    if (sets.size() < kShownSets && step.logarithms.size() == 3) {
      sets.push_back({fmt::format("{}", i + 1), fmt::format("{:.4g}", step.logarithms[0]),
                      fmt::format("{:.4g}", step.logarithms[1]),
                      fmt::format("{:.4g}", step.logarithms[2]), step.unstable});
    }
  }
  page.heading("Unstable constants");
  if (reasons.empty()) {
    page.paragraph("None: under every load the springs came to rest.");
    return;
  }
  page.paragraph("Constants with which a load finds no rest are left out, never averaged in.");
  std::vector<std::vector<std::string>> rows;
  for (const auto& [reason, count] : reasons) {
    rows.push_back({reason, fmt::format("{}", count)});
  }
  page.table({"why", "evaluations"}, rows);
  if (!sets.empty()) {
    page.table({"evaluation", "log10 length", "log10 area", "log10 volume", "why"}, sets,
               fmt::format("The first {} of them", sets.size()));
  }
}

std::vector<std::string> found_lines(const CalibrationRun& run) {
  std::vector<std::string> lines = calibration_lines(run);
  lines.push_back(fmt::format("a hundred times tighter rest changes the error by {:.2g} mm",
                              kMillimetres * run.tighter));
  return lines;
}

}  // namespace

std::vector<std::string> calibration_lines(const CalibrationRun& run) {
  std::vector<std::string> lines;
  lines.push_back(
      fmt::format("{} of {} parameters by {}: {} evaluations, {} of them unstable, "
                  "{:.1f} s",
                  run.constants, run.result.logarithms.size(), run.method, run.result.steps.size(),
                  unstable_steps(run), run.seconds));
  if (run.earlier > 0) {
    lines.push_back(fmt::format("{} evaluations were done before", run.earlier));
  }
  lines.push_back(fmt::format("error {} set by hand, {} calibrated",
                              with_unit(seen_error(run, true)), with_unit(seen_error(run, false))));
  for (const JudgedLoad& load : run.loads) {
    lines.push_back(
        fmt::format("load '{}'{}: moved {}, error {} set by hand, {} calibrated", load.name,
                    load.part == LoadPart::kSeen ? "" : fmt::format(", {}", word_of(load.part)),
                    with_unit(load.moved), with_unit(load.hand), with_unit(load.found)));
  }
  const double unseen = share_left(run, LoadPart::kUnseen);
  if (std::isfinite(unseen)) {
    const double seen = share_left(run, LoadPart::kSeen);
    lines.push_back(fmt::format("left of the motion: {:.1f} % seen, {:.1f} % unseen, {:.2f} times",
                                100.0 * seen, 100.0 * unseen, unseen / seen));
  }
  for (const JudgedLoad& load : run.loads) {
    if (load.found > load.hand) {
      lines.push_back(
          fmt::format("load '{}': worse than with constants set by hand{}", load.name,
                      load.part == LoadPart::kUnseen ? "; calibrate with loads like it" : ""));
    }
  }
  if (seen_error(run, false) > seen_error(run, true)) {
    lines.push_back(
        fmt::format("all in all worse than with constants set by hand; {}",
                    run.method == "descent" ? "try --method annealing" : "raise --evaluations"));
  }
  return lines;
}

void write_calibration(const DeformBody& body, const deformable::SpringBody& springs,
                       const CalibrationRun& run, const std::string& folder) {
  exchange::NewFolder out(folder);
  out.write("calibration.json", json_of(body, springs, run));
  out.write("constants.csv", deformable::constants_csv(springs, run.springs));
  out.write("evaluations.csv", evaluations_csv(run.result.steps));
  const auto place = out.place("report.html").parent_path();
  const analysis::Figure figure = error_figure(run);
  analysis::draw_figures({figure}, place);
  const analysis::Drawing error{figure, file_text(place / (figure.name + ".svg"))};
  std::vector<std::vector<analysis::Drawing>> pictures;
  for (std::size_t i = 0; i < std::min(run.loads.size(), kDrawnLoads); ++i) {
    pictures.push_back(calibration_pictures(springs, run.loads[i], i + 1, place));
  }
  analysis::Document page;
  page.title = "Calibration of springs";
  page.subtitle = body.setup.file.filename().string();
  page.simulated = run.simulated;
  page.points(found_lines(run));
  page.paragraph(fmt::format(
      "{} tetrahedra, {} vertices, {} edges. Logarithms of the constants were searched from {:.3g} "
      "to {:.3g} [log10 J]; set by hand: {:.3g} J for lengths, {:.3g} J for areas, {:.3g} J for "
      "volumes.",
      springs.tetrahedra.size(), springs.rest.size(), springs.lengths.size(), run.range.low,
      run.range.high, run.hand[0], run.hand[1], run.hand[2]));
  add_loads(page, run);
  page.picture(error);
  add_unstable(page, run);
  for (const auto& drawings : pictures) {
    page.heading(drawings.front().figure.title.substr(0, drawings.front().figure.title.find(':')));
    for (const analysis::Drawing& drawing : drawings) {
      page.picture(drawing);
    }
  }
  page.source(body.setup.file.filename().string(), body.setup.text);
  out.write("report.html", analysis::to_html(page));
  out.publish();
}

}  // namespace haptrial::experiments
