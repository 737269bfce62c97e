#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/record/table/schema.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {
namespace {

/// Two things that every other procedure has cannot be told apart.
void reject_both(Table& table, const char* key, const char* other) {
  table.reject(key, fmt::format("\"every other\", and so is {}", other),
               "\"all\" or \"none\" for one of them: nobody could tell which of the two did it");
}

void reject_beside_others(Table& table, const BoneDefinition& d) {
  if (d.nerves && d.nerves->heard.trials == GivenIn::kEveryOther) {
    reject_both(table, "given_in", "nerve_monitor.heard_in");
  }
  if (d.hints && d.hints->shown.trials == GivenIn::kEveryOther) {
    reject_both(table, "given_in", "hints.shown_in");
  }
}

/// Notes groups that the study does not have.
void check_given_groups(Table& root, const char* table, const char* key, const GivenIn& in) {
  Table own = root.table(table);
  check_groups(root, own, key, in.groups);
}

/// Whether a session gives nothing of what the study gives.
bool pauses(const BoneDefinition& d) {
  return std::ranges::any_of(d.session_plans, [](const SessionPlan& plan) { return !plan.gives; });
}

GivenPlace given_place(const BoneDefinition& d, const ProcedurePlace& place) {
  const StudyGroup* group = find_group(d.groups, place.participant);
  return {place.trial, place.participant, group != nullptr ? group->name : std::string_view()};
}

bool gives(const BoneDefinition& d, const GivenIn& in, const ProcedurePlace& place) {
  return d.session_plan(place.session).gives &&
         is_given(in, d.in_course(place.session, given_place(d, place)));
}

/// Whether the definition says who is led; else --tutor leads everybody, and is no condition.
bool states_lead(const BoneDefinition& d) { return d.tutoring.led != GivenIn{}; }

/// The condition of a trial: the case and what is given in it, as far as there are any.
std::string in_case(const std::string& name, const std::string& given) {
  return name.empty()    ? given.empty() ? "drilling" : given
         : given.empty() ? name
                         : fmt::format("{}, {}", name, given);
}

/// A file has so much room for a condition.
void check_room(Table& root, const BoneDefinition& d) {
  for (const bone::CurriculumCase& each : d.curriculum->cases) {
    for (const std::string& condition : d.design.conditions) {
      const std::string whole = in_case(each.name, condition);
      if (whole.size() >= record::kConditionBytes) {
        root.table("curriculum")
            .reject("cases",
                    fmt::format("has a name so long that \"{}\" is over {} bytes; choose a "
                                "shorter one",
                                whole, record::kConditionBytes - 1));
      }
    }
  }
}

}  // namespace

void read_given(Table& root, BoneDefinition& d) {
  std::vector<std::string> conditions;
  const bool paused = pauses(d);
  if (root.has("nerve_monitor")) {
    Table table = root.table("nerve_monitor");
    d.nerves = nerve::read_nerve_setup(table, d.rate);
    check_given_groups(root, "nerve_monitor", "heard_in", d.nerves->heard);
    conditions = given_words(kMonitor, d.nerves->heard, paused);
  }
  if (root.has("hints")) {
    Table table = root.table("hints");
    d.hints = hint::hint_schema().read(table);
    check_given_groups(root, "hints", "shown_in", d.hints->shown);
    conditions = joined_words(conditions, given_words(hint::kHints, d.hints->shown, paused));
    if (d.nerves && d.nerves->heard.trials == GivenIn::kEveryOther &&
        d.hints->shown.trials == GivenIn::kEveryOther) {
      reject_both(table, "shown_in", "nerve_monitor.heard_in");
    }
  }
  if (root.has("forbidden")) {
    Table table = root.table("forbidden");
    d.forbidden = bone::region_schema().read(table);
    check_given_groups(root, "forbidden", "given_in", d.forbidden->given);
    conditions = joined_words(conditions, given_words(bone::kRegions, d.forbidden->given, paused));
    if (d.forbidden->given.trials == GivenIn::kEveryOther) {
      reject_beside_others(table, d);
    }
  }
  if (states_lead(d)) {
    conditions = joined_words(conditions, given_words(kTutor, d.tutoring.led, paused));
  }
  if (!conditions.empty()) {
    d.design.conditions = conditions;
  }
  if (d.curriculum) {
    check_room(root, d);
  }
}

bool BoneDefinition::hears_nerves(const ProcedurePlace& place) const {
  return nerves && gives(*this, nerves->heard, place);
}

bool BoneDefinition::sees_hints(const ProcedurePlace& place) const {
  return hints && gives(*this, hints->shown, place);
}

bool BoneDefinition::has_regions(const ProcedurePlace& place) const {
  return forbidden && gives(*this, forbidden->given, place);
}

std::string BoneDefinition::condition(const ProcedurePlace& place) const {
  std::vector<std::string> words;
  const auto add = [&](std::string_view what, bool given) {
    words = joined_words(words, {given_word(what, given)});
  };
  if (nerves) {
    add(kMonitor, hears_nerves(place));
  }
  if (hints) {
    add(hint::kHints, sees_hints(place));
  }
  if (forbidden) {
    add(bone::kRegions, has_regions(place));
  }
  if (states_lead(*this)) {
    add(kTutor, is_led(place.session, given_place(*this, place)));
  }
  return in_case(case_name, words.empty() ? "" : words.front());
}

}  // namespace haptrial::protocols
