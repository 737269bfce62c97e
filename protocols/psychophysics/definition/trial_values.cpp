#include "protocols/psychophysics/definition/trial_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/base/error.h"
#include "protocols/psychophysics/definition/names.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

void declare_all(Names& names, const std::vector<GivenValue>& values) {
  for (const GivenValue& value : values) {
    names.declare(value.name);
  }
}

void give_value(Names& names, const GivenValue& value) {
  try {
    names.set(value.name, names.value(value.formula));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} = \"{}\": {}", value.name, value.formula, error.what()));
  }
}

}  // namespace

void give_corners(const TrialsDefinition& d, bool high, TrialValues& values) {
  const std::vector<const Track*> asked = d.tracks_in(d.order.blocks[values.block]);
  for (const Track& track : d.tracks) {
    const std::vector<std::string> names = track.variables();
    const psychometric::Level corner = track.corner(high);
    if (std::ranges::find(asked, &track) == asked.end()) {
      values.thresholds.emplace_back(track.name, corner.front());
      continue;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      values.levels.emplace_back(names[i], corner[i]);
    }
  }
}

std::string threshold_name(const std::string& track) { return track + ".threshold"; }

bool has_threshold_name(const Track& track) {
  const auto part = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return track.finds_level && !track.name.empty() &&
         std::isdigit(static_cast<unsigned char>(track.name.front())) == 0 &&
         std::ranges::all_of(track.name, part);
}

void declare_names(Names& names, const TrialsDefinition& d) {
  for (const char* name :
       {"trial", "block", "interval", "participant", "session", "group", "probe"}) {
    names.declare(name);
  }
  for (const Block& block : d.order.blocks) {
    declare_all(names, block.values);
    if (block.probe) {
      declare_all(names, block.probe->values);
    }
  }
  for (const Factor& factor : d.order.factors) {
    names.declare(factor.name);
  }
  for (const Interval& interval : d.intervals) {
    declare_all(names, interval.values);
    names.declare("interval." + interval.name);
  }
  for (const Track& track : d.tracks) {
    for (const std::string& name : track.variables()) {
      names.declare(name);
    }
    if (has_threshold_name(track)) {
      names.declare(threshold_name(track.name));
    }
  }
  for (const TrialQuestion& question : d.questions) {
    if (question.is_number()) {
      names.declare(question.name);
    }
  }
}

void give(Names& names, const TrialsDefinition& d, const TrialValues& v) {
  names.forget_given();
  names.set("trial", v.trial);
  names.set("block", d.order.blocks[v.block].name);
  names.set("participant", v.participant);
  names.set("session", v.session);
  names.set("group", v.group);
  names.set("probe", v.probe.empty() ? std::string("no") : v.probe);
  for (std::size_t place = 0; place < v.intervals.size(); ++place) {
    names.set("interval." + d.intervals[v.intervals[place]].name, static_cast<double>(place + 1));
  }
  for (const auto& [name, level] : v.levels) {
    names.set(name, level);
  }
  for (const auto& [track, threshold] : v.thresholds) {
    if (names.knows(threshold_name(track))) {
      names.set(threshold_name(track), threshold);
    }
  }
  for (const GivenValue& value : v.values) {
    give_value(names, value);
  }
}

void give_interval(Names& names, const Interval& interval, std::size_t place) {
  names.set("interval", static_cast<double>(place + 1));
  for (const GivenValue& value : interval.values) {
    give_value(names, value);
  }
}

}  // namespace haptrial::protocols
