#include "analysis/bone_drilling/feedback/procedure_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/bone_drilling/feedback/page_frame.h"
#include "analysis/bone_drilling/feedback/range_plot.h"
#include "analysis/document/html.h"
#include "core/base/counted.h"

namespace haptrial::analysis::drilling {
namespace {

using Rows = std::vector<std::vector<std::string>>;

double voxel_volume(const Findings& f) {  // [mm^3]
  return 1e9 * std::pow(f.summary.bone->grid.spacing, 3);
}

std::string share(std::size_t part, std::size_t whole) {
  return whole == 0 ? "-"
                    : fmt::format("{:.1f} %",
                                  100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string seconds(const std::optional<double>& time) {
  return time ? fmt::format("{:.1f}", *time) : "-";
}

std::string unit_text(const std::string& unit) { return unit == "1" ? "" : unit; }

const SafeProfile* profile_named(const Experts& experts, const std::string& name) {
  for (const SafeProfile& profile : experts.profiles) {
    if (profile.structure == name) {
      return &profile;
    }
  }
  return nullptr;
}

constexpr double kMillilitres = 1e6;  // in a cubic metre

/// Lines about bone that the burr warmed, and about bleeding, where there may be any.
std::vector<std::string> field_lines(const std::optional<record::FieldRow>& field) {
  std::vector<std::string> lines;
  if (field && field->hottest > 0.0) {
    lines.push_back(fmt::format(
        "Hottest at the burr: {:.1f} °C in a model; above the harmful temperature: {:.1f} s",
        field->hottest, field->harmful_time));
  }
  if (field && field->bled > 0.0) {
    lines.push_back(fmt::format("Blood: {:.2f} ml lost, {:.2f} ml of it sucked away",
                                kMillilitres * field->bled, kMillilitres * field->blood_sucked));
  }
  return lines;
}

/// How often something is true of the removals nearest to one structure.
template <class Is>
std::size_t count_near(const Findings& f, std::int32_t structure, const Is& is) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < f.nearest.size(); ++n) {
    count += f.nearest[n].structure == structure && is(n) ? 1 : 0;
  }
  return count;
}

}  // namespace

std::vector<MetricKind> shown_metrics() {
  std::vector<MetricKind> kinds = metric_kinds();
  std::erase_if(kinds, [](const MetricKind& kind) { return kind.name == kRegionMetric; });
  return kinds;
}

std::optional<SafeRange> experts_range(const Experts& experts, const std::string& metric) {
  std::vector<double> values;
  for (const ProcedureSummary& summary : experts.summaries) {
    if (const auto value = summary.value(metric)) {
      values.push_back(*value);
    }
  }
  return range_of(std::move(values));
}

std::optional<SafeRange> range_of(std::vector<double> values) {
  if (values.empty()) {
    return std::nullopt;
  }
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return SafeRange{values.front(), median, values.back()};
}

bool beyond_experts(const MetricKind& kind, double value, const SafeRange& experts) {
  return (kind.experts == Expected::kHigher && value < experts.low) ||
         (kind.experts == Expected::kLower && value > experts.high);
}

std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

std::string injury_banners(const Findings& f) {
  std::string html;
  for (const Injury& injury : f.summary.injuries) {
    if (const std::optional<double> time = opened_at(injury)) {
      const auto seconds = static_cast<int>(*time);
      html += banner(fmt::format(
          "You opened the {} after {}:{:02} ({}).", injury.structure, seconds / 60, seconds % 60,
          injury.voxels > 0 ? counted(injury.voxels, "voxel removed", "voxels removed") : "torn"));
    }
  }
  return html;
}

std::string summary_points(const Findings& f, const Experts& experts) {
  const std::size_t all = f.faults.size();
  const auto judged =
      static_cast<std::size_t>(std::count(f.judged.begin(), f.judged.end(), std::uint8_t{1}));
  std::vector<std::string> lines;
  lines.push_back(fmt::format("Hidden when removed: {} of {} voxels ({}), {:.1f} mm³",
                              f.count(kHiddenFault), all, share(f.count(kHiddenFault), all),
                              voxel_volume(f) * static_cast<double>(f.count(kHiddenFault))));
  if (f.structures.empty()) {
    lines.emplace_back(
        "Vital structures of this bone are unknown: nobody can tell what was spared");
  } else {
    lines.push_back(fmt::format("Voxels of vital structures removed: {}", f.count(kVitalFault)));
  }
  if (judged > 0) {
    lines.push_back(fmt::format(
        "More force than 95 % of experts' removals at the same distance: {}; faster: {} (experts: "
        "5 % each); judged: {} of {} voxels",
        share(f.count(kForceFault), judged), share(f.count(kSpeedFault), judged), judged, all));
  } else if (!f.structures.empty()) {
    lines.emplace_back(experts.participants.empty()
                           ? "Force and speed near structures are not judged: there are no experts"
                           : "Force and speed near structures are not judged: experts removed too "
                             "little there");
  }
  lines.push_back(fmt::format("Strokes: {}, mean length {} mm", f.summary.strokes.count,
                              number_text(f.summary.value("stroke_length"))));
  for (std::string& line : field_lines(f.summary.field)) {
    lines.push_back(std::move(line));
  }
  std::string html = "<ul class=\"lines\">\n";
  for (const std::string& line : lines) {
    html += "<li>" + escape_html(line) + "</li>\n";
  }
  return html + "</ul>\n";
}

std::string metrics_table(const Findings& f, const Experts& experts) {
  Rows rows;
  for (const MetricKind& kind : shown_metrics()) {
    const auto value = f.summary.value(kind.name);
    const auto range = experts_range(experts, kind.name);
    std::string verdict;
    if (value && range && kind.experts != Expected::kEither) {
      verdict = beyond_experts(kind, *value, *range) ? "beyond all experts" : "as experts";
    }
    rows.push_back({kind.title, unit_text(kind.unit), number_text(value),
                    range ? number_text(range->median) : "-",
                    range ? number_text(range->low) + " to " + number_text(range->high) : "-",
                    verdict});
  }
  return html_table({"metric", "unit", "value", "experts' median", "experts' range", "verdict"},
                    rows);
}

std::string structures_table(const Findings& f) {
  Rows rows;
  for (std::size_t s = 0; s < f.structures.size(); ++s) {
    const auto structure = static_cast<std::int32_t>(s);
    const auto with = [&](std::uint8_t fault) {
      return count_near(f, structure, [&](std::size_t n) { return (f.faults[n] & fault) != 0; });
    };
    const std::size_t all = count_near(f, structure, [](std::size_t) { return true; });
    const std::size_t judged =
        count_near(f, structure, [&](std::size_t n) { return f.judged[n] != 0; });
    double nearest = -1.0;
    for (const NearestRemoval& near : f.nearest) {
      const auto distance = static_cast<double>(near.at.distance);
      if (near.structure == structure && (nearest < 0.0 || distance < nearest)) {
        nearest = distance;
      }
    }
    if (all > 0) {
      rows.push_back(
          {f.structures[s], fmt::format("{:.2f}", 1e3 * nearest), std::to_string(all),
           share(with(kHiddenFault), all),
           fmt::format("{:.1f}", voxel_volume(f) * static_cast<double>(with(kHiddenFault))),
           std::to_string(judged), share(with(kForceFault), judged),
           share(with(kSpeedFault), judged)});
    }
  }
  if (rows.empty()) {
    return paragraph("Nothing was removed within reach of a vital structure.");
  }
  return html_table({"nearest structure", "closest [mm]", "voxels removed", "hidden",
                     "hidden [mm³]", "voxels judged", "too much force", "too fast"},
                    rows);
}

std::string injuries_table(const Findings& f) {
  Rows rows;
  for (const Injury& injury : f.summary.injuries) {
    if (injury.voxels > 0 || injury.crumbled > 0 || injury.first_contact || injury.tears > 0) {
      rows.push_back({injury.structure, seconds(injury.first_contact),
                      seconds(injury.first_removal), std::to_string(injury.voxels),
                      std::to_string(injury.crumbled), std::to_string(injury.tears)});
    }
  }
  if (rows.empty()) {
    return paragraph(f.structures.empty() ? "Vital structures of this bone are unknown."
                                          : "No turning burr reached a vital structure.");
  }
  return html_table({"structure", "first contact [s]", "first removal [s]", "voxels removed",
                     "voxels crumbled", "tears"},
                    rows);
}

std::string worst_table(const Findings& f, const Experts& experts) {
  constexpr std::size_t kRows = 8;
  constexpr double kApart = 1.0;  // rows of one second tell the same [s]
  struct Worst {
    double times;  // the limit
    std::size_t n;
    double limit;
  };
  std::vector<Worst> worst;
  for (std::size_t n = 0; n < f.faults.size(); ++n) {
    if ((f.faults[n] & kForceFault) != 0) {
      const auto& near = f.nearest[n];
      const SafeProfile* profile =
          profile_named(experts, f.structures[static_cast<std::size_t>(near.structure)]);
      const double limit = profile->at(static_cast<double>(near.at.distance))->force->high;
      worst.push_back({static_cast<double>(near.at.force) / std::max(limit, 1e-9), n, limit});
    }
  }
  std::stable_sort(worst.begin(), worst.end(),
                   [](const Worst& a, const Worst& b) { return a.times > b.times; });
  Rows rows;
  std::vector<double> shown;
  for (const Worst& w : worst) {
    const double time = f.times[w.n];
    const bool again = std::any_of(shown.begin(), shown.end(),
                                   [&](double other) { return std::abs(other - time) < kApart; });
    if (again || rows.size() == kRows) {
      continue;
    }
    shown.push_back(time);
    const NearestRemoval& near = f.nearest[w.n];
    rows.push_back({fmt::format("{:.1f}", time),
                    f.structures[static_cast<std::size_t>(near.structure)],
                    fmt::format("{:.2f}", 1e3 * static_cast<double>(near.at.distance)),
                    fmt::format("{:.2f}", near.at.force), fmt::format("{:.2f}", w.limit),
                    fmt::format("{:.1f}", 1e3 * static_cast<double>(near.at.speed)),
                    (f.faults[w.n] & kHiddenFault) != 0 ? "hidden" : "in sight"});
  }
  return rows.empty() ? ""
                      : heading("The highest forces for their distance") +
                            html_table({"time [s]", "structure", "distance [mm]", "force [N]",
                                        "experts' 95 % [N]", "speed [mm/s]", "voxel"},
                                       rows);
}

namespace {

struct Quantity {
  const char* label;
  double scale;
  float NearRemoval::*value;
  std::optional<SafeRange> SafeBin::*range;
  Fault fault;
};

RangePlot plot_of(const Findings& f, std::int32_t structure, const SafeProfile* profile,
                  const Quantity& quantity, double reach) {
  constexpr std::size_t kMostPoints = 400;  // of each kind
  RangePlot plot;
  plot.title = f.structures[static_cast<std::size_t>(structure)];
  plot.x_label = "distance [mm]";
  plot.y_label = quantity.label;
  plot.x_high = reach;
  for (const SafeBin& bin : profile == nullptr ? std::vector<SafeBin>() : profile->bins) {
    if (const auto& range = bin.*quantity.range; range && 1e3 * bin.low < reach) {
      plot.ranges.push_back({1e3 * bin.low, std::min(1e3 * bin.high, reach),
                             quantity.scale * range->low, quantity.scale * range->median,
                             quantity.scale * range->high});
    }
  }
  for (const bool faulty : {false, true}) {
    std::vector<std::size_t> own;
    for (std::size_t n = 0; n < f.nearest.size(); ++n) {
      if (f.nearest[n].structure == structure && ((f.faults[n] & quantity.fault) != 0) == faulty) {
        own.push_back(n);
      }
    }
    const std::size_t shown = std::min(own.size(), kMostPoints);
    for (std::size_t i = 0; i < shown; ++i) {
      const NearRemoval& at = f.nearest[own[i * own.size() / shown]].at;
      plot.points.push_back({1e3 * static_cast<double>(at.distance),
                             quantity.scale * static_cast<double>(at.*quantity.value), faulty});
    }
  }
  return plot;
}

}  // namespace

std::string near_plots(const Findings& f, const Experts& experts) {
  constexpr double kMillimetres = 1e3;
  const std::array quantities{
      Quantity{"force [N]", 1.0, &NearRemoval::force, &SafeBin::force, kForceFault},
      Quantity{"speed [mm/s]", kMillimetres, &NearRemoval::speed, &SafeBin::speed, kSpeedFault}};
  std::string html;
  for (std::size_t s = 0; s < f.structures.size(); ++s) {
    const auto structure = static_cast<std::int32_t>(s);
    double reach = 0.0;  // [mm]
    for (const NearestRemoval& near : f.nearest) {
      if (near.structure == structure) {
        reach = std::max(reach, 1e3 * static_cast<double>(near.at.distance));
      }
    }
    if (reach > 0.0) {
      for (const Quantity& quantity : quantities) {
        html += range_svg(plot_of(f, structure, profile_named(experts, f.structures[s]), quantity,
                                  2.0 * std::ceil(0.5 * reach)));
      }
    }
  }
  return html.empty() ? "" : "<div class=\"plots\">\n" + html + "</div>\n";
}

}  // namespace haptrial::analysis::drilling
