#include "protocols/psychophysics/defined_trials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/record/read/session_reader.h"
#include "protocols/psychophysics/objects/deformable_bodies.h"
#include "protocols/psychophysics/objects/object_files.h"
#include "protocols/psychophysics/presentation/pass_rows.h"
#include "protocols/psychophysics/presentation/stage_sight.h"
#include "protocols/psychophysics/presentation/trial_drawing.h"
#include "protocols/psychophysics/subject/trials_rig.h"

namespace haptrial::protocols {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Fields whose force is to work on the hand, a bit each: all but those that only give way.
std::uint64_t active_fields(const std::vector<scene::Field>& fields) {
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    mask |= scene::traits_of(fields[i]).yields ? 0 : std::uint64_t{1} << i;
  }
  return mask;
}

bool is_told(Feedback feedback, bool practice) {
  return feedback == Feedback::kAlways || (feedback == Feedback::kPractice && practice);
}

bool records_contacts(const TrialsDefinition& d) {
  return std::ranges::any_of(d.objects, &TrialObject::recorded);
}

/// Objects come behind all other fields, in the order of the definition's.
std::vector<RecordedObject> recorded_of(const TrialsDefinition& d, std::size_t fields) {
  std::vector<RecordedObject> recorded;
  for (std::size_t i = 0; i < d.objects.size(); ++i) {
    if (d.objects[i].recorded) {
      recorded.push_back({fields - d.objects.size() + i, static_cast<std::int32_t>(i)});
    }
  }
  return recorded;
}

}  // namespace

std::vector<std::string> blocks_of(const TrialsDefinition& definition, const SessionPlace& place) {
  const TrialSequence sequence(definition, identity_of(definition, place));
  std::vector<std::string> names;
  for (const std::size_t block : sequence.blocks()) {
    names.push_back(definition.order.blocks[block].name);
  }
  return names;
}

DefinedTrials::DefinedTrials(const StudiedDefinition& definition, const SessionPlace& place)
    : d_(definition),
      place_(place),
      root_(definition.root()),
      names_(read_names(root_, definition)),
      scripts_(definition, place_),
      sequence_(std::in_place, definition, identity_of(definition, place)),
      object_files_(object_files(definition.objects, definition.cues.cues)),
      arms_(arm_rows(definition.hands)),
      touched_bodies_(definition.objects) {
  const auto open = [this](bool has, auto& log) {
    if (has) {
      kept_.keep(log.emplace());
    }
  };
  open(records_contacts(d_), contacts_);
  open(root_.has("cursor"), cursors_);
  open(root_.has("targets"), targets_);
  scripts_.direct(*sequence_);
}

void DefinedTrials::prepare(const PlannedTrial&, SessionFile& file) {
  scripts_.write(file, rig_ != nullptr);
}

Extent DefinedTrials::extent(int most) const {
  const int trials = d_.most_trials(place_.session);
  int blocks = 0;
  for (const std::size_t block : d_.order.blocks_of(place_.session)) {
    blocks += d_.order.blocks[block].practice ? 0 : 1;
  }
  return {most > 0 ? std::min(most, trials) : trials, d_.practice_trials(place_.session), blocks};
}

std::span<const record::Phase> DefinedTrials::phases() const {
  static constexpr std::array kPhases{record::Phase(record::kPresentedPhase)};
  return kPhases;
}

record::TableList DefinedTrials::tables() const {
  record::TableList tables = record::trial_tables();
  if (!d_.questions.empty() || !d_.measures.empty()) {
    tables.push_back(&record::responses_table());
  }
  if (adapts()) {
    tables.push_back(&record::table_of<record::AdaptationRow>());
  }
  if (std::ranges::any_of(d_.questions, &TrialQuestion::has_limits)) {
    tables.push_back(&record::table_of<record::OutOfTimeRow>());
  }
  tables = record::with_tables(std::move(tables), kept_.tables());
  touched_bodies_.add_tables(tables);
  if (!object_files_.empty()) {
    tables.push_back(&record::table_of<record::ObjectFileRow>());
  }
  if (!arms_.empty()) {
    tables.push_back(&record::table_of<record::ArmRow>());
  }
  return tables;
}

