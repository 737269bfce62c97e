#include "protocols/psychophysics/preview/stage_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "core/channel/channel_options.h"

namespace haptrial::protocols {
namespace {

template <class Named>
std::vector<std::string> names_in(const std::vector<Named>& named, std::uint64_t mask) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if ((mask >> i & 1U) != 0) {
      names.push_back(named[i].name);
    }
  }
  return names;
}

const char* words_of(Consequence what) {
  return what == Consequence::kAbort    ? "the trial is aborted"
         : what == Consequence::kRepeat ? "the interval begins again"
                                        : "the trial goes on";
}

/// Whether nothing but time ends it.
bool is_fixed(const Until& until) {
  return until.inside == 0 && until.contact == 0 && std::isinf(until.speed_below) &&
         until.speed_above < 0.0 && until.buttons == 0 && until.keys == 0 && !until.channel;
}

std::string buttons_in(std::uint32_t bits) {
  std::vector<int> numbers;
  for (int button = 0; button < 32; ++button) {
    if ((bits >> button & 1U) != 0) {
      numbers.push_back(button);
    }
  }
  return fmt::format("{}", fmt::join(numbers, " or "));
}

std::string words_of_channel(const TrialsDefinition& d, const Until& until) {
  const std::vector<std::string> names = channel::names_of_values(d.channels);
  std::string words = *until.channel < names.size() ? names[*until.channel] : "the channel";
  if (std::isfinite(until.above)) {
    words += fmt::format(" is above {:g}", until.above);
  }
  if (std::isfinite(until.below)) {
    words += fmt::format("{} below {:g}", std::isfinite(until.above) ? " and" : " is", until.below);
  }
  return words;
}

std::string words_of_end(const TrialsDefinition& d, const Presented& presented,
                         const Until& until) {
  std::vector<std::string> parts;
  if (until.inside != 0) {
    parts.push_back(fmt::format("the hand is inside {}",
                                fmt::join(names_in(presented.regions, until.inside), " and ")));
  }
  if (until.contact != 0) {
    parts.push_back(fmt::format("the hand touches {}",
                                fmt::join(names_in(presented.fields, until.contact), " and ")));
  }
  if (std::isfinite(until.speed_below)) {
    parts.push_back(fmt::format("its speed is below {:g} m/s", until.speed_below));
  }
  if (until.speed_above >= 0.0) {
    parts.push_back(fmt::format("its speed is above {:g} m/s", until.speed_above));
  }
  if (until.buttons != 0) {
    parts.push_back("button " + buttons_in(until.buttons) + " is pressed");
  }
  if (until.keys != 0) {
    parts.emplace_back("a key of the stage is pressed");
  }
  if (until.channel) {
    parts.push_back(words_of_channel(d, until));
  }
  if (parts.empty()) {
    return fmt::format("after {:g} s", until.soonest());
  }
  std::string words = fmt::format("when {}", fmt::join(parts, " and "));
  words += until.hold > 0.0 ? fmt::format(" for {:.3g} s", until.hold) : "";
  const char* const from = until.hold > 0.0 ? "counted from" : "not before";
  return words + (until.time > 0.0 ? fmt::format(", {} {:g} s", from, until.time) : "");
}

std::string words_of_requirement(const Presented& presented, const Requirement& require) {
  using Quantity = Requirement::Quantity;
  const std::string what =
      require.of == Quantity::kSpeed
          ? "speed"
          : fmt::format("{} of {}", require.of == Quantity::kDepth ? "depth" : "force",
                        require.field < 0
                            ? std::string("no field")
                            : presented.fields[static_cast<std::size_t>(require.field)].name);
  const char* unit = require.of == Quantity::kDepth   ? "m"
                     : require.of == Quantity::kForce ? "N"
                                                      : "m/s";
  return fmt::format("{} at least {:g} {}, else {}", what, require.at_least, unit,
                     words_of(require.otherwise));
}

}  // namespace

PreviewedStage previewed_stage(const TrialsDefinition& d, const Presented& presented,
                               std::size_t index) {
  const NamedStage& named = presented.stages[index];
  const Stage& stage = named.stage;
  PreviewedStage shown;
  shown.name = named.name;
  shown.fixed = is_fixed(stage.until);
  shown.shortest = stage.until.soonest();
  shown.longest = shown.fixed ? shown.shortest : stage.timeout;
  shown.ends = words_of_end(d, presented, stage.until);
  if (std::isfinite(stage.timeout)) {
    shown.late = fmt::format("after {:g} s {}", stage.timeout, words_of(stage.late));
  }
  if (stage.require) {
    shown.requirement = words_of_requirement(presented, *stage.require);
  }
  if (named.sound >= 0 && static_cast<std::size_t>(named.sound) < d.cues.cues.size()) {
    shown.sound = d.cues.cues[static_cast<std::size_t>(named.sound)].name;
  }
  if (d.markers.used) {
    shown.marker = named.marker > 0 ? named.marker : d.markers.stage + static_cast<int>(index);
  }
  shown.fields = names_in(presented.fields, stage.fields);
  shown.shows = named.show;
  return shown;
}

}  // namespace haptrial::protocols
