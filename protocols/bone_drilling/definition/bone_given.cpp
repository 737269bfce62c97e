#include <fmt/format.h>

#include "core/base/definition/schema.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {
namespace {

/// Two things that every other procedure has cannot be told apart.
void reject_both(Table& table, const char* key, const char* other) {
  table.reject(key, fmt::format("\"every other\", and so is {}", other),
               "\"all\" or \"none\" for one of them: nobody could tell which of the two did it");
}

void reject_beside_others(Table& table, const BoneDefinition& d) {
  if (d.nerves && d.nerves->heard == GivenIn::kEveryOther) {
    reject_both(table, "given_in", "nerve_monitor.heard_in");
  }
  if (d.hints && d.hints->shown == GivenIn::kEveryOther) {
    reject_both(table, "given_in", "hints.shown_in");
  }
}

}  // namespace

void read_given(Table& root, BoneDefinition& d) {
  std::vector<std::string> conditions;
  if (root.has("nerve_monitor")) {
    Table table = root.table("nerve_monitor");
    d.nerves = nerve::read_nerve_setup(table, d.rate);
    conditions = given_words(kMonitor, d.nerves->heard);
  }
  if (root.has("hints")) {
    Table table = root.table("hints");
    d.hints = hint::hint_schema().read(table);
    conditions = joined_words(conditions, given_words(hint::kHints, d.hints->shown));
    if (d.nerves && d.nerves->heard == GivenIn::kEveryOther &&
        d.hints->shown == GivenIn::kEveryOther) {
      reject_both(table, "shown_in", "nerve_monitor.heard_in");
    }
  }
  if (root.has("forbidden")) {
    Table table = root.table("forbidden");
    d.forbidden = bone::region_schema().read(table);
    conditions = joined_words(conditions, given_words(bone::kRegions, d.forbidden->given));
    if (d.forbidden->given == GivenIn::kEveryOther) {
      reject_beside_others(table, d);
    }
  }
  if (!conditions.empty()) {
    d.design.conditions = conditions;
  }
}

bool BoneDefinition::hears_nerves(int trial, int participant) const {
  return nerves && is_given(nerves->heard, trial, participant);
}

bool BoneDefinition::sees_hints(int trial, int participant) const {
  return hints && is_given(hints->shown, trial, participant);
}

bool BoneDefinition::has_regions(int trial, int participant) const {
  return forbidden && is_given(forbidden->given, trial, participant);
}

std::string BoneDefinition::condition(int trial, int participant) const {
  std::vector<std::string> words;
  if (nerves) {
    words = {given_word(kMonitor, hears_nerves(trial, participant))};
  }
  if (hints) {
    words = joined_words(words, {given_word(hint::kHints, sees_hints(trial, participant))});
  }
  if (forbidden) {
    words = joined_words(words, {given_word(bone::kRegions, has_regions(trial, participant))});
  }
  return words.empty() ? "drilling" : words.front();
}

}  // namespace haptrial::protocols
