#include "protocols/psychophysics/definition/read_definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/psychometric/definition/read_tracks.h"
#include "core/sound/read_cues.h"
#include "protocols/definition/window_keys.h"
#include "protocols/psychophysics/definition/check_definition.h"
#include "protocols/psychophysics/definition/defaults.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/definition/trial_devices.h"
#include "protocols/psychophysics/definition/trial_values.h"

namespace haptrial::protocols {
namespace {

void read_view(Table& root, TrialsDefinition& d) {
  Table table = root.table("display");
  d.display = render::trial_display_schema().read(table);
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

/// The values of the first trial that could come: the first level of every factor, the lowest of
/// every track.
TrialValues sample_values(const TrialsDefinition& d, std::size_t block) {
  TrialValues values;
  values.block = block;
  values.group = d.groups.empty() ? "" : d.groups.front().name;
  for (std::size_t i = 0; i < d.intervals.size(); ++i) {
    values.intervals.push_back(i);
  }
  give_corners(d, false, values);
  for (const Factor& factor : d.order.factors) {
    values.values.push_back({factor.name, factor.levels.front()});
  }
  const Block& given = d.order.blocks[block];
  values.values.insert(values.values.end(), given.values.begin(), given.values.end());
  return values;
}

void keep_stages(const std::vector<NamedStage>& stages, TrialsDefinition& d) {
  for (const NamedStage& stage : stages) {
    d.stages.push_back(stage.name);
    d.stage_markers.push_back(stage.marker);
    d.markers.used = d.markers.used || stage.marker > 0;
    const Until& until = stage.stage.until;
    d.stage_time +=
        std::max(until.time, until.hold) + (std::isfinite(stage.stage.timeout) ? 1.0 : 0.0);
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
      stages = read_presented(root, *names, d, nullptr).stages;
    } catch (const InputError& error) {
      root.reject("experiment", fmt::format("cannot begin with the block {}: {}",
                                            d.order.blocks.front().name, error.what()));
      root.check();  // what is not read after this would count as not known
    }
  }
  keep_stages(stages, d);
  check_stages(root, d, stages);
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

namespace {

/// Other programs read these.
void leave_to_others(Table& root) {
  root.leave("analysis");
  if (root.has("power")) {
    root.leave("power");  // of who simulates it
  }
  root.leave("groups");
}

void read_all_objects(Table& root, TrialsDefinition& d) {
  if (root.has("objects")) {
    Table table = root.table("objects");
    d.objects = read_objects(table);
    check_object_names(root);
  }
}

/// Plans the definition's sessions.
void plan(TrialsDefinition& d) {
  d.design.participants = d.order.participants;
  d.design.break_after = d.order.break_after;
  d.design.break_duration = d.order.break_duration;
  d.design.break_until_ready = d.order.break_until_ready;
  d.design.trials = std::max(1, d.most_trials());
  d.design.practice = d.practice_trials();
  d.design.repetitions = 1;
}

/// Gives a bit to each key that ends a stage: it may answer no question.
void note_keys_of_stages(Table& root, KeyBits& keys) {
  if (!root.has("stages")) {
    return;
  }
  for (Table& stage : root.tables("stages")) {
    if (stage.has("until") && stage.table("until").has("keys")) {
      Table until = stage.table("until");
      for (const int code : read_window_keys(until, "keys")) {
        keys.bit_of(code);
      }
    }
  }
}

}  // namespace

void read_trials_definition(Table& root, std::string_view file_name, TrialsDefinition& d) {
  root.fill_in(trials_defaults());
  leave_to_others(root);
  read_common(root, file_name, d);
  d.protocol = kTrials;
  read_view(root, d);
  d.hands = read_devices(root);
  read_sounds(root, d);
  d.groups = study_groups(root.source(), file_name);
  read_all_objects(root, d);
  d.questions = read_questions(root, d.keys);
  note_keys_of_stages(root, d.keys);
  d.tracks = psychometric::read_tracks(root);
  d.script = read_level_script(root);
  d.order = read_trial_design(root, !d.tracks.empty());
  read_intervals(root, d);
  check_common(root, d);
  check_procedures(root, d);
  read_first_trial(root, d);
  plan(d);
}

}  // namespace haptrial::protocols
