#include "protocols/trials/definition/read_definition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/psychometric/definition/read_tracks.h"
#include "core/scene/needed_damping.h"
#include "core/scene/read/read_field.h"
#include "core/scene/read/read_solid.h"
#include "core/scene/read/read_yielding.h"
#include "core/sound/cues/read_cues.h"
#include "protocols/definition/handle_loop.h"
#include "protocols/trials/definition/defaults.h"
#include "protocols/trials/definition/trial_devices.h"
#include "protocols/trials/definition/trial_values.h"

namespace haptrial::protocols {
namespace {

void read_view(Table& root, TrialsDefinition& d) {
  Table table = root.table("display");
  d.display = render::read_trial_display_style(table);
  d.view.from_above = table.choice("seen_from", {"above", "front"}) == "above";
  d.view.width = table.number("extent", {0.01, 1.0}, "m");
  d.view.hand_radius = table.number("hand_radius", {0.0005, 0.05}, "m");
  d.feedback_right = table.shown_text("feedback_right");
  d.feedback_wrong = table.shown_text("feedback_wrong");
  d.feedback_time = table.number("feedback_time", {0.0, 10.0}, "s");
  d.view.stereo = table.has("stereo") && table.boolean("stereo");
  if (table.has("eye_distance")) {
    d.view.eyes.eye_distance = table.number("eye_distance", {0.02, 0.2}, "m");
  }
  if (table.has("viewing_distance")) {
    d.view.eyes.viewing_distance = table.number("viewing_distance", {0.1, 10.0}, "m");
  }
  if (root.has("looks") && !d.view.stereo) {
    table.reject("stereo",
                 "is not true, but a bar of random dots is seen with two eyes only; add stereo = "
                 "true, which shows the eyes' pictures side by side");
  }
}

/// The sounds, and those that go with the feedback.
void read_sounds(Table& root, TrialsDefinition& d) {
  if (root.has("sounds")) {
    Table table = root.table("sounds");
    d.cues = sound::read_cues(table);
    d.markers.used = true;
  }
  Table display = root.table("display");
  const auto read = [&](const char* key, int& into) {
    if (!display.has(key)) {
      return;
    }
    const std::string name = display.text(key);
    const auto found = std::ranges::find(d.cues.cues, name, &sound::Cue::name);
    if (found == d.cues.cues.end()) {
      display.reject(key, fmt::format("\"{}\"", name), "a sound of [sounds]");
    }
    into = static_cast<int>(found - d.cues.cues.begin());
  };
  read("sound_right", d.sound_right);
  read("sound_wrong", d.sound_wrong);
}

/// Masking noise in stages that are not there would never be heard.
void check_masking(Table& root, const TrialsDefinition& d) {
  if (!d.cues.masking) {
    return;
  }
  for (const std::string& stage : d.cues.masking->stages) {
    if (std::ranges::find(d.stages, stage) == d.stages.end()) {
      root.reject("sounds", fmt::format("masking names the stage \"{}\"; allowed: {}", stage,
                                        fmt::join(d.stages, ", ")));
    }
  }
}

std::vector<GivenValue> interval_values(Table& table) {
  std::vector<GivenValue> values;
  for (const std::string& key : table.keys()) {
    const auto text = table.whole_text(key);
    values.push_back({key, text ? *text : formula_of_value(table, key)});
  }
  return values;
}

void read_intervals(Table& root, TrialsDefinition& d) {
  if (!root.has("intervals")) {
    d.intervals.push_back({"only", {}});
    return;
  }
  Table table = root.table("intervals");
  d.random_intervals =
      table.has("order") && table.choice("order", {"as stated", "random"}) == "random";
  for (const std::string& name : table.keys_as_written()) {
    if (name != "order") {
      Table interval = table.table(name);
      d.intervals.push_back({name, interval_values(interval)});
    }
  }
  if (d.intervals.empty()) {
    table.reject("order", "stands alone; add intervals: reference = { stiffness = 300.0 }");
    d.intervals.push_back({"only", {}});
  }
}

/// Two tracks may not set one variable in the same trial, nor a track what a block gives.
void check_tracks(Table& root, const TrialsDefinition& d) {
  std::set<std::string> factors;
  for (const Factor& factor : d.order.factors) {
    factors.insert(factor.name);
  }
  std::set<std::string> names;
  for (const Track& track : d.tracks) {
    const char* table = root.has("procedure") ? "procedure" : "procedures";
    if (!names.insert(track.name).second) {
      root.reject(table,
                  fmt::format("has two tracks \"{}\"; give each a name of its own", track.name));
    }
    for (const std::string& factor : track.by) {
      if (!factors.contains(factor)) {
        root.reject(table,
                    fmt::format("names the factor \"{}\" in `by`; allowed: {}", factor,
                                factors.empty() ? "none, the definition has no [factors]"
                                                : fmt::format("{}", fmt::join(factors, ", "))));
      }
    }
    for (const std::string& variable : track.variables()) {
      if (factors.contains(variable)) {
        root.reject(table, fmt::format("sets \"{}\", which is a factor; let one of the two have "
                                       "another name",
                                       variable));
      }
      for (const Interval& interval : d.intervals) {
        const auto given = [&](const GivenValue& value) { return value.name == variable; };
        if (std::any_of(interval.values.begin(), interval.values.end(), given)) {
          root.reject(table,
                      fmt::format("sets \"{}\", which the interval {} gives a value as well; "
                                  "keep one of the two",
                                  variable, interval.name));
        }
      }
    }
  }
}

/// What a track learns from, and what it could learn at best.
void check_learning(Table& root, const TrialsDefinition& d) {
  const char* table = root.has("procedure") ? "procedure" : "procedures";
  for (const Track& track : d.tracks) {
    if (!track.counts.empty()) {
      continue;
    }
    if (track.kind == "adjustment") {
      root.reject(table, fmt::format("does not say which answer raises the level (\"{}\"); add "
                                     "`counts`, a formula that is 1, -1 or 0: \"$answer == 1 ? 1 "
                                     ": $answer == 2 ? -1 : 0\"",
                                     track.name));
    } else if (d.questions.empty() || d.questions.front().correct.empty()) {
      root.reject(table,
                  fmt::format("learns from right answers (\"{}\"), and no response says which "
                              "is right; add `correct` to [response] or `counts` to the "
                              "procedure",
                              track.name));
    } else if (track.staircase && track.staircase->up == 1) {
      const double balance =
          psychometric::balance_of(track.staircase->down, track.staircase->steps.back());
      const double guess = 1.0 / static_cast<double>(d.questions.front().choices.size());
      if (balance <= guess) {
        root.reject(table,
                    fmt::format("is in balance at {:.3g} % right answers (\"{}\"), which guessing "
                                "gives; let more right answers make a step down, or steps up be "
                                "larger",
                                100.0 * balance, track.name));
      }
    }
  }
}

/// Each [[procedures]] has its variable; in its trials the others have what [variables] says.
void check_variables(Table& root) {
  if (!root.has("procedures")) {
    return;
  }
  std::set<std::string> variables;
  for (Table& table : root.tables("procedures")) {
    const bool several = table.has("stimulus");  // of quest_plus
    const char* key = several ? "stimulus" : "variable";
    for (const std::string& variable :
         several ? table.table(key).keys_as_written() : std::vector{table.text(key)}) {
      if (!variables.insert(variable).second) {
        table.reject(key, fmt::format("\"{}\"", variable),
                     "a variable that no other procedure sets; tracks of one procedure are its "
                     "[[procedures.tracks]]");
      }
    }
  }
  Table stated = root.has("variables") ? root.table("variables") : root;
  for (const std::string& variable : variables) {
    if (variables.size() > 1 && (!root.has("variables") || !stated.has(variable))) {
      root.reject("procedures",
                  fmt::format("set {} in some trials only; add its value in the others to "
                              "[variables]",
                              variable));
    }
  }
}

void check_seen_objects(Table& root, const TrialsDefinition& d,
                        const std::vector<NamedStage>& stages) {
  for (const NamedStage& stage : stages) {
    const auto seen = std::ranges::count_if(stage.show, [&](const std::string& name) {
      return std::ranges::find(d.objects, name, &TrialObject::name) != d.objects.end();
    });
    if (seen > static_cast<std::ptrdiff_t>(kMostSeenObjects)) {
      root.reject("stages", fmt::format("show {} objects in the stage \"{}\"; show at most {}",
                                        seen, stage.name, kMostSeenObjects));
    }
  }
}

void check_questions(Table& root, const TrialsDefinition& d,
                     const std::vector<NamedStage>& stages) {
  for (const Question& question : d.questions) {
    const auto named = [&](const NamedStage& stage) { return stage.name == question.onset; };
    if (!question.onset.empty() && std::none_of(stages.begin(), stages.end(), named)) {
      root.reject(root.has("response") ? "response" : "responses",
                  fmt::format("counts the reaction from the stage \"{}\", which is not there",
                              question.onset));
    }
  }
}

/// The values of the first trial that could come: the first level of every factor, the lowest of
/// every track.
TrialValues sample_values(const TrialsDefinition& d, std::size_t block) {
  TrialValues values;
  values.block = block;
  values.group = d.groups.empty() ? "" : d.groups.front().name;
  for (std::size_t i = 0; i < d.intervals.size(); ++i) {
    values.intervals.push_back(i);
  }
  for (const Track& track : d.tracks) {
    give_corner(track, false, values);
  }
  for (const Factor& factor : d.order.factors) {
    values.values.push_back({factor.name, factor.levels.front()});
  }
  const Block& given = d.order.blocks[block];
  values.values.insert(values.values.end(), given.values.begin(), given.values.end());
  return values;
}

/// Fields that are passive only in continuous time: a held force gives energy at each tick, which
/// the damping of device and hand must take up (needed_damping.h).
void note_restless(const std::vector<scene::Field>& fields, TrialsDefinition& d) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (std::holds_alternative<scene::YieldingParameters>(fields[i].kind)) {
      continue;  // that is told of the body itself
    }
    const scene::Steepness steepness = scene::steepness(fields, i);
    const double needed = scene::needed_damping_below(0.0, steepness, d.rate);
    if (steepness.passive && needed > d.hand.damping) {
      d.restless.push_back(fmt::format(
          "the force of {}.{} changes by up to {:.0f} N for each metre: at {:g} Hz it stays calm "
          "with {:.3g} N·s/m of damping, and the hand of [hand] has {:g}",
          scene::is_object(fields[i]) ? "objects" : "fields", fields[i].name, steepness.stiffness,
          d.rate, needed, d.hand.damping));
    }
  }
}

