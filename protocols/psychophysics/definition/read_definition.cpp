#include "protocols/psychophysics/definition/read_definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/psychometric/definition/read_tracks.h"
#include "core/sound/read_cues.h"
#include "protocols/definition/mirroring.h"
#include "protocols/definition/speech_options.h"
#include "protocols/definition/window_keys.h"
#include "protocols/psychophysics/definition/check_definition.h"
#include "protocols/psychophysics/definition/defaults.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/definition/trial_devices.h"
#include "protocols/psychophysics/definition/trial_values.h"

namespace haptrial::protocols {
namespace {

const Schema<TwoEyes>& two_eyes_schema() {
  using E = TwoEyes;
  static const auto schema =
      Schema<E>()
          .number("eye_distance", &E::eye_distance, {0.02, 0.2}, "m",
                  "Distance between the participant's eyes, for pictures of two eyes")
          .number("viewing_distance", &E::viewing_distance, {0.1, 10.0}, "m",
                  "Distance from the participant's eyes to the screen");
  return schema;
}

const Schema<TrialsView>& view_schema() {
  using V = TrialsView;
  static const auto schema =
      Schema<V>()
          .choice("seen_from", &V::from_above, {{"above", true}, {"front", false}},
                  "Direction from which the world is drawn: above, x to the right and z down the "
                  "screen, or front, x to the right and y up")
          .required()
          .number("extent", &V::width, {0.01, 1.0}, "m",
                  "Length of the part of the world that fills the width of the screen")
          .required()
          .number("hand_radius", &V::hand_radius, {0.0005, 0.05}, "m",
                  "Radius of the dot that stands for the hand")
          .required()
          .flag("stereo", &V::stereo,
                "Whether pictures for the left and the right eye are shown side by side")
          .keys_of(&V::eyes, two_eyes_schema());
  return schema;
}

/// Reader of a key that names a sound of the definition, which is kept as its number.
auto cue_reader(int TrialsDefinition::*member) {
  return [member](Table& table, const std::string& key, TrialsDefinition& d) {
    const std::string name = table.text(key);
    const auto found = std::ranges::find(d.cues.cues, name, &sound::Cue::name);
    if (found == d.cues.cues.end()) {
      table.reject(key, fmt::format("\"{}\"", name), "a sound of [sounds]");
    }
    d.*member = static_cast<int>(found - d.cues.cues.begin());
  };
}

/// Reader of a key whose text participants read.
auto shown_reader(std::string TrialsDefinition::*member) {
  return [member](Table& table, const std::string& key, TrialsDefinition& d) {
    d.*member = table.shown_text(key);
  };
}

const Schema<TrialsDefinition>& feedback_schema() {
  using D = TrialsDefinition;
  static const auto schema =
      Schema<D>()
          .custom("feedback_right", "Text that is shown after a right answer",
                  shown_reader(&D::feedback_right))
          .required()
          .custom("feedback_wrong", "Text that is shown after a wrong answer",
                  shown_reader(&D::feedback_wrong))
          .required()
          .number("feedback_time", &D::feedback_time, {0.0, 10.0}, "s",
                  "Time for which the feedback on an answer is shown")
          .required()
          .custom("sound_right", "Sound after a right answer, if feedback is given",
                  cue_reader(&D::sound_right))
          .otherwise("none")
          .custom("sound_wrong", "Sound after a wrong answer, if feedback is given",
                  cue_reader(&D::sound_wrong))
          .otherwise("none");
  return schema;
}

/// Speech is never heard over noise that masks the device.
void read_speech(Table& table, TrialsDefinition& d) {
  if (!speech_schema().read(table).spoken) {
    return;
  }
  d.markers.used = true;  // which have the sound card
  if (d.cues.masking && d.cues.masking->stages.empty()) {
    table.reject("spoken",
                 "is true, but sounds.masking sounds throughout the session, and nothing "
                 "is spoken over it; add stages to [sounds.masking]");
  }
}

/// Reads [sounds] and, as feedback may name them, [display].
void read_display(Table& root, TrialsDefinition& d) {
  if (root.has("sounds")) {
    Table table = root.table("sounds");
    d.cues = sound::read_cues(table, d.actuators);
    d.markers.used = true;
  }
  Table table = root.table("display");
  d.display = render::trial_display_schema().read(table);
  view_schema().read(table, d.view);
  feedback_schema().read(table, d);
  read_speech(table, d);
  if (root.has("looks") && !d.view.stereo) {
    table.reject("stereo",
                 "is not true, but a bar of random dots is seen with two eyes only; add stereo = "
                 "true, which shows the eyes' pictures side by side");
  }
}

std::vector<GivenValue> interval_values(Table& table) {
  std::vector<GivenValue> values;
  for (const std::string& key : table.keys()) {
    table.describe({key, "Value of the name in the interval: a number, formula or word", "", true});
    const auto text = table.whole_text(key);
    values.push_back({key, text ? *text : formula_of_value(table, key)});
  }
  return values;
}

const Schema<TrialsDefinition>& interval_order_schema() {
  static const auto schema = Schema<TrialsDefinition>().choice(
      "order", &TrialsDefinition::random_intervals, {{"as stated", false}, {"random", true}},
      "Order of the intervals in a trial");
  return schema;
}

void read_intervals(Table& root, TrialsDefinition& d) {
  if (!root.has("intervals")) {
    d.intervals.push_back({"only", {}});
    return;
  }
  Table table = root.table("intervals");
  interval_order_schema().read(table, d);
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
    d.stage_buttons.push_back(stage.stage.until.buttons);
    d.markers.used = d.markers.used || stage.marker > 0;
    const Until& until = stage.stage.until;
    d.stage_time += until.soonest() + (std::isfinite(stage.stage.timeout) ? 1.0 : 0.0);
  }
}

/// Everything that a first trial would read: so that a mistake has its line.
void read_first_trial(Table& root, TrialsDefinition& d) {
  const std::unique_ptr<Names> names = read_names(root, d);
  names->check(root);
  Presented first;
  if (d.order.blocks.empty()) {
    static_cast<void>(root.misspelled("blocks"));
    root.check();  // of stages and fields nothing was read, so that nothing of them would be known
    return;
  }
  for (std::size_t place = 0; place < d.intervals.size(); ++place) {
    try {
      give(*names, d, sample_values(d, 0));
      give_interval(*names, d.intervals[place], place);
      first = read_presented(root, *names, d, nullptr);
    } catch (const InputError& error) {
      root.reject("experiment", fmt::format("cannot begin with the block {}: {}",
                                            d.order.blocks.front().name, error.what()));
      root.check();  // what is not read after this would count as not known
    }
  }
  keep_stages(first.stages, d);
  d.measures = first.measures;
  check_stages(root, d, first.stages);
}

}  // namespace

std::unique_ptr<Names> read_names(Table& root, const TrialsDefinition& d) {
  auto names = std::make_unique<Names>();
  declare_names(*names, d);
  if (root.has("measures")) {
    for (const std::string& measure : root.table("measures").keys_as_written()) {
      names->declare(measure);
    }
  }
  names->read(root);
  return names;
}

int right_choice(const Names& names, const TrialQuestion& question) {
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
  d.session_plans = d.order.session_plans;
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
  read_display(root, d);
  d.hands = read_devices(root);
  read_all_objects(root, d);
  d.questions = read_questions(root, d.keys);
  check_marks(root, d);
  note_keys_of_stages(root, d.keys);
  d.tracks = psychometric::read_tracks(root);
  d.script = read_level_script(root);
  d.order = read_trial_design(root, !d.tracks.empty());
  d.design.participants = d.order.participants;
  read_intervals(root, d);
  Table design = root.table("design");
  read_mirroring(design, d);
  check_common(root, d);
  check_procedures(root, d);
  read_first_trial(root, d);
  plan(d);
}

}  // namespace haptrial::protocols
