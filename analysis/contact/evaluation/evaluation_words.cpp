#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/contact/evaluation/evaluation_report.h"
#include "analysis/contact/evaluation/evaluation_tables.h"
#include "core/contact/renderer_kinds.h"

namespace haptrial::evaluation {
namespace {

constexpr double kMilli = 1e3;  // mm, mN and ms to a unit
constexpr double kMicro = 1e6;  // µs
constexpr double kMega = 1e-6;  // MB

std::string between(double low, double high, double factor, const char* unit) {
  const auto bound = [&](double x) {
    return std::isfinite(x) ? fmt::format("{:.4g}", factor * x) : std::string("no bound");
  };
  return fmt::format("95 % interval {} to {}{}", bound(low), bound(high), unit);
}

std::string value_with(const Interval& i, double factor, const char* unit) {
  const std::string value =
      std::isfinite(i.value) ? fmt::format("{:.4g}{}", factor * i.value, unit) : "not bounded";
  return fmt::format("{} ({})", value, between(i.low, i.high, factor, unit));
}

std::vector<std::string> contact_lines(const PreparedContact& c) {
  std::vector<std::string> lines{
      fmt::format("samples         {} at {:.0f} Hz, {:.0f} % in contact", c.time.size(), c.rate,
                  100.0 * c.contact_share),
      fmt::format("stiffness       {:.4g} N/m in the in-trajectory", c.stiffness)};
  lines.push_back(c.lag && c.lag->doubt.empty()
                      ? fmt::format("lag             {:.2f} ms ({})", kMilli * c.lag_used,
                                    between(c.lag->low, c.lag->high, kMilli, " ms"))
                      : fmt::format("lag             {:.2f} ms removed", kMilli * c.lag_used));
  if (c.load) {
    lines.push_back(fmt::format("sensor load     {:.4g} N; {:.3g} N left without contact",
                                c.load->load.weight.norm(), c.load->force_rms));
  }
  if (c.registration) {
    lines.push_back(
        fmt::format("registration    median {:.3f} mm, 95 % {:.3f} mm, worst {:.3f} mm left",
                    kMilli * c.registration->median, kMilli * c.registration->p95,
                    kMilli * c.registration->worst));
  }
  return lines;
}

}  // namespace

std::string name_of(const EvaluatedRendering& r) {
  const std::string name(contact::name_of(r.kind));
  return r.friction > 0.0 ? fmt::format("{} with friction {:.3f}", name, r.friction) : name;
}

std::vector<std::string> identified_lines(const IdentifiedContact& found) {
  std::vector<std::string> lines{"stiffness        " + value_with(found.stiffness, 1.0, " N/m")};
  if (found.dynamic_friction) {
    lines.push_back("dynamic friction " + value_with(*found.dynamic_friction, 1.0, ""));
  }
  if (found.static_friction) {
    lines.push_back("static friction  " + value_with(*found.static_friction, 1.0, ""));
  }
  if (found.texture) {
    lines.push_back("texture          " + value_with(*found.texture, kMilli, " mm"));
  }
  return lines;
}

TextTable error_table(const Evaluation& e) {
  TextTable table{{"renderer", "root mean square (N)", "mean norm (N)", "below 10 Hz (N)",
                   "10 to 100 Hz (N)", "above 100 Hz (N)", "place, root mean square (mm)"},
                  {}};
  const auto add = [&](const std::string& name, const ForceError& force, const BandError& bands,
                       const std::string& place) {
    table.rows.push_back({name, fmt::format("{:.4f}", force.root_mean_square),
                          fmt::format("{:.4f}", force.mean_norm), fmt::format("{:.4f}", bands.slow),
                          fmt::format("{:.4f}", bands.middle), fmt::format("{:.4f}", bands.fast),
                          place});
  };
  for (const EvaluatedRendering& r : e.renderings) {
    add(name_of(r), r.force, r.bands, fmt::format("{:.3f}", kMilli * r.position.root_mean_square));
  }
  for (const OtherRendering& other : e.others) {
    add(other.name, other.force, other.bands, "–");
  }
  return table;
}

TextTable cost_table(const Evaluation& e) {
  TextTable table{{"renderer", "tick, median (µs)", "99.9 % (µs)", "worst (µs)", "preparation (s)",
                   "memory (MB)"},
                  {}};
  for (const EvaluatedRendering& r : e.renderings) {
    table.rows.push_back({name_of(r), fmt::format("{:.2f}", kMicro * r.ticks.median),
                          fmt::format("{:.1f}", kMicro * r.ticks.p999),
                          fmt::format("{:.0f}", kMicro * r.ticks.worst),
                          fmt::format("{:.3f}", r.rendered.preparation),
                          fmt::format("{:.2f}", kMega * r.rendered.memory)});
  }
  return table;
}

TextTable cross_table(const NamedCrossFit& cross) {
  TextTable table{{"error (N), friction fitted on", "friction"}, {}};
  std::vector<std::string> without{"none", "0"};
  for (std::size_t i = 0; i < cross.names.size(); ++i) {
    table.heading.push_back("on " + cross.names[i]);
    without.push_back(fmt::format("{:.4f}", cross.fit.own[i].without));
  }
  table.rows.push_back(std::move(without));
  for (std::size_t fitted = 0; fitted < cross.names.size(); ++fitted) {
    auto& row = table.rows.emplace_back();
    row = {cross.names[fitted], fmt::format("{:.4f}", cross.fit.own[fitted].friction)};
    for (const double error : cross.fit.error[fitted]) {
      row.push_back(fmt::format("{:.4f}", error));
    }
  }
  return table;
}

std::vector<contact::OperationCount> counted(std::span<const contact::Operations> all) {
  std::vector<contact::OperationCount> counts;
  for (const contact::OperationCount& c : contact::kOperationCounts) {
    if (std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.*c.count > 0; })) {
      counts.push_back(c);
    }
  }
  return counts;
}