/// Everything that a first trial would read: so that a mistake has its line.
void read_first_trial(Table& root, TrialsDefinition& d) {
  const std::unique_ptr<Names> names = read_names(root, d);
  names->check(root);
  std::vector<NamedStage> stages;
  if (d.order.blocks.empty()) {
    return;
  }
  for (std::size_t place = 0; place < d.intervals.size(); ++place) {
    try {
      give(*names, d, sample_values(d, 0));
      give_interval(*names, d.intervals[place], place);
    } catch (const InputError& error) {
      root.reject("experiment", fmt::format("cannot begin: {}", error.what()));
      return;
    }
    Presented presented = read_presented(root, *names, d, nullptr);
    if (place == 0) {
      note_restless(presented.fields, d);
    }
    stages = std::move(presented.stages);
  }
  for (const NamedStage& stage : stages) {
    d.stages.push_back(stage.name);
    d.stage_markers.push_back(stage.marker);
    d.markers.used = d.markers.used || stage.marker > 0;
    const Until& until = stage.stage.until;
    d.stage_time +=
        std::max(until.time, until.hold) + (std::isfinite(stage.stage.timeout) ? 1.0 : 0.0);
  }
  check_seen_objects(root, d, stages);
  check_questions(root, d, stages);
  check_masking(root, d);
}

}  // namespace