std::vector<record::Rows> DefinedTrials::first_rows() const {
  std::vector<record::Rows> rows;
  if (!object_files_.empty()) {
    rows.emplace_back(std::span<const record::ObjectFileRow>(object_files_));
  }
  if (!arms_.empty()) {
    rows.emplace_back(std::span<const record::ArmRow>(arms_));
  }
  return rows;
}

/// A virtual participant goes on as if the session had not been interrupted.
void DefinedTrials::check_resumed(const record::SessionReader& file) const {
  check_object_files(file, object_files_, "resume");
  if (rig_ == nullptr) {
    return;
  }
  CarriedOver before;
  for (const record::ResponseRow& row : file.responses()) {
    if (!d_.questions.empty() && d_.questions.front().has_choices() &&
        row.question == d_.questions.front().name) {
      before.previous = static_cast<int>(std::lround(row.value - d_.questions.front().first));
    }
  }
  if (const auto learnt = file.rows<record::AdaptationRow>(); !learnt.empty()) {
    before.fast = learnt.back().fast;
    before.slow = learnt.back().slow;
  }
  rig_->recall(before);
}

std::unique_ptr<Rig> DefinedTrials::virtual_rig() const {
  said_ = std::make_unique<SimulatedAnswer>();
  TrialsRig::Briefing briefing{&d_, &d_.observer, &d_.questions, d_.stages, &d_.hands, said_.get()};
  briefing.screen = {d_.view.from_above};
  if (scripts_.decisions() != nullptr) {
    briefing.decide = [this](const LeftDecision::DecisionRequest& asked) {
      const PlannedTrial& plan = current_.plan;
      return scripts_.decisions()->decide({plan.trial, plan.practice, variables_},
                                          d_.questions[asked.question], asked);
    };
  }
  auto rig =
      std::make_unique<TrialsRig>(briefing, place_.hand_person_seed, place_.hand_session_seed);
  rig_ = rig.get();
  return rig;
}

std::optional<PlannedTrial> DefinedTrials::next(const Outcome* last) {
  if (last != nullptr) {
    outcomes_.push_back(*last);
    const bool done = last->end == TrialEnd::kCompleted;
    const bool right = !last->responses.empty() && last->responses.front().correct == 1;
    if (done && comes_again(last->responses)) {
      sequence_->postpone();
    } else {
      live_.conclude(*last);
      sequence_->conclude(done, done ? outcome_of(last->responses) : kNone, right);
      if (done && scripts_.decisions() != nullptr) {
        scripts_.decisions()->told(last->trial.trial, last->trial.practice, last->responses);
      }
    }
  }
  const std::optional<NextTrial> next = sequence_->next();
  if (!next) {
    return std::nullopt;
  }
  current_ = *next;
  live_.begin(current_, sequence_->running());
  return current_.plan;
}

std::optional<PlannedTrial> DefinedTrials::take_back() {
  if (outcomes_.empty() || !can_take_back()) {
    return std::nullopt;
  }
  std::vector<Outcome> kept = std::exchange(outcomes_, {});
  kept.pop_back();
  sequence_.emplace(d_, identity_of(d_, place_));
  live_ = {};
  std::optional<PlannedTrial> trial = next(nullptr);
  for (const Outcome& outcome : kept) {
    trial = next(&outcome);
  }
  return trial;
}

/// Whether an answer came too early or too late for its trial to count. It follows from what is
/// recorded, as what a procedure learns.
bool DefinedTrials::comes_again(const std::vector<record::ResponseRow>& responses) const {
  return std::ranges::any_of(responses, [this](const record::ResponseRow& row) {
    const auto at = std::ranges::find(d_.questions, row.question, &TrialQuestion::name);
    return at != d_.questions.end() && at->again && at->pace_of(row.reaction_time) != Pace::kInTime;
  });
}

/// Value that the procedure learns from a trial. A session that is resumed computes it from what is
/// recorded, so it follows from the responses alone. Without a response it learns nothing, nor from
/// a formula of a measure that has no value, as of a channel that fell silent: all else was
/// checked.
double DefinedTrials::outcome_of(const std::vector<record::ResponseRow>& responses) {
  if (current_.track < 0 || responses.empty()) {
    return kNone;
  }
  const Track& track = *sequence_->running()[static_cast<std::size_t>(current_.track)].track;
  if (track.counts.empty()) {
    return !responses.empty() && responses.front().correct >= 0 ? responses.front().correct : kNone;
  }
  give(*names_, d_, current_.values);
  for (const record::ResponseRow& row : responses) {
    if (std::isfinite(row.value)) {
      names_->set(row.question, row.value);
    }
  }
  try {
    return names_->value(track.counts);
  } catch (const InputError&) {
    return kNone;
  }
}

