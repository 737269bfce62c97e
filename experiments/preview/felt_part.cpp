#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "experiments/preview/preview_pictures.h"
#include "experiments/preview/trials_parts.h"
#include "protocols/psychophysics/definition/handle_text.h"

namespace haptrial::experiments {
namespace {

using protocols::FeltStage;
using protocols::PreviewedInterval;
using protocols::PreviewedTrial;
using protocols::TrialsDefinition;

struct Curves {
  std::vector<analysis::Series> series;
  double most{0.0};
  std::vector<std::string> words;  // about each, for those who do not see them
};

/// Adds the components of the forces over x that are at least a twentieth of the largest one.
/// @param label  in which {0} is the force's axis
void add_components(const std::vector<double>& x, const std::vector<Eigen::Vector3d>& forces,
                    double most, const std::string& where, const char* unit, Curves& curves) {
  constexpr double kSmall = 0.05;
  for (int component = 0; component < 3; ++component) {
    double low = 0.0, high = 0.0;
    for (const Eigen::Vector3d& force : forces) {
      low = std::min(low, force[component]);
      high = std::max(high, force[component]);
    }
    if (std::max(high, -low) < std::max(1e-6, kSmall * most)) {
      continue;
    }
    analysis::Series series{
        fmt::format("{}-force{}", kAxisNames[static_cast<std::size_t>(component)], where),
        analysis::Mark::kLine, curve_look(curves.series.size())};
    series.x = x;
    for (const Eigen::Vector3d& force : forces) {
      series.y.push_back(force[component]);
    }
    curves.words.push_back(fmt::format("{}: {:.3g} to {:.3g} N over {:.3g} to {:.3g} {}",
                                       series.label, low, high, x.front(), x.back(), unit));
    curves.series.push_back(std::move(series));
  }
}

double largest(const std::vector<Eigen::Vector3d>& forces) {
  double most = 0.0;
  for (const Eigen::Vector3d& force : forces) {
    most = std::max(most, force.cwiseAbs().maxCoeff());
  }
  return most;
}

analysis::Figure force_figure(const std::string& name, const std::string& title,
                              const std::string& x_label, Curves curves,
                              const std::string& caption) {
  constexpr std::size_t kOneRow = 4;  // of the key
  analysis::Figure figure;
  figure.name = name;
  figure.title = title;
  figure.x_label = x_label;
  figure.y_label = "force on the hand [N]";
  figure.height = curves.series.size() > kOneRow ? 0.52 : 0.42;
  figure.caption = caption;
  figure.alt = fmt::format("{}.", fmt::join(curves.words, "; "));
  figure.series = std::move(curves.series);
  return figure;
}

std::string place_words(const Eigen::Vector3d& p) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) mm", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

void add_lines(const FeltStage& stage, const std::string& name, Preview& preview) {
  double most = 0.0;
  for (const protocols::ForceLine& line : stage.lines) {
    most = std::max(most, largest(line.forces));
  }
  Curves curves;
  for (const protocols::ForceLine& line : stage.lines) {
    std::vector<double> x;
    for (const double offset : line.offsets) {
      x.push_back(1e3 * offset);
    }
    add_components(x, line.forces, most,
                   fmt::format(" along {}", kAxisNames[static_cast<std::size_t>(line.axis)]), "mm",
                   curves);
  }
  if (curves.series.empty()) {
    preview.document.paragraph("No force on a hand at rest, wherever it is along the axes.");
    return;
  }
  preview.add(force_figure(
      name + "-lines", "Force over place", "offset along the line [mm]", std::move(curves),
      fmt::format("Along lines through {}, for a hand at rest, without fades; components "
                  "below a twentieth of the largest are left out.",
                  place_words(stage.origin))));
}

void add_plane(const FeltStage& stage, const std::string& name, Preview& preview) {
  const protocols::ForcePlane& plane = stage.plane;
  double most = 0.0;
  for (const Eigen::Vector3d& force : plane.forces) {
    most = std::max(most, std::hypot(force[plane.across], force[plane.up]));
  }
  if (most < 1e-6) {
    return;
  }
  analysis::Figure figure;
  figure.name = name + "-plane";
  figure.title = "Force in a plane";
  figure.caption = fmt::format(
      "Arrows point along the force on a hand at rest; the darker, the stronger. Plane of {} and "
      "{} "
      "through {}{}.",
      kAxisNames[static_cast<std::size_t>(plane.across)],
      kAxisNames[static_cast<std::size_t>(plane.up)], place_words(stage.origin),
      plane.up == 2 ? ", as seen from above" : "");
  figure.alt =
      fmt::format("{} arrows; the strongest force is {:.3g} N.", plane.places.size(), most);
  preview.add(std::move(figure), arrows_svg(plane));
}

void add_speeds(const FeltStage& stage, const std::string& name, Preview& preview) {
  double most = 0.0;
  for (const protocols::SpeedCurve& curve : stage.speeds) {
    most = std::max(most, largest(curve.forces));
  }
  Curves curves;
  for (const protocols::SpeedCurve& curve : stage.speeds) {
    add_components(curve.speeds, curve.forces, most,
                   fmt::format(" along {}", kAxisNames[static_cast<std::size_t>(curve.axis)]),
                   "m/s", curves);
  }
  if (!curves.series.empty()) {
    preview.add(force_figure(
        name + "-speeds", "Force over velocity", "velocity [m/s]", std::move(curves),
        fmt::format("What a velocity adds to the force at {}, once filters have settled.",
                    place_words(stage.moved_at))));
  }
}

void add_course(const FeltStage& stage, const std::string& name, Preview& preview) {
  if (stage.course.empty()) {
    return;
  }
  std::vector<double> times;
  for (std::size_t i = 0; i < stage.course.size(); ++i) {
    times.push_back(static_cast<double>(i) / stage.felt.rate);
  }
  Curves curves;
  add_components(times, stage.course, largest(stage.course), "", "s", curves);
  if (!curves.series.empty()) {
    preview.add(force_figure(
        name + "-course", "Force over time", "time in the stage [s]", std::move(curves),
        fmt::format("On a hand that is held at {}, without fades.", place_words(stage.touched))));
  }
}

void add_numbers(const FeltStage& stage, Preview& preview) {
  std::vector<std::vector<std::string>> rows;
  for (const protocols::FieldNumbers& field : stage.fields) {
    rows.push_back({field.name, field.type, fmt::format("{:.4g}", field.stiffness),
                    fmt::format("{:.4g}", field.damping), field.passive ? "yes" : "no",
                    fmt::format("{:.3g}", std::max(0.0, field.needed)),
                    fmt::format("{:g}", field.limit), fmt::format("{:g}", field.fade_in),
                    fmt::format("{:g}", field.fade_out)});
  }
  preview.document.table({"field", "type", "stiffness [N/m]", "damping [N·s/m]", "passive",
                          "needs damping [N·s/m]", "limit [N]", "fades in [s]", "fades out [s]"},
                         rows);
}

/// Says of the handle what `validate` says, for this trial alone.
void add_handle(const TrialsDefinition& d, const PreviewedTrial& trial, Preview& preview) {
  preview.document.subheading("What hands and device carry");
  protocols::HandleReport report(d);
  for (const PreviewedInterval& interval : trial.intervals) {
    report.add(interval.presented);
  }
  const protocols::HandleText words = report.words();
  for (const std::string& warning : words.warnings) {
    preview.document.alarm("Warning: " + warning);
  }
  if (words.lines.empty()) {
    preview.document.paragraph(
        "In this trial every hand, and a handle that nobody holds, carries the sum of stiffness "
        "and "
        "damping of each stage.");
  } else {
    preview.document.points(words.lines);
  }
}

/// The fields of all stages, each with its largest numbers, and the stiffest sum of a stage.
std::vector<DeviceDemand> demands_of(const std::vector<FeltStage>& stages) {
  std::vector<DeviceDemand> demands;
  DeviceDemand sum{"all fields of the stiffest stage", 0.0, 0.0};
  for (const FeltStage& stage : stages) {
    DeviceDemand here{sum.name, 0.0, 0.0};
    for (const protocols::FieldNumbers& field : stage.fields) {
      here.stiffness += field.stiffness;
      here.damping += field.damping;
      const DeviceDemand demand{field.name, field.stiffness, field.damping};
      const auto known = std::ranges::find(demands, field.name, &DeviceDemand::name);
      if (known == demands.end()) {
        demands.push_back(demand);
      } else if (demand.stiffness > known->stiffness) {
        *known = demand;
      }
    }
    sum = here.stiffness > sum.stiffness ? here : sum;
  }
  demands.push_back(sum);
  return demands;
}

}  // namespace