Table parsed_trials(const Definition& d) {
  Table root = Table::parse(d.text, d.file_name);
  root.fill_in(trials_defaults());
  return root;
}

std::unique_ptr<Names> read_names(Table& root, const TrialsDefinition& d) {
  auto names = std::make_unique<Names>();
  declare_names(*names, d);
  names->read(root);
  return names;
}

namespace {

/// Fields, and behind them the objects, which are felt as fields.
void read_what_is_felt(Table& root, const Names& names, const TrialsDefinition& d,
                       Presented& presented) {
  DeviceOf devices;
  std::vector<scene::Field> objects;
  if (root.has("objects")) {
    Table table = root.table("objects");
    devices = devices_of(table, d.hands);
    for (const std::string& name : table.keys()) {
      const auto object = std::ranges::find(d.objects, name, &TrialObject::name);
      Table own = table.table(name);
      const bool known = object != d.objects.end();
      objects.push_back(known && object->yields
                            ? scene::read_yielding(own, name, object->felt, names)
                            : scene::read_solid(own, name, known ? object->body : nullptr, names));
    }
  }
  if (root.has("fields")) {
    Table table = root.table("fields");
    devices.merge(devices_of(table, d.hands));
    presented.fields = scene::read_fields(table, d.rate, names, objects);
    for (scene::Field& field : presented.fields) {
      if (auto* path = std::get_if<scene::PathParameters>(&field.kind)) {
        path->loop = handle_loop(d);
      }
    }
  }
  presented.fields.insert(presented.fields.end(), objects.begin(), objects.end());
  presented.felt = felt_by(presented.fields, devices, d.hands);
}

/// A stage names fields, regions, looks and objects: each name stands for one thing.
void check_object_names(Table& root) {
  Table objects = root.table("objects");
  for (const char* other : {"fields", "regions", "looks"}) {
    const std::vector<std::string> taken =
        root.has(other) ? root.table(other).keys() : std::vector<std::string>{};
    for (const std::string& name : objects.keys_as_written()) {
      if (std::ranges::find(taken, name) != taken.end()) {
        objects.reject(name, fmt::format("is the name of a table of [{}] as well; give one of the "
                                         "two another name",
                                         other));
      }
    }
  }
}

}  // namespace

