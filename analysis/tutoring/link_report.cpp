#include "analysis/tutoring/link_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/files/delimited.h"
#include "analysis/files/staging.h"
#include "analysis/statistics/design/design_blocks.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::link {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Means over passes.
struct Means {
  std::size_t passes{0};
  double delay{0.0};
  double lost{0.0};
  double apart{0.0};
  double farthest{0.0};  // of all
  double coupling{0.0};

  void add(const LedPass& led) {
    ++passes;
    delay += led.delay;
    lost += led.lost;
    apart += led.apart;
    farthest = std::max(farthest, led.farthest);
    coupling += led.coupling;
  }
  std::vector<std::string> row(const std::string& name) const {
    const double n = static_cast<double>(passes);
    return {name,
            std::to_string(passes),
            fmt::format("{:.1f}", 1e3 * delay / n),
            fmt::format("{:.2f} %", 1e2 * lost / n),
            fmt::format("{:.2f}", 1e3 * apart / n),
            fmt::format("{:.1f}", 1e3 * farthest),
            fmt::format("{:.3f}", coupling / n)};
  }
};

const std::vector<std::string> kColumns{"passes",        "delay, one way [ms]",
                                        "messages lost", "distance of the hands, rms [mm]",
                                        "farthest [mm]", "force of the link, rms [N]"};

void add_means(Document& document, const LinkStudy& study, const std::string& of,
               std::string (*name)(const LedPass&), const std::vector<std::string>& order) {
  std::map<std::string, Means> means;
  for (const LedPass& led : study.passes) {
    means[name(led)].add(led);
  }
  Rows rows;
  for (const std::string& key : order) {
    rows.push_back(means.at(key).row(key));
    means.erase(key);
  }
  for (const auto& [key, mean] : means) {
    rows.push_back(mean.row(key));
  }
  std::vector<std::string> heading{of};
  heading.insert(heading.end(), kColumns.begin(), kColumns.end());
  document.table(heading, rows);
}

}  // namespace

Document link_report(const LinkStudy& study) {
  Document document;
  document.title = "The link between two hands";
  document.simulated = study.simulated;
  document.subtitle = counted(study.passes.size(), "pass") + " in which hands were coupled.";
  if (study.simulated) {
    document.alarm("Simulated participants: these figures say nothing about people.");
  }
  document.paragraph(
      "Measured at the ticks at which the hands were coupled, against the partner's hand as it was "
      "known at that tick: over a slow network a part of the distance is what the partner's hand "
      "moved meanwhile.");
  if (!study.networks.empty()) {
    document.heading("Networks");
    add_means(
        document, study, "network", [](const LedPass& led) { return led.network; }, study.networks);
  }
  for (const LinkQuantity& q : study.quantities) {
    document.subheading(capitalized(q.title));
    add_design_tests(document, q.table, q.tests, "natural logarithms: 0.1 is about 10 %");
  }
  document.heading("Participants");
  add_means(document, study, "participant", [](const LedPass& led) { return led.subject; }, {});
  return document;
}

std::string link_csv(const LinkStudy& study) {
  std::string text;
  exchange::RowText row(text, exchange::Delimited::kCsv);
  for (const char* name :
       {"subject", "session", "trial", "phase", "condition", "network", "set_delay_s", "coupled_s",
        "delay_s", "lost", "apart_rms_m", "apart_most_m", "coupling_rms_N", "energy_given_J"}) {
    row.add(name);
  }
  row.end();
  for (const LedPass& led : study.passes) {
    row.add(led.subject).add(led.session).add(static_cast<int>(led.pass.trial));
    row.add(led.pass.phase.name()).add(led.pass.condition).add(led.network);
    led.network.empty() ? row.add_missing() : row.add(led.set_delay);
    row.add(led.coupled).add(led.delay).add(led.lost).add(led.apart).add(led.farthest);
    row.add(led.coupling).add(led.given);
    row.end();
  }
  return text;
}

void write_link(const LinkStudy& study, const std::filesystem::path& folder) {
  const Staging staging(folder);
  const Document report = link_report(study);
  staging.write("link.csv", link_csv(study));
  staging.write("link.html", to_html(report));
  staging.write("link.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis::link
