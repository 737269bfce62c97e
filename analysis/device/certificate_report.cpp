#include "analysis/device/certificate_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "analysis/device/certificate_summary.h"
#include "analysis/document/document.h"
#include "analysis/document/figure_gnuplot.h"
#include "analysis/document/finding_json_internal.h"
#include "analysis/files/staging.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

constexpr int kFormat = 1;
constexpr const char* kAxes[] = {"x", "y", "z"};

Figure figure(const char* name, const char* title, const char* x, const char* y,
              const CertificateRecord& record) {
  Figure made;
  made.name = name;
  made.title = title;
  made.x_label = x;
  made.y_label = y;
  made.simulated = record.simulated;
  made.who = "DEVICE";
  return made;
}

FindingList static_force(const CertificateRecord& record, const StaticForce& statics) {
  FindingList list{.name = "static_force", .heading = "Static force"};
  FindingTable levels{"levels", "Error of the force at each level, over 26 directions"};
  for (const LevelForce& level : statics.levels) {
    FindingRow row;
    row.push_back({.name = "level", .title = "Commanded", .value = level.level, .unit = "N"});
    row.push_back(finding("error", "Measured - commanded", level.error, "N"));
    row.push_back({.name = "largest",
                   .title = "Largest in a direction",
                   .value = level.largest,
                   .unit = "N"});
    levels.rows.push_back(row);
  }
  FindingTable directions{"directions", "Gain and dead zone in each direction and its opposite"};
  for (const DirectionForce& one : statics.directions) {
    FindingRow row;
    row.push_back({.name = "direction",
                   .title = "Direction",
                   .value = fmt::format("({:.2f}, {:.2f}, {:.2f})", one.direction.x(),
                                        one.direction.y(), one.direction.z())});
    row.push_back(finding("gain", "Gain", one.gain, ""));
    row.push_back(finding("opposite_gain", "Gain of the opposite", one.opposite_gain, ""));
    row.push_back(finding("dead_zone", "Dead zone", one.dead_zone, "N"));
    directions.rows.push_back(row);
  }
  list.tables = {levels, directions};
  Figure drawn = figure("static_force", "Force given and force commanded", "Commanded [N]",
                        "Measured along the command [N]", record);
  const double most = statics.levels.empty() ? 1.0 : statics.levels.back().level;
  drawn.series.push_back({.label = "as commanded",
                          .mark = Mark::kLine,
                          .look = {"#888888", "(8,5)"},
                          .x = {-most, most},
                          .y = {-most, most}});
  drawn.series.push_back({.label = "measured",
                          .mark = Mark::kPoints,
                          .look = {"#0060a0", "solid", 7, 1.0, 0.5},
                          .x = statics.commanded,
                          .y = statics.measured});
  drawn.caption = "A point is a force that was held, in one of 26 directions.";
  drawn.alt = "Measured against commanded force, beside the line on which both are equal.";
  list.figures.push_back(drawn);
  return list;
}

FindingList frequency_response(const CertificateRecord& record,
                               const std::vector<AxisResponse>& axes) {
  FindingList list{.name = "frequency_response", .heading = "Frequency response of force"};
  const Look looks[] = {{"#0060a0", "solid", 7}, {"#c04000", "(8,5)", 5}, {"#208020", "(2,4)", 9}};
  Figure gain = figure("response_gain", "Gain over frequency", "Frequency [Hz]", "Gain", record);
  Figure phase =
      figure("response_phase", "Phase over frequency", "Frequency [Hz]", "Phase [degrees]", record);
  FindingTable table{"tones", "Gain and phase at each frequency"};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    Series gains{.label = kAxes[a], .mark = Mark::kLinkedBars, .look = looks[a]};
    Series phases = gains;
    for (const ToneResponse& tone : axes[a].tones) {
      const double degrees = 180.0 / std::numbers::pi;
      const Interval turned{degrees * tone.phase.value, degrees * tone.phase.low,
                            degrees * tone.phase.high, tone.phase.df};
      for (auto [series, interval] : {std::pair(&gains, tone.gain), std::pair(&phases, turned)}) {
        series->x.push_back(std::log10(tone.frequency));
        series->y.push_back(interval.value);
        series->low.push_back(interval.low);
        series->high.push_back(interval.high);
      }
      table.rows.push_back(
          {{.name = "axis", .title = "Axis", .value = kAxes[a]},
           {.name = "frequency", .title = "Frequency", .value = tone.frequency, .unit = "Hz"},
           finding("gain", "Gain", tone.gain, ""),
           finding("phase", "Phase", turned, "degrees")});
    }
    gain.series.push_back(gains);
    phase.series.push_back(phases);
  }
  for (Figure* drawn : {&gain, &phase}) {
    for (const int f : {2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000}) {
      if (!axes.empty() && f <= axes.front().tones.back().frequency) {
        drawn->x_names.emplace_back(std::log10(f), std::to_string(f));
      }
    }
    drawn->caption = "A force of many frequencies at once, over one that is held; 95 % intervals.";
    drawn->alt = "A curve for each axis with the interval at each frequency.";
  }
  list.tables = {table};
  list.figures = {gain, phase};
  return list;
}