void add_felt(const TrialsDefinition& d, const PreviewedTrial& trial,
              const std::vector<FeltStage>& stages, Preview& preview) {
  preview.document.heading("What is felt");
  preview.document.paragraph(
      "Forces are computed by the code of sessions, from the fields of each stage. They are those "
      "that the definition asks for, before the device's own limits; nobody measured them.");
  int number = 0;
  for (const FeltStage& stage : stages) {
    const std::string device =
        stage.where.empty() || d.hands.size() < 2 ? "" : ", device " + d.hands[stage.device].name;
    preview.document.subheading(stage_names(trial, stage.where) + device);
    const std::string name = fmt::format("felt-{}", ++number);
    add_numbers(stage, preview);
    if (!stage.is_felt()) {
      preview.document.paragraph(
          "No force on a hand that is led along the axes, moves or stays: what acts here follows "
          "from what the hand did before, or from a channel.");
      continue;
    }
    add_lines(stage, name, preview);
    add_plane(stage, name, preview);
    add_speeds(stage, name, preview);
    add_course(stage, name, preview);
  }
  if (stages.empty()) {
    preview.document.paragraph("No field acts in any stage of this trial.");
  }
  add_handle(d, trial, preview);
  add_certified(d, demands_of(stages), preview);
}

}  // namespace haptrial::experiments
