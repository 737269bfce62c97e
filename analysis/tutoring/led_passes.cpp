#include "analysis/tutoring/led_passes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/rows/partner_rows.h"
#include "core/record/rows/session_tables.h"

namespace haptrial::analysis::link {
namespace {

using record::LinkRow;
using record::Sample;

/// Sums over the ticks of a pass.
struct Sums {
  std::vector<double> delays;  // [s]
  double apart{0.0};           // squares [m^2]
  double coupling{0.0};        // squares [N^2]
  double farthest{0.0};        // [m]
  std::size_t ticks{0};
};

bool coupled(const LinkRow& row) {
  return (row.state & record::kLinkEngaged) != 0 && row.heard > 0;
}

Sums sums_of(const std::vector<LinkRow>& rows, const std::vector<Sample>& samples) {
  Sums sums;
  auto sample = samples.begin();
  for (const LinkRow& row : rows) {
    sample = std::find_if(sample, samples.end(),
                          [&](const Sample& s) { return s.sequence >= row.sequence; });
    if (sample == samples.end()) {
      break;
    }
    if (!coupled(row) || sample->sequence != row.sequence) {
      continue;
    }
    const double apart = (sample->position - row.position).norm();
    sums.apart += apart * apart;
    sums.coupling += row.coupling.squaredNorm();
    sums.farthest = std::max(sums.farthest, apart);
    sums.delays.push_back(row.delay);
    ++sums.ticks;
  }
  return sums;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The share of the partner's messages that was lost between the first and the last tick.
double share_lost(const std::vector<LinkRow>& rows) {
  const auto sent = rows.back().heard - rows.front().heard;
  const auto lost = rows.back().lost - rows.front().lost;
  return sent > 0 ? std::clamp(static_cast<double>(lost) / static_cast<double>(sent), 0.0, 1.0)
                  : 0.0;
}

std::optional<LedPass> led_pass(const record::SessionReader& reader, const record::PassRow& pass) {
  const std::uint64_t count = pass.last_sample - pass.first_sample + 1;
  const auto rows =
      record::rows_of_ticks(reader, record::table_of<LinkRow>(), pass.first_sample, count);
  const auto samples =
      record::rows_of_ticks(reader, record::samples_table(), pass.first_sample, count);
  Sums sums = sums_of(rows, samples);
  if (sums.ticks == 0) {
    return std::nullopt;
  }
  const auto ticks = static_cast<double>(sums.ticks);
  LedPass led;
  led.subject = reader.info().subject;
  led.session = reader.info().session;
  led.pass = pass;
  led.coupled = ticks / reader.info().rate;
  led.delay = median(std::move(sums.delays));
  led.lost = share_lost(rows);
  led.apart = std::sqrt(sums.apart / ticks);
  led.farthest = sums.farthest;
  led.coupling = std::sqrt(sums.coupling / ticks);
  led.given = rows.back().energy_given - rows.front().energy_given;
  return led;
}

}  // namespace

std::vector<LedPass> led_passes(const record::SessionReader& reader) {
  std::vector<LedPass> result;
  if (reader.count(record::table_of<LinkRow>()) == 0) {
    return result;
  }
  std::map<std::int32_t, record::NetworkRow> networks;
  for (const auto& row : reader.rows<record::NetworkRow>()) {
    networks[row.pass] = row;
  }
  const std::vector<record::PassRow> passes = reader.passes();
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const record::PassRow& pass = passes[i];
    if (pass.practice || pass.status != record::PassStatus::kCompleted ||
        pass.last_sample < pass.first_sample) {
      continue;
    }
    if (auto led = led_pass(reader, pass)) {
      if (const auto named = networks.find(static_cast<std::int32_t>(i)); named != networks.end()) {
        led->network = named->second.name;
        led->set_delay = named->second.delay;
      }
      result.push_back(std::move(*led));
    }
  }
  return result;
}

}  // namespace haptrial::analysis::link