FindingList motion(const CertificateRecord& record, const std::vector<AxisMotion>& axes) {
  FindingList list{.name = "motion", .heading = "Force against movement"};
  FindingTable table{"axes", "Friction, inertia, offset and cogging along each axis"};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const AxisMotion& axis = axes[a];
    const std::string none = fmt::format("below {:.3f} N", axis.least_cogging);
    table.rows.push_back({{.name = "axis", .title = "Axis", .value = kAxes[a]},
                          finding("friction", "Friction", axis.friction, "N"),
                          finding("inertia", "Inertia", axis.inertia, "kg"),
                          finding("offset", "Offset", axis.offset, "N"),
                          axis.cogging ? finding("cogging", "Cogging", *axis.cogging, "N")
                                       : missing("cogging", "Cogging", "N", none),
                          axis.period ? finding("period", "Period", *axis.period, "m")
                                      : missing("period", "Period", "m", "there is no cogging")});
    Figure drawn = figure(a == 0   ? "motion_x"
                          : a == 1 ? "motion_y"
                                   : "motion_z",
                          a == 0   ? "Force along x while the handle is moved"
                          : a == 1 ? "Force along y while the handle is moved"
                                   : "Force along z while the handle is moved",
                          "Position [mm]", "Force on the hand, inertia taken off [N]", record);
    for (const bool forward : {true, false}) {
      Series series{.label = forward ? "forwards" : "backwards",
                    .mark = Mark::kLine,
                    .look = forward ? Look{"#0060a0"} : Look{"#c04000", "(8,5)"}};
      const std::vector<double>& force = forward ? axis.forward : axis.backward;
      for (std::size_t i = 0; i < force.size(); ++i) {
        if (std::isfinite(force[i])) {
          series.x.push_back(1e3 * axis.position[i]);
          series.y.push_back(force[i]);
        }
      }
      drawn.series.push_back(series);
    }
    drawn.caption = "Half the gap between the curves is the friction; their ripple is the cogging.";
    drawn.alt = "Force over position, a curve for either way.";
    list.figures.push_back(drawn);
  }
  list.tables = {table};
  return list;
}

FindingList free_motion(const CertificateResult& result) {
  FindingList list{.name = "free_motion", .heading = "Motion of the free handle"};
  for (const bool loaded : {false, true}) {
    const auto& axes = loaded ? result.loaded : result.free;
    FindingTable table{loaded ? "loaded" : "free",
                       loaded ? "With the known mass" : "Nothing on the handle"};
    for (std::size_t a = 0; a < axes.size(); ++a) {
      table.rows.push_back({{.name = "axis", .title = "Axis", .value = kAxes[a]},
                            finding("mobility", "Gain / inertia", axes[a].mobility, "1/kg"),
                            finding("delay", "Delay", axes[a].delay, "s"),
                            finding("friction", "Friction [commanded]", axes[a].friction, "N"),
                            finding("dead_zone", "Dead zone [commanded]", axes[a].dead_zone, "N"),
                            finding("offset", "Offset [commanded]", axes[a].offset, "N")});
    }
    if (!table.rows.empty()) {
      list.tables.push_back(table);
    }
  }
  return list;
}

FindingList walls(const std::vector<WallStep>& steps) {
  FindingList list{.name = "walls", .heading = "Walls"};
  FindingTable table{"steps", "Walls in the order in which they were tried"};
  for (const WallStep& step : steps) {
    table.rows.push_back(
        {{.name = "stiffness", .title = "Stiffness", .value = step.stiffness, .unit = "N/m"},
         {.name = "verdict", .title = "Verdict", .value = step.passive ? "passive" : "swings"}});
  }
  list.tables = {table};
  return list;
}

Document page(const CertificateRecord& record, const std::vector<FindingList>& lists,
              const std::vector<Drawing>& drawings) {
  Document document;
  document.title = fmt::format("Certificate of {}", record.device);
  document.simulated = record.simulated;
  if (record.simulated) {
    document.alarm("The device is simulated: this is a rehearsal, and no certificate of hardware.");
  }
  if (!record.plant.empty()) {
    document.paragraph("Planted faults of the virtual device:");
    document.points(record.plant);
  }
  document.paragraph(
      "Intervals hold 95 %. Forces are those on the hand, in W (x to the right, y up, z towards "
      "the "
      "participant). What a force sensor alone can tell is not guessed without one.");
  add_findings(document, lists, drawings);
  return document;
}

}  // namespace

std::vector<FindingList> certificate_findings(const CertificateRecord& record,
                                              const CertificateResult& result) {
  std::vector<FindingList> lists{certificate_summary(record, result)};
  if (result.statics) {
    lists.push_back(static_force(record, *result.statics));
  }
  if (!result.response.empty()) {
    lists.push_back(frequency_response(record, result.response));
  }
  if (!result.motion.empty()) {
    lists.push_back(motion(record, result.motion));
  }
  if (!result.free.empty()) {
    lists.push_back(free_motion(result));
  }
  if (!record.walls.empty()) {
    lists.push_back(walls(record.walls));
  }
  return lists;
}

std::string certificate_json(const CertificateRecord& record,
                             const std::vector<FindingList>& findings) {
  nlohmann::ordered_json root{{"certificate", kFormat},
                              {"device", record.device},
                              {"simulated", record.simulated},
                              {"with_sensor", record.has_sensor(CertificatePart::kGrid)}};
  root.update(json_of(findings));
  return root.dump(1) + "\n";
}

void write_certificate(const CertificateRecord& record, const CertificateResult& result,
                       const std::filesystem::path& folder) {
  const std::vector<FindingList> lists = certificate_findings(record, result);
  const Staging staging(folder);
  std::vector<Figure> figures;
  for (const FindingList& list : lists) {
    figures.insert(figures.end(), list.figures.begin(), list.figures.end());
  }
  std::vector<Drawing> drawings;
  if (!figures.empty()) {
    draw_figures(figures, staging.path());
    for (const Figure& drawn : figures) {
      drawings.push_back({drawn, file_text(staging.path() / (drawn.name + ".svg"))});
    }
  }
  staging.write("certificate.json", certificate_json(record, lists));
  staging.write("certificate.html", to_html(page(record, lists, drawings)));
  staging.publish();
}

}  // namespace haptrial::analysis