MakeDrawing DefinedTrials::drawing() { return trial_drawing(d_, bodies_); }

Pass& DefinedTrials::make_pass(PlannedTrial&, const record::Phase&) {
  const bool practice = current_.plan.practice;
  TrialPass::Setup setup;
  setup.trial = current_.plan.trial + (practice ? kPracticeNumbers : 0);
  setup.feedback_time = d_.feedback_time;
  setup.most_repeats = d_.most_repeats;
  std::ranges::transform(d_.arms(), setup.max_force.begin(),
                         [](const DeviceArm& arm) { return arm.limits.max_force; });
  setup.said = said_.get();
  setup.left = rig_ != nullptr ? rig_->left() : nullptr;
  setup.contacts = contacts_ ? &*contacts_ : nullptr;
  setup.cursors = cursors_ ? &*cursors_ : nullptr;
  setup.targets = targets_ ? &*targets_ : nullptr;
  variables_.clear();
  stages_.clear();
  varied_cues_.clear();
  give(*names_, d_, current_.values);
  note_variables(0, variables_);
  RandomStream random(current_.plan.stimulus_seed, "durations");
  for (std::size_t place = 0; place < current_.values.intervals.size(); ++place) {
    setup.intervals.push_back(make_interval(place, random));
  }
  setup.sound_right = sound_of_interval(d_.sound_right);
  setup.sound_wrong = sound_of_interval(d_.sound_wrong);
  give(*names_, d_, current_.values);
  setup.questions = make_questions();
  setup.measures = take_measures();
  pass_ = std::make_unique<TrialPass>(std::move(setup));
  return *pass_;
}

/// So that the screen knows how what it shows gives way.
void DefinedTrials::number_bodies(const std::vector<scene::Field>& fields,
                                  std::vector<StageSight>& sights) {
  for (StageSight& sight : sights) {
    for (SeenObject& seen : sight.objects) {
      const auto object = static_cast<std::size_t>(seen.object);
      const scene::Field& field = fields[fields.size() - d_.objects.size() + object];
      const auto* body = std::get_if<scene::DeformableObjectParameters>(&field.kind);
      if (body != nullptr && body->prepared() && d_.objects[object].seen_yielding) {
        seen.body = bodies_->number_of({body->body, body->moving, body->shape});
      }
    }
  }
}

/// Bodies of their own rate come as late as they did.
void DefinedTrials::be_late_again(std::size_t interval, std::vector<scene::Field>& fields) const {
  for (scene::Field& field : fields) {
    if (auto* body = std::get_if<scene::DeformableObjectParameters>(&field.kind)) {
      for (const record::LateWindowRow& row : late_again_) {
        if (std::cmp_equal(row.interval, interval + 1) && row.object == field.name) {
          body->rates.late.push_back({row.tick, row.ticks});
        }
      }
    }
  }
}

