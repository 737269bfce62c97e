#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "protocols/psychophysics/definition/stage_machine.h"

namespace haptrial {
class RandomStream;
}

namespace haptrial::protocols {

/// A stage as a definition states it.
struct NamedStage {
  std::string name;
  std::vector<std::string> show;  // what the participant sees
  int sound{-1};                  // begins with it, by its index; -1: none
  int marker{0};                  // its code; 0: the one of its place
  Stage stage;
};

/// Names that the stages of a definition may use.
struct StageSource {
  std::vector<std::string> fields;   // by index
  std::vector<std::string> regions;  // likewise
  /// The word that a text such as "$field" stands for; "null" is no field. Null: texts stand for
  /// themselves.
  std::function<std::string(const std::string&)> word;
  RandomStream* random{nullptr};      // draws durations "for = [0.5, 1.0]"; null: the shortest
  std::vector<std::string> sounds{};  // by index
  std::vector<std::string> sights{};  // what can be shown; empty: anything
  /// The bits of a list of keys of the window by their names. Null: no keys are known.
  std::function<std::uint32_t(Table&, const std::string&)> keys{};
  std::vector<std::string> values{};    // of channels, for which stages may wait
  std::vector<std::string> measures{};  // that stages may require, by index
};

/// Reads the tables [[stages]]. Problems are noted in the table; keys in brackets are optional.
///
///     name      unlike every other stage's
///     [fields]  names; together they act, the others do not
///     [show]    names, or texts such as "$seen"; "null" is nothing
///     until     one or more of: time [s], inside (a region, or several), contact (a field, or
///               several), speed_below, speed_above [m/s], buttons (numbers from 0), keys (of the
///               window, names), channel (a quantity) with above or below; [for] = time for which
///               they hold [s], or [shortest, longest]
///     [timeout] after [s], then = "abort", "repeat" or "go on"
///     [require] max_of = "depth", "force" (with field) or "speed", at_least, else = as then; or
///               measure with at_least, at_most or both
///     [onset]   speed_above [m/s]
///     [sound]   name, or "$name"; begins with the stage
///     [marker]  code of its onset, 1 to 255
///
/// A stage whose until asks for more than a time needs a timeout: it might never end.
std::vector<NamedStage> read_stages(Table& root, const StageSource& source);

}  // namespace haptrial::protocols
