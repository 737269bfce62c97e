#include "core/bone/hint/safe_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "core/base/definition/table.h"

namespace haptrial::hint {
namespace {

constexpr long kMost = 1'000'000;  // participants, procedures

const char* const kHead =
    "# Greatest safe forces and speeds near structures, learned from experts by haptrial bone "
    "safe.\n# [hints] of a definition names this file. SI units.\n";

std::string list_of(const std::vector<SafeInterval>& intervals, double SafeInterval::*value) {
  std::vector<std::string> words;
  for (const SafeInterval& each : intervals) {
    words.push_back(fmt::format("{:#}", each.*value));  // a float also where it is whole
  }
  return fmt::format("[{}]", fmt::join(words, ", "));
}

bool ascending(const std::vector<SafeInterval>& intervals) {
  double end = 0.0;
  for (const SafeInterval& each : intervals) {
    if (!(each.from >= end && each.to > each.from)) {
      return false;
    }
    end = each.to;
  }
  return true;
}

SafeStructure read_structure(Table& table) {
  SafeStructure structure{table.text("name"), {}};
  const auto from = table.numbers("from", {0.0, 1.0}, "m");
  const auto to = table.numbers("to", {0.0, 1.0, true}, "m");
  const auto force = table.numbers("force", {0.0, 1000.0}, "N");
  const auto speed = table.numbers("speed", {0.0, 100.0}, "m/s");
  if (to.size() != from.size() || force.size() != from.size() || speed.size() != from.size()) {
    table.reject("from", fmt::format("has {} numbers, to {}, force {} and speed {}; write one of "
                                     "each for every interval",
                                     from.size(), to.size(), force.size(), speed.size()));
    return structure;
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    structure.intervals.push_back({from[i], to[i], force[i], speed[i]});
  }
  if (!ascending(structure.intervals)) {
    table.reject("from", "does not make intervals with to that follow one another from 0 on");
  }
  return structure;
}

}  // namespace

const SafeInterval* SafeStructure::at(double distance) const noexcept {
  const auto next =
      std::upper_bound(intervals.begin(), intervals.end(), distance,
                       [](double d, const SafeInterval& each) { return d < each.from; });
  return next != intervals.begin() && distance < std::prev(next)->to ? &*std::prev(next) : nullptr;
}

const SafeStructure* SafeLimits::of(const std::string& name) const noexcept {
  const auto at = std::find_if(structures.begin(), structures.end(),
                               [&](const SafeStructure& each) { return each.name == name; });
  return at != structures.end() ? &*at : nullptr;
}

std::string safe_limits_text(const SafeLimits& limits) {
  std::string text = kHead;
  text += fmt::format(
      "\n[experts]\nstudy = {}\nparticipants = {}\nprocedures = {}\nsimulated = {}\nshare = {:#}\n",
      fmt::format("\"{}\"", limits.study), limits.participants, limits.procedures, limits.simulated,
      limits.share);
  for (const SafeStructure& structure : limits.structures) {
    text += fmt::format(
        "\n[[structures]]\nname = \"{}\"\nfrom = {}\nto = {}\nforce = {}\n"
        "speed = {}\n",
        structure.name, list_of(structure.intervals, &SafeInterval::from),
        list_of(structure.intervals, &SafeInterval::to),
        list_of(structure.intervals, &SafeInterval::force),
        list_of(structure.intervals, &SafeInterval::speed));
  }
  return text;
}

SafeLimits load_safe_limits(const std::filesystem::path& file) {
  Table root = Table::load(file);
  Table experts = root.table("experts");
  SafeLimits limits;
  limits.study = experts.text("study");
  limits.participants = static_cast<std::size_t>(experts.integer("participants", 1, kMost));
  limits.procedures = static_cast<std::size_t>(experts.integer("procedures", 1, kMost));
  limits.simulated = experts.boolean("simulated");
  limits.share = experts.number("share", {0.0, 1.0, true}, "1");
  std::set<std::string> names;
  for (Table& each : root.tables("structures")) {
    limits.structures.push_back(read_structure(each));
    if (!names.insert(limits.structures.back().name).second) {
      each.reject("name", fmt::format("\"{}\"", limits.structures.back().name),
                  "a name that no other structure has");
    }
  }
  root.finish();
  return limits;
}

}  // namespace haptrial::hint