TextTable operation_table(const Evaluation& e) {
  std::vector<contact::Operations> all;
  for (const EvaluatedRendering& r : e.renderings) {
    all.push_back(r.rendered.operations);
  }
  const auto counts = counted(all);
  TextTable table{{"operations a tick: mean, most"}, {}};
  for (const contact::OperationCount& c : counts) {
    table.heading.emplace_back(c.name);
  }
  for (const EvaluatedRendering& r : e.renderings) {
    table.rows.push_back({name_of(r)});
    const contact::Operations& done = r.rendered.operations;
    const double ticks = std::max(1.0, static_cast<double>(done.ticks));
    for (const contact::OperationCount& c : counts) {
      const double mean = static_cast<double>(done.*c.count) / ticks;
      table.rows.back().push_back(fmt::format("{:.2f}, {}", mean, r.rendered.most.*c.count));
    }
  }
  return table;
}

std::vector<std::string> text_lines(const TextTable& table) {
  std::vector<std::size_t> width;
  for (std::size_t c = 0; c < table.heading.size(); ++c) {
    width.push_back(table.heading[c].size());
    for (const auto& row : table.rows) {
      width[c] = std::max(width[c], row[c].size());
    }
  }
  std::vector<std::string> lines;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line = fmt::format("{:<{}}", row[0], width[0]);
    for (std::size_t c = 1; c < row.size(); ++c) {
      line += fmt::format("  {:>{}}", row[c], width[c]);
    }
    lines.push_back(line);
  };
  add(table.heading);
  for (const auto& row : table.rows) {
    add(row);
  }
  return lines;
}

std::vector<std::string> evaluation_lines(const Evaluation& e) {
  std::vector<std::string> lines = contact_lines(e.contact);
  const auto append = [&](const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  };
  lines.insert(lines.begin(), fmt::format("mesh            {} triangles", e.triangles));
  if (e.friction) {
    lines.push_back(fmt::format(
        "best friction   {:.4f}: root mean square error {:.4f} N, without friction {:.4f} N",
        e.friction->friction, e.friction->with, e.friction->without));
  }
  lines.emplace_back();
  append(text_lines(error_table(e)));
  lines.emplace_back();
  append(text_lines(cost_table(e)));
  lines.emplace_back();
  append(text_lines(operation_table(e)));
  lines.emplace_back();
  for (const EvaluatedRendering& r : e.renderings) {
    lines.push_back(fmt::format("{}: {} {} places with an error beyond the threshold.", name_of(r),
                                r.noticeable.verdict, r.position.places.size()));
  }
  for (const OtherRendering& other : e.others) {
    lines.push_back(fmt::format("{}: {}", other.name, other.noticeable.verdict));
  }
  if (e.cross) {
    lines.emplace_back();
    append(text_lines(cross_table(*e.cross)));
  }
  if (e.identified) {
    lines.emplace_back();
    append(identified_lines(*e.identified));
    append(e.identified->confounded);
  }
  lines.emplace_back();
  append(e.remarks);
  return lines;
}

}  // namespace haptrial::evaluation
