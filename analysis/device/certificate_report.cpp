#include "analysis/device/certificate_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "analysis/device/certificate_summary.h"
#include "analysis/device/part_words.h"
#include "analysis/document/document.h"
#include "analysis/document/figure_gnuplot.h"
#include "analysis/document/finding_json_internal.h"
#include "analysis/files/staging.h"
#include "core/base/file_text.h"
#include "core/device/certificate.h"
#include "core/device/handle_part.h"

namespace haptrial::analysis {
namespace {

/// @param number  of the driven axis
const char* axis_name(const CertificateRecord& record, std::size_t number) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  return record.of == device::Part::kGrip ? "opening" : kAxes[record.axes[number]];
}

Figure figure(const char* name, const std::string& title, const std::string& x,
              const std::string& y, const CertificateRecord& record) {
  Figure made;
  made.name = words_of(record.of).prefix + std::string(name);
  made.title = title;
  made.x_label = x;
  made.y_label = y;
  made.simulated = record.simulated;
  made.who = "DEVICE";
  return made;
}

std::vector<double> scaled(std::vector<double> values, double by) {
  for (double& value : values) {
    value *= by;
  }
  return values;
}

FindingList static_force(const CertificateRecord& record, const StaticForce& statics) {
  FindingList list{.name = "static_force", .heading = "Static force"};
  const std::size_t directed = 2 * statics.directions.size();
  FindingTable levels{"levels", fmt::format("Error at each level, over {} directions", directed)};
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
  const std::string unit = unit_of(record, "N");
  const double worth = worth_of(record, "N");
  const char* force = words_of(record.of).force;
  Figure drawn = figure("static_force", fmt::format("{} given and commanded", force),
                        fmt::format("Commanded [{}]", unit),
                        fmt::format("Measured along the command [{}]", unit), record);
  const double most = worth * (statics.levels.empty() ? 1.0 : statics.levels.back().level);
  drawn.series.push_back({.label = "as commanded",
                          .mark = Mark::kLine,
                          .look = {"#888888", "(8,5)"},
                          .x = {-most, most},
                          .y = {-most, most}});
  drawn.series.push_back({.label = "measured",
                          .mark = Mark::kPoints,
                          .look = {"#0060a0", "solid", 7, 1.0, 0.5},
                          .x = scaled(statics.commanded, worth),
                          .y = scaled(statics.measured, worth)});
  drawn.caption =
      fmt::format("A point is a level that was held, in one of {} directions.", directed);
  drawn.alt = "Measured against commanded levels, beside the line on which both are equal.";
  list.figures.push_back(drawn);
  return list;
}

FindingList frequency_response(const CertificateRecord& record,
                               const std::vector<AxisResponse>& axes) {
  FindingList list{.name = "frequency_response", .heading = "Frequency response"};
  const Look looks[] = {{"#0060a0", "solid", 7}, {"#c04000", "(8,5)", 5}, {"#208020", "(2,4)", 9}};
  Figure gain = figure("response_gain", "Gain over frequency", "Frequency [Hz]", "Gain", record);
  Figure phase =
      figure("response_phase", "Phase over frequency", "Frequency [Hz]", "Phase [degrees]", record);
  FindingTable table{"tones", "Gain and phase at each frequency"};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    Series gains{.label = axis_name(record, a), .mark = Mark::kLinkedBars, .look = looks[a]};
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
          {{.name = "axis", .title = "Axis", .value = axis_name(record, a)},
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

Figure motion_figure(const CertificateRecord& record, const std::string& axis) {
  const bool turns = record.of == device::Part::kRotation;
  const PartWords& words = words_of(record.of);
  const std::string along = record.of == device::Part::kGrip ? "" : fmt::format(" along {}", axis);
  return figure(
      fmt::format("motion_{}", axis).c_str(),
      turns ? fmt::format("Torque about {} while the handle is turned", axis)
            : fmt::format("{}{} while the handle is moved", words.force, along),
      fmt::format("{} [{}]", words.place, turns ? "rad" : "mm"),
      fmt::format("{} on the hand, inertia taken off [{}]", words.force, unit_of(record, "N")),
      record);
}

FindingList motion(const CertificateRecord& record, const std::vector<AxisMotion>& axes) {
  FindingList list{.name = "motion", .heading = "Force against movement"};
  const bool turns = record.of == device::Part::kRotation;
  FindingTable table{"axes", "Friction, inertia, offset and cogging along each axis"};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const AxisMotion& axis = axes[a];
    const std::string none = fmt::format(
        "below {:.3g} {}", worth_of(record, "N") * axis.least_cogging, unit_of(record, "N"));
    table.rows.push_back({{.name = "axis", .title = "Axis", .value = axis_name(record, a)},
                          finding("friction", "Friction", axis.friction, "N"),
                          finding("inertia", "Inertia", axis.inertia, "kg"),
                          finding("offset", "Offset", axis.offset, "N"),
                          axis.cogging ? finding("cogging", "Cogging", *axis.cogging, "N")
                                       : missing("cogging", "Cogging", "N", none),
                          axis.period ? finding("period", "Period", *axis.period, "m")
                                      : missing("period", "Period", "m", "there is no cogging")});
    Figure drawn = motion_figure(record, axis_name(record, a));
    for (const bool forward : {true, false}) {
      Series series{.label = forward ? "forwards" : "backwards",
                    .mark = Mark::kLine,
                    .look = forward ? Look{"#0060a0"} : Look{"#c04000", "(8,5)"}};
      const std::vector<double>& force = forward ? axis.forward : axis.backward;
      for (std::size_t i = 0; i < force.size(); ++i) {
        if (std::isfinite(force[i])) {
          series.x.push_back((turns ? worth_of(record, "m") : 1e3) * axis.position[i]);
          series.y.push_back(worth_of(record, "N") * force[i]);
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

/// A figure that motion may not show.
Finding shown(const char* name, const char* title, const std::optional<Interval>& found,
              const char* unit) {
  return found ? finding(name, title, *found, unit)
               : missing(name, title, unit, "motion shows none clearly");
}

FindingList free_motion(const CertificateRecord& record, const CertificateResult& result) {
  FindingList list{.name = "free_motion", .heading = "Motion of the free handle"};
  for (const bool loaded : {false, true}) {
    const auto& axes = loaded ? result.loaded : result.free;
    FindingTable table{loaded ? "loaded" : "free",
                       loaded ? "With the known load" : "Nothing on the handle"};
    for (std::size_t a = 0; a < axes.size(); ++a) {
      table.rows.push_back({{.name = "axis", .title = "Axis", .value = axis_name(record, a)},
                            finding("mobility", "Gain / inertia", axes[a].mobility, "1/kg"),
                            finding("delay", "Delay", axes[a].delay, "s"),
                            finding("friction", "Friction [commanded]", axes[a].friction, "N"),
                            finding("dead_zone", "Dead zone [commanded]", axes[a].dead_zone, "N"),
                            finding("offset", "Offset [commanded]", axes[a].offset, "N"),
                            shown("cogging", "Cogging [commanded]", axes[a].cogging, "N"),
                            shown("resonance", "Resonance", axes[a].resonance, "Hz"),
                            shown("damping", "Damping", axes[a].damping, "")});
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
         {.name = "verdict",
          .title = "Verdict",
          .value = !step.met      ? "not met"
                   : step.passive ? "passive"
                                  : "swings"}});
  }
  list.tables = {table};
  return list;
}

Document page(const std::vector<PartCertificate>& parts, const std::vector<FindingList>& lists,
              const std::vector<Drawing>& drawings) {
  const CertificateRecord& first = parts.front().record;
  Document document;
  document.title = fmt::format("Certificate of {}", first.device);
  document.simulated = first.simulated;
  if (first.simulated) {
    document.alarm("The device is simulated: this is a rehearsal, and no certificate of hardware.");
  }
  for (const PartCertificate& part : parts) {
    if (!part.record.plant.empty()) {
      document.paragraph(fmt::format("Planted faults of the virtual device's {}:",
                                     device::part_word(part.record.of)));
      document.points(part.record.plant);
    }
  }
  document.paragraph(
      "Intervals hold 95 %. Forces are those on the hand, in W (x to the right, y up, z towards "
      "the participant); torques are about these axes. What a sensor alone can tell is not "
      "guessed without one.");
  add_findings(document, lists, drawings);
  return document;
}

std::vector<FindingList> part_findings(const CertificateRecord& record,
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
    lists.push_back(free_motion(record, result));
  }
  if (!record.walls.empty()) {
    lists.push_back(walls(record.walls));
  }
  const PartWords& words = words_of(record.of);
  for (FindingList& list : lists) {
    list.name = words.prefix + list.name;
    if (record.of != device::Part::kTip && &list != &lists.front()) {
      list.heading += fmt::format(", {}", device::part_word(record.of));
    }
  }
  state_about_axis(record, lists);
  return lists;
}

FindingList without_motors(const PartCertificate& tip, device::Part part) {
  const PartWords& words = words_of(part);
  FindingList list{.name = words.prefix + std::string("summary"), .heading = words.heading};
  list.findings.push_back(missing(
      "gain", fmt::format("{} given and commanded", words.force), "",
      tip.record.simulated ? "the definition has no such part of the virtual device" : words.none));
  return list;
}

}  // namespace

PartCertificate identify_part(CertificateRecord record, const Excitation& excitation) {
  CertificateResult result = identify_device(record, excitation);
  return {std::move(record), std::move(result)};
}

std::vector<FindingList> certificate_findings(const std::vector<PartCertificate>& parts) {
  std::vector<FindingList> lists;
  for (const device::Part of : {device::Part::kTip, device::Part::kRotation, device::Part::kGrip}) {
    const auto part = std::ranges::find(parts, of, [](const auto& one) { return one.record.of; });
    const std::vector<FindingList> own = part != parts.end()
                                             ? part_findings(part->record, part->result)
                                             : std::vector{without_motors(parts.front(), of)};
    lists.insert(lists.end(), own.begin(), own.end());
  }
  return lists;
}

std::string certificate_json(const std::vector<PartCertificate>& parts,
                             const std::vector<FindingList>& findings) {
  const CertificateRecord& first = parts.front().record;
  nlohmann::ordered_json root{{"certificate", device::kCertificateFormat},
                              {"device", first.device},
                              {"simulated", first.simulated},
                              {"with_sensor", first.has_sensor(CertificatePart::kGrid)}};
  root.update(json_of(findings));
  return root.dump(1) + "\n";
}

void write_certificate(const std::vector<PartCertificate>& parts,
                       const std::filesystem::path& folder) {
  const std::vector<FindingList> lists = certificate_findings(parts);
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
  staging.write("certificate.json", certificate_json(parts, lists));
  staging.write("certificate.html", to_html(page(parts, lists, drawings)));
  staging.publish();
}

}  // namespace haptrial::analysis