IntervalRun DefinedTrials::make_interval(std::size_t place, RandomStream& random) {
  give(*names_, d_, current_.values);
  give_interval(*names_, d_.intervals[current_.values.intervals[place]], place);
  note_variables(place + 1, variables_);
  Presented presented = read_presented(root_, *names_, d_, &random);
  root_.check();
  prepare_bodies(presented.fields, d_.rate, place_.real && !repeats_);
  if (repeats_) {
    be_late_again(place, presented.fields);
  }
  const std::uint64_t seed =
      derived_seed(current_.plan.stimulus_seed, fmt::format("dots {}", place));
  std::vector<Stage> stages;
  std::vector<StageSight> sights;
  varied_cues_.insert(varied_cues_.end(), presented.varied_cues.begin(),
                      presented.varied_cues.end());
  for (const NamedStage& stage : presented.stages) {
    stages.push_back(stage.stage);
    sights.push_back(sight_of(stage, presented, *names_, seed));
    sights.back().sound = sound_of_interval(sights.back().sound);
  }
  number_bodies(presented.fields, sights);
  regions_ = presented.regions;
  region_devices_ = presented.region_devices;
  std::vector<StageRegion> regions;
  for (std::size_t i = 0; i < presented.regions.size(); ++i) {
    regions.push_back({scene::PlacedShape(presented.regions[i].shape), presented.region_devices[i],
                       presented.of_cursor[i]});
  }
  std::vector<scene::Scene> scenes;
  for (std::size_t device = 0; device < presented.felt.size(); ++device) {
    scenes.emplace_back(presented.fields, d_.rate);
  }
  stages_.push_back(std::move(presented.stages));
  std::vector<ShownTarget> targets;
  for (const MovingTarget& target : presented.targets) {
    targets.push_back({target});
  }
  std::vector<Measurement> measurements;
  for (const Measure& measure : presented.measures) {
    measurements.emplace_back(measure, d_.rate);
  }
  return {
      std::move(scenes),
      StageMachine(std::move(stages), std::move(regions), presented.fields.size(), presented.felt),
      std::move(sights),
      active_fields(presented.fields),
      d_.intervals.size() > 1 ? static_cast<int>(current_.values.intervals[place]) : -1,
      recorded_of(d_, presented.fields.size()),
      presented.fields.size() - d_.objects.size(),
      cursor_of(presented, place),
      std::move(targets),
      std::move(measurements)};
}

std::optional<Cursor> DefinedTrials::cursor_of(const Presented& presented,
                                               std::size_t place) const {
  if (!presented.cursor) {
    return std::nullopt;
  }
  const std::uint64_t seed =
      derived_seed(current_.plan.stimulus_seed, fmt::format("cursor {}", place));
  return Cursor(*presented.cursor, ScreenPlane{d_.view.from_above}, d_.rate, seed);
}

/// The number of a sound in the interval that was made last: one that varies has another in each.
int DefinedTrials::sound_of_interval(int sound) const {
  const std::vector<sound::Cue>& all = d_.cues.cues;
  if (sound < 0 || !all[static_cast<std::size_t>(sound)].varies) {
    return sound;
  }
  const auto behind =
      std::count_if(all.begin() + sound, all.end(), std::mem_fn(&sound::Cue::varies));
  return static_cast<int>(all.size() + varied_cues_.size()) - static_cast<int>(behind);
}

std::vector<PresentedQuestion> DefinedTrials::make_questions() {
  std::vector<PresentedQuestion> asked;
  right_.clear();
  int marker = 0;
  for (const TrialQuestion& question : d_.questions) {
    PresentedQuestion each{&question};
    each.marker = marker;
    marker += static_cast<int>(question.answers().size());
    if (!question.correct.empty()) {
      each.right = right_choice(*names_, question);
    }
    each.feedback = is_told(question.feedback, current_.plan.practice);
    for (std::size_t i = 0; !question.onset.empty() && i < stages_.back().size(); ++i) {
      each.onset = stages_.back()[i].name == question.onset ? static_cast<int>(i) : each.onset;
    }
    each.places = places_of(question);
    for (const TouchedPlace& place : each.places) {
      const scene::Region& region = regions_[static_cast<std::size_t>(place.region)];
      each.sight.marks.push_back(mark_to_touch(region.shape, place.device));
    }
    each.sight.hand = !each.places.empty();
    each.rightwards = d_.display.mirrored ? -1.0 : 1.0;
    right_.push_back(each.right);
    asked.push_back(std::move(each));
  }
  return asked;
}

/// The interval in which each measure is taken, and whether it is told.
std::vector<TakenMeasure> DefinedTrials::take_measures() const {
  std::vector<TakenMeasure> taken;
  const std::vector<std::size_t>& order = current_.values.intervals;
  for (const Measure& measure : d_.measures) {
    const auto at = std::ranges::find_if(
        order, [&](std::size_t each) { return std::cmp_equal(each, measure.interval); });
    taken.push_back(
        {at == order.end() ? order.size() - 1 : static_cast<std::size_t>(at - order.begin()),
         is_told(measure.feedback, current_.plan.practice)});
  }
  return taken;
}

/// Regions as they are in the last interval.
std::vector<TouchedPlace> DefinedTrials::places_of(const TrialQuestion& question) const {
  std::vector<TouchedPlace> places;
  for (std::size_t i = 0; i < question.means.size(); ++i) {
    const auto region = std::ranges::find(regions_, question.means[i].touch, &scene::Region::name);
    if (!question.means[i].touch.empty() && region != regions_.end()) {
      const auto index = region - regions_.begin();
      places.push_back({scene::PlacedShape(region->shape),
                        region_devices_[static_cast<std::size_t>(index)], i,
                        static_cast<int>(index)});
    }
  }
  return places;
}