Presented read_presented(Table& root, const Names& names, const TrialsDefinition& d,
                         RandomStream* random) {
  Presented presented;
  std::vector<std::string> fields, regions;
  std::vector<std::string> sights{"hand", "interval_number"};
  read_what_is_felt(root, names, d, presented);
  presented.felt.resize(static_cast<std::size_t>(d.devices()), 0);
  if (root.has("regions")) {
    Table table = root.table("regions");
    const DeviceOf devices = devices_of(table, d.hands);
    presented.regions = scene::read_regions(table, names);
    for (const scene::Region& region : presented.regions) {
      const auto own = devices.find(region.name);
      presented.region_devices.push_back(own == devices.end() ? 0 : own->second);
    }
  }
  if (root.has("looks")) {
    Table table = root.table("looks");
    presented.looks = read_looks(table, names);
  }
  for (const scene::Field& field : presented.fields) {
    fields.push_back(field.name);
  }
  for (const scene::Region& region : presented.regions) {
    regions.push_back(region.name);
    sights.push_back(region.name);
  }
  for (const Look& look : presented.looks) {
    sights.push_back(look.name);
  }
  for (const TrialObject& object : d.objects) {
    sights.push_back(object.name);
  }
  const std::vector<std::string> places = names.places();
  sights.insert(sights.end(), places.begin(), places.end());
  const StageSource source{
      fields,
      regions,
      names,
      [&names](const std::string& text) { return names.word(text); },
      random,
      root.has("sounds") ? sound::cue_names(root.table("sounds")) : std::vector<std::string>{},
      sights};
  presented.stages = read_stages(root, source);
  return presented;
}

int right_choice(const Names& names, const Question& question) {
  const double value = names.value(question.correct);
  const auto word = names.word_of(value);
  const auto count = static_cast<int>(question.choices.size());
  for (int i = 0; i < count; ++i) {
    const bool right = word ? question.choices[static_cast<std::size_t>(i)].value == *word
                            : value == question.first + i;
    if (right) {
      return i;
    }
  }
  throw InputError(fmt::format("the right answer to \"{}\" is {} (\"{}\"), which is no choice",
                               question.text, word ? *word : fmt::format("{:g}", value),
                               question.correct));
}

void read_trials_definition(Table& root, std::string_view file_name, TrialsDefinition& d) {
  root.fill_in(trials_defaults());
  root.leave("analysis");
  if (root.has("power")) {
    root.leave("power");  // of who simulates it
  }
  root.leave("groups");
  read_common(root, file_name, d);
  d.protocol = kTrials;
  read_view(root, d);
  d.hands = read_devices(root);
  read_sounds(root, d);
  d.groups = study_groups(root.source(), file_name);
  if (root.has("objects")) {
    Table table = root.table("objects");
    d.objects = read_objects(table);
    check_object_names(root);
  }
  d.questions = read_questions(root, d.keys);
  d.tracks = psychometric::read_tracks(root);
  d.script = read_level_script(root);
  d.order = read_trial_design(root, !d.tracks.empty());
  read_intervals(root, d);
  check_common(root, d);
  check_tracks(root, d);
  check_learning(root, d);
  check_variables(root);
  read_first_trial(root, d);
  d.design.participants = d.order.participants;
  d.design.break_after = d.order.break_after;
  d.design.break_duration = d.order.break_duration;
  d.design.break_until_ready = d.order.break_until_ready;
  d.design.trials = std::max(1, d.most_trials());
  d.design.practice = d.practice_trials();
  d.design.repetitions = 1;
}

}  // namespace haptrial::protocols
