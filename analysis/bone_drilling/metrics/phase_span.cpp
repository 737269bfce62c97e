#include "analysis/bone_drilling/metrics/phase_span.h"

#include <algorithm>
#include <map>

namespace haptrial::analysis::drilling {

std::vector<PhaseTime> phase_times(const std::vector<PhaseSpan>& spans) {
  std::vector<PhaseTime> times;
  for (const PhaseSpan& span : spans) {
    auto at = std::find_if(times.begin(), times.end(),
                           [&](const PhaseTime& each) { return each.phase == span.phase; });
    if (at == times.end()) {
      at = times.insert(at, {span.phase, 0.0, span.start, 0});
    }
    at->time += span.end - span.start;
    ++at->stretches;
  }
  return times;
}

double time_in(const std::vector<PhaseSpan>& spans, const std::string& phase) {
  double time = 0.0;
  for (const PhaseSpan& span : spans) {
    time += span.phase == phase ? span.end - span.start : 0.0;
  }
  return time;
}

std::vector<std::string> phases_in_order(const std::vector<std::vector<PhaseSpan>>& procedures) {
  std::map<std::string, std::pair<double, int>> begun;  // sum of shares, procedures
  for (const std::vector<PhaseSpan>& spans : procedures) {
    for (const PhaseTime& each : phase_times(spans)) {
      auto& [sum, count] = begun[each.phase];
      sum += spans.back().end > 0.0 ? each.first / spans.back().end : 0.0;
      ++count;
    }
  }
  std::vector<std::string> names;
  for (const auto& [name, share] : begun) {
    names.push_back(name);
  }
  const auto mean = [&](const std::string& name) {
    return begun[name].first / static_cast<double>(begun[name].second);
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return mean(a) < mean(b); });
  return names;
}

int phase_changes(const std::vector<PhaseSpan>& spans) {
  return spans.empty() ? 0 : static_cast<int>(spans.size()) - 1;
}

}  // namespace haptrial::analysis::drilling