/// Notes the variables: those that differ within the pass have a row for each interval, the others
/// one.
void DefinedTrials::note_variables(std::size_t interval,
                                   std::vector<record::VariableRow>& rows) const {
  for (const auto& [name, value] : names_->known()) {
    const auto word = names_->word_of(value);
    record::VariableRow row{0, static_cast<std::int32_t>(interval), name, word ? kNone : value,
                            word.value_or("")};
    const auto same = [&](const record::VariableRow& each) {
      return each.interval == 0 && each.name == row.name && each.word == row.word &&
             (each.value == row.value || word);
    };
    if (interval == 0 || std::none_of(rows.begin(), rows.end(), same)) {
      rows.push_back(std::move(row));
    }
  }
}

std::vector<record::ResponseRow> DefinedTrials::responses() {
  std::vector<record::ResponseRow> rows = response_rows(*pass_, d_.questions, right_);
  std::ranges::move(measure_rows(*pass_), std::back_inserter(rows));
  return rows;
}

void DefinedTrials::close_pass(SessionFile& file, std::int32_t row) {
  for (record::VariableRow& each : variables_) {
    each.pass = row;
  }
  file.add(std::span<const record::VariableRow>(variables_));
  keep_level(file, row);
  const std::vector<record::StageRow> stages = stage_rows(*pass_, stages_, row);
  file.add(std::span<const record::StageRow>(stages));
  keep_adaptation(file, row);
  if (const auto late = out_of_time_rows(*pass_, d_.questions, row); !late.empty()) {
    file.add(std::span<const record::OutOfTimeRow>(late));
  }
  touched_bodies_.keep(*pass_, row, file);
}

std::string DefinedTrials::why_given_up() const {
  return fmt::format("{}", fmt::join(sequence_->ended_early(), "; "));
}

std::vector<std::string> DefinedTrials::notices() const {
  std::vector<std::string> lines = scripts_.notices();
  const std::vector<std::string> bodies = touched_bodies_.notices();
  lines.insert(lines.end(), bodies.begin(), bodies.end());
  return lines;
}

void DefinedTrials::keep_adaptation(SessionFile& file, std::int32_t row) const {
  if (adapts()) {
    const CarriedOver now = rig_->carried_over();
    const record::AdaptationRow learnt{row, now.fast, now.slow};
    file.add(std::span(&learnt, 1));
  }
}

void DefinedTrials::keep_level(SessionFile& file, std::int32_t row) {
  if (current_.track < 0) {
    return;
  }
  const RunningTrack& running = sequence_->running()[static_cast<std::size_t>(current_.track)];
  const bool done = pass_->state() == PassState::kCompleted && !comes_again(responses());
  std::vector<record::LevelRow> rows;
  const std::vector<std::string> variables = running.track->variables();
  for (std::size_t i = 0; i < current_.asked.size(); ++i) {
    rows.push_back({row, running.name, variables[i], current_.asked[i], current_.applied[i],
                    done ? outcome_of(responses()) : kNone});
  }
  file.add(std::span<const record::LevelRow>(rows));
}

/// Reason with the stage that was aborted, and the region that the hand did not come to.
std::string DefinedTrials::why_aborted() const {
  const std::string why = pass_->why_aborted();
  const std::size_t begun = pass_->intervals_begun();
  if (begun == 0 || pass_->machine(begun - 1).state() != StageMachine::State::kAborted) {
    return why;
  }
  const StageMachine& machine = pass_->machine(begun - 1);
  const std::string stage = stages_[begun - 1][machine.stage()].name;
  const StageMachine::MissedRegion outside = machine.outside();
  const bool late = machine.times()[machine.stage()].how == StageEnd::kLate;
  return !late || outside.region < 0
             ? fmt::format("{}: {}", why, stage)
             : fmt::format("{}: {}, {:.0f} mm from the region {}", why, stage,
                           1e3 * outside.distance,
                           regions_[static_cast<std::size_t>(outside.region)].name);
}

}  // namespace haptrial::protocols
