#include "protocols/psychophysics/presentation/trial_pass.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/questions/question_kind.h"

namespace haptrial::protocols {
namespace {

constexpr double kLongestFade = 1.0;  // into an answer by hand [s]

int lowest_bit(std::uint32_t bits) noexcept { return bits == 0 ? -1 : std::countr_zero(bits); }

}  // namespace

TrialPass::TrialPass(Setup setup)
    : setup_(std::move(setup)),
      first_ticks_(setup_.intervals.size(), 0),
      answers_(setup_.questions.size()) {
  view_.trial = setup_.trial;
}

void TrialPass::begin(std::uint64_t sequence) noexcept {
  sequence_ = sequence;
  begin_interval();
}

/// Keeps the sensation of the interval before, so that it does not jump.
void TrialPass::go_on_feeling() noexcept {
  IntervalRun& run = setup_.intervals[interval_];
  for (std::size_t device = 0; interval_ > 0 && device < run.scenes.size(); ++device) {
    run.scenes[device].start_from(setup_.intervals[interval_ - 1].scenes[device]);
  }
}

void TrialPass::begin_interval() noexcept {
  IntervalRun& run = setup_.intervals[interval_];
  go_on_feeling();
  run.machine.begin(run.scenes, setup_.most_repeats);
  first_ticks_[interval_] = sequence_;
  begun_ = interval_ + 1;
  view_.interval = static_cast<std::uint8_t>(interval_ + 1);
}

void TrialPass::enter_again(std::size_t interval, std::size_t stage) noexcept {
  if (interval != std::exchange(interval_, interval)) {
    go_on_feeling();
  }
  IntervalRun& run = setup_.intervals[interval];
  run.machine.enter(stage, run.scenes);
}

const SeenForces& TrialPass::feel_again(std::span<const PointState> hands) noexcept {
  IntervalRun& run = setup_.intervals[interval_];
  const std::size_t devices = std::min(hands.size(), run.scenes.size());
  for (std::size_t device = 0; device < devices; ++device) {
    run.scenes[device].force(hands[device]);
  }
  view_.pressed.counts = {};
  show_pressed(run, run.sights[run.machine.stage()], devices);
  return view_.pressed;
}

PassOutput TrialPass::tick(const Readings& readings, double dt) noexcept {
  PassOutput out;
  tick_time_ = dt;
  const auto drives_before = std::exchange(drives_, {});
  saturated_ = false;
  device_count_ = std::min(readings.size(), kMostDevices);
  look_at_hands(readings);
  const Part part = part_;  // on this tick, whatever begins with the next
  if (state_ == PassState::kRunning) {
    if (part_ == Part::kIntervals) {
      const IntervalRun& run = setup_.intervals[interval_];
      present(readings, dt, out);
      if (flew_apart(run)) {
        abort("a body was pressed beyond what its steps are stable for and flew apart");
        drives_ = drives_before;  // the end of the pass takes them off without a step
      }
    } else {
      listen(readings, dt, out);
    }
    ++sequence_;
  }
  static_cast<Drive&>(out) = drives_[0];
  out.saturated = saturated_;
  out.shown = stimulus::Shown(view_);
  out.stage = part == Part::kIntervals ? record::Stage::kRun : record::Stage::kWait;
  return out;
}

void TrialPass::look_at_hands(const Readings& readings) noexcept {
  std::uint32_t buttons = 0;
  for (std::size_t device = 0; device < device_count_; ++device) {
    buttons |= readings[device].buttons;
  }
  const std::uint32_t keys = readings[0].keys;  // of the window: all devices are given the same
  pressed_buttons_ = hands_known_ ? buttons & ~buttons_ : 0;
  pressed_keys_ = hands_known_ ? keys & ~keys_ : 0;
  clicked_ = hands_known_ ? readings[0].pointer.buttons & ~clicks_ : 0;
  clicks_ = readings[0].pointer.buttons;
  buttons_ = buttons;
  keys_ = keys;
  hands_known_ = true;
  pedal_ = 0.0;
  for (std::size_t device = 0; device < device_count_; ++device) {
    pedal_ = std::max(pedal_, readings[device].pedal);
  }
  pedal_up_ = std::min(pedal_up_, pedal_);
  view_.tool = readings[0].tool.position;
  view_.other_count = static_cast<std::uint8_t>(device_count_ - 1);
  for (std::size_t device = 1; device < device_count_; ++device) {
    const Eigen::Vector3f p = readings[device].tool.position.cast<float>();
    view_.others[device - 1] = {p.x(), p.y(), p.z()};
  }
}

/// The force on one device, scaled to the limit.
Drive TrialPass::drive(const IntervalRun& run, std::size_t device,
                       const Eigen::Vector3d& force) noexcept {
  const scene::Scene& scene = run.scenes[device];
  Drive drive;
  drive.force = force;
  drive.intent.ended = passed_[device] * scene.ended();
  for (std::size_t field = 0; field < scene.size(); ++field) {
    if ((run.pushing >> field & 1) != 0) {
      drive.intent.push += scene.state(field).force;
    }
    drive.intent.stimulus += scene.state(field).stimulus;
    drive.intent.stored += scene.state(field).stored;
    drive.intent.added += scene.state(field).added;
    saturated_ = saturated_ || scene.state(field).limited;
  }
  const double most = setup_.max_force[device];
  const double size = force.norm();
  passed_[device] = size > most ? most / size : 1.0;
  if (size > most) {
    drive.force *= most / size;
    drive.intent.push *= most / size;
    drive.intent.stimulus *= most / size;
    drive.intent.stored *= most / size;
    drive.intent.added *= most / size;
    saturated_ = true;
  }
  return drive;
}

void TrialPass::log_contacts(const IntervalRun& run, std::size_t device) noexcept {
  for (const RecordedObject& each : run.recorded) {
    const scene::FieldState& state = run.scenes[device].state(each.field);
    if (state.contact && setup_.contacts != nullptr) {
      setup_.contacts->push({sequence_, static_cast<std::int32_t>(device), each.object,
                             state.sliding, state.depth, state.proxy, state.force, state.work});
    }
  }
}

/// Marks of moving targets are where those are on this tick.
void TrialPass::move_targets(IntervalRun& run, double dt) noexcept {
  for (ShownTarget& each : run.targets) {
    each.ticks += each.ticks >= 0 ? 1 : 0;
  }
  for (std::size_t i = 0; i < view_.mark_count; ++i) {
    Mark& mark = view_.marks[i];
    if (mark.target < 0) {
      continue;
    }
    ShownTarget& shown = run.targets[static_cast<std::size_t>(mark.target)];
    shown.ticks = std::max<std::int64_t>(shown.ticks, 0);
    const Eigen::Vector3d place = shown.target.at(static_cast<double>(shown.ticks) * dt);
    const Eigen::Vector3f drawn = place.cast<float>();
    mark.place = {drawn.x(), drawn.y(), drawn.z()};
    if (setup_.targets != nullptr) {
      setup_.targets->push({sequence_, mark.target, place});
    }
  }
}

/// @returns the place of the cursor; that of the tool, if there is none
Eigen::Vector3d TrialPass::move_cursor(IntervalRun& run, const StageSight& sight,
                                       const Readings& readings) noexcept {
  const Eigen::Vector3d& tool = readings[0].tool.position;
  view_.cursor_shown = run.cursor && sight.cursor;
  if (!run.cursor) {
    return tool;
  }
  const Eigen::Vector3d place = run.cursor->follow(tool);
  const Eigen::Vector3f shown = place.cast<float>(), about = run.cursor->about().cast<float>();
  view_.cursor = {shown.x(), shown.y(), shown.z()};
  view_.cursor_about = {about.x(), about.y(), about.z()};
  if (setup_.cursors != nullptr) {
    setup_.cursors->push({sequence_, place, view_.cursor_shown});
  }
  return place;
}

/// Shows the forces on the seen bodies, of all devices together.
void TrialPass::show_pressed(const IntervalRun& run, const StageSight& sight,
                             std::size_t devices) noexcept {
  for (std::size_t i = 0; i < std::min(sight.objects.size(), kMostSeenObjects); ++i) {
    const SeenObject& seen = sight.objects[i];
    const std::size_t field = run.first_object + static_cast<std::size_t>(seen.object);
    for (std::size_t device = 0; seen.body >= 0 && device < devices; ++device) {
      const scene::Scene& scene = run.scenes[device];
      const deformable::BodyTouch* touch = scene.touch(field);
      if (touch != nullptr && scene.state(field).contact) {
        view_.pressed.add(i, touch->forces());
      }
    }
  }
}

/// Notes a stage on its first tick, which /stages names, too.
void TrialPass::note_stage(const IntervalRun& run, PassOutput& out) noexcept {
  const std::size_t stage = run.machine.stage();
  const auto begin = static_cast<std::uint64_t>(run.machine.times()[stage].begin);
  if (first_ticks_[interval_] + begin == stage_begun_) {
    return;
  }
  const bool first = first_ticks_[interval_] == sequence_;
  const auto place = static_cast<std::int16_t>(interval_ + 1);
  stage_begun_ = first_ticks_[interval_] + begin;
  if (first && run.marker >= 0) {
    out.onsets.add({record::MarkerOf::kInterval, static_cast<std::int16_t>(run.marker), place, -1});
  }
  out.onsets.add({record::MarkerOf::kStage, static_cast<std::int16_t>(stage), place,
                  static_cast<std::int16_t>(run.sights[stage].sound)});
}

/// The fields of the interval give this; after the last one, those that fade out do.
void TrialPass::feel(const Readings& readings) noexcept {
  IntervalRun& run = setup_.intervals[interval_];
  const std::size_t devices = std::min(device_count_, run.scenes.size());
  for (std::size_t device = 0; device < devices; ++device) {
    const device::DeviceReading& reading = readings[device];
    drives_[device] = drive(
        run, device, run.scenes[device].force(reading.tool, reading.shares, reading.channels));
  }
}

/// The body was put to rest around the tool and gives no force any more.
bool TrialPass::flew_apart(const IntervalRun& run) const noexcept {
  for (const scene::Scene& scene : run.scenes) {
    for (std::size_t field = run.first_object; field < scene.size(); ++field) {
      const deformable::BodyTouch* touch = scene.touch(field);
      if (touch != nullptr && touch->counts().flown_apart > 0) {
        return true;
      }
    }
  }
  return false;
}

void TrialPass::present(const Readings& readings, double dt, PassOutput& out) noexcept {
  IntervalRun& run = setup_.intervals[interval_];
  const std::size_t stage = run.machine.stage();
  note_stage(run, out);
  const std::size_t devices = std::min(device_count_, run.scenes.size());
  feel(readings);
  for (std::size_t device = 0; device < devices; ++device) {
    log_contacts(run, device);
  }
  view_.stage = static_cast<std::uint8_t>(stage);
  const StageSight& sight = run.sights[stage];
  view_.show(sight.marks, sight.objects, sight.hand, sight.interval_number, sight.dots);
  show_pressed(run, sight, devices);
  move_targets(run, dt);
  const Eigen::Vector3d cursor = move_cursor(run, sight, readings);
  take_measures(run, readings, dt);
  run.machine.tick(readings.all().first(devices), run.scenes, dt, cursor, run.measurements);
  if (run.machine.state() == StageMachine::State::kAborted) {
    const StageEnd how = run.machine.times()[run.machine.stage()].how;
    abort(how == StageEnd::kLate ? "a stage was not done in time"
                                 : "what the stage asks for was not done");
  } else if (run.machine.state() == StageMachine::State::kDone) {
    end_interval();
  }
}

double TrialPass::distance_of(const Measure& measure, const IntervalRun& run,
                              const Eigen::Vector3d& place, double dt) const noexcept {
  if (measure.target < 0) {
    return (place - measure.place).norm();
  }
  const ShownTarget& shown = run.targets[static_cast<std::size_t>(measure.target)];
  const auto ticks = static_cast<double>(std::max<std::int64_t>(shown.ticks, 0));
  return (place - shown.target.at(ticks * dt)).norm();
}

/// One tick of a measure. Forces are those of the fields on this tick.
void TrialPass::take_measure(const IntervalRun& run, const Readings& readings, double dt,
                             Measurement& measurement) const noexcept {
  using Q = MeasuredQuantity;
  const Measure& m = measurement.measure();
  const PointState& tool = readings[m.device].tool;
  const auto felt = [&]() -> const scene::FieldState& {
    return run.scenes[m.device].state(static_cast<std::size_t>(m.field));
  };
  switch (m.quantity) {
    case Q::kForce:
      return measurement.add(m.field < 0 ? drives_[m.device].force.norm() : felt().force.norm());
    case Q::kDepth:
      return measurement.add(felt().depth);
    case Q::kX:
    case Q::kY:
    case Q::kZ:
      return measurement.add(tool.position[static_cast<int>(m.quantity) - static_cast<int>(Q::kX)]);
    case Q::kSpeed:
      return measurement.add(tool.velocity.norm());
    case Q::kDistance:
      return measurement.add(distance_of(m, run, tool.position, dt));
    case Q::kPath:
      return measurement.add_place(tool.position);
    case Q::kTime:
      return measurement.add(dt);
    case Q::kChannel:
      return measurement.add_samples(readings[0].arrived, m.channel,
                                     m.channel < readings[0].channels.size()
                                         ? readings[0].channels[m.channel]
                                         : std::numeric_limits<double>::quiet_NaN(),
                                     run.machine.time_in_stage());
  }
}

void TrialPass::take_measures(IntervalRun& run, const Readings& readings, double dt) noexcept {
  const std::size_t stage = run.machine.stage();
  const bool first = run.machine.time_in_stage() == 0.0;
  for (Measurement& each : run.measurements) {
    if (each.measure().stage != stage || each.measure().device >= device_count_) {
      continue;
    }
    if (first) {
      each.begin();
    }
    take_measure(run, readings, dt, each);
  }
}

/// Tells the participant what was measured; the trial ends after it, or at once if nothing is told.
void TrialPass::tell_measures() noexcept {
  bool told = false;
  view_.verdict = Verdict::kNone;
  for (std::size_t i = 0; i < setup_.measures.size(); ++i) {
    const double value = measurement(i).value();
    const bool tells = setup_.measures[i].told && std::isfinite(value);
    view_.measured[i] = static_cast<float>(tells ? value : std::nan(""));
    const Measure& measure = measurement(i).measure();
    if (tells && measure.judged && view_.verdict != Verdict::kWrong) {
      view_.verdict = measure.is_right(value) ? Verdict::kRight : Verdict::kWrong;
    }
    told = told || tells;
  }
  if (!told || setup_.feedback_time <= 0.0) {
    state_ = PassState::kCompleted;
    return;
  }
  part_ = Part::kResults;
  view_.question = 0;
  view_.pace = Pace::kInTime;
  view_.results = true;
  time_ = 0.0;
}

void TrialPass::end_interval() noexcept {
  if (interval_ + 1 < setup_.intervals.size()) {
    ++interval_;
    ++sequence_;  // the next interval begins with the next tick
    begin_interval();
    --sequence_;
    return;
  }
  // No hand that marks its answer is pushed for long by what the intervals left.
  const bool marks = std::ranges::any_of(setup_.questions, [](const PresentedQuestion& asked) {
    return asked.question->mark.by == MarkedBy::kHand;
  });
  for (scene::Scene& scene : setup_.intervals[interval_].scenes) {
    scene.switch_off(marks ? kLongestFade : std::numeric_limits<double>::infinity());
  }
  view_.interval = 0;
  view_.mark_count = 0;
  view_.objects = {};
  view_.pressed.counts = {};
  view_.hand_shown = view_.cursor_shown = view_.number_shown = view_.dots.shown = false;
  ask();
}

void TrialPass::ask() noexcept {
  if (question_ == setup_.questions.size()) {
    tell_measures();
    return;
  }
  part_ = Part::kQuestions;
  view_.question = static_cast<std::uint8_t>(question_ + 1);
  view_.verdict = Verdict::kNone;
  view_.pace = Pace::kInTime;
  const StageSight& sight = setup_.questions[question_].sight;
  view_.show(sight.marks, sight.objects, sight.hand, false, {});
  dwells_ = {};
  pedal_up_ = pedal_;
  draft_ = {};
  mark_from_.reset();
  mark_moved_ = false;
  repeating_ = 0;
  view_.show(draft_);
  view_.refused = false;
  time_ = 0.0;
  asked_at_ = sequence_ + 1;
  if (setup_.said != nullptr) {
    *setup_.said = {};
  }
}

/// Goes to the next question; a trial that comes again is not asked about any further.
void TrialPass::go_on() noexcept {
  const PresentedQuestion& asked = setup_.questions[question_];
  if (answers_[question_].pace != Pace::kInTime && asked.question->again) {
    state_ = PassState::kCompleted;
    return;
  }
  ++question_;
  ask();
}

void TrialPass::listen(const Readings& readings, double dt, PassOutput& out) noexcept {
  time_ += dt;
  feel(readings);
  if (part_ == Part::kFeedback) {
    if (time_ >= setup_.feedback_time) {
      go_on();
    }
    return;
  }
  if (part_ == Part::kResults) {
    if (time_ >= setup_.feedback_time) {
      state_ = PassState::kCompleted;
    }
    return;
  }
  const TrialQuestion& question = *setup_.questions[question_].question;
  Answer answer;
  if (setup_.said != nullptr && setup_.said->given) {
    answer.given = true;
    answer.choice = setup_.said->choice;
    answer.draft = setup_.said->draft;
  } else if (question.mark.by != MarkedBy::kKeys) {
    listen_to_mark(question, readings, answer);
  } else if (!question.has_choices()) {
    listen_to_keys(question, readings[0].typed, answer);
  } else {
    listen_to_choice(question, answer);
    listen_to_pedal(question, answer);
    watch_places(readings, answer);
  }
  if (!answer.given && question.timeout > 0.0 && time_ >= question.timeout) {
    answer.choice = question.silent_choice();
    answer.given = answer.silence = answer.choice >= 0;
    if (!answer.given) {
      abort("no answer was given in time");
    }
  }
  if (answer.given) {
    take(answer, out);
  }
}

void TrialPass::listen_to_choice(const TrialQuestion& question, Answer& answer) noexcept {
  for (std::size_t i = 0; i < question.means.size() && !answer.given; ++i) {
    const ChoiceMeans& choice = question.means[i];
    const std::uint32_t button = choice.buttons & pressed_buttons_;
    const std::uint32_t key = choice.keys & pressed_keys_;
    if (button != 0 || key != 0) {
      answer.given = true;
      answer.choice = static_cast<int>(i);
      answer.source = button != 0 ? record::ResponseSource::kButton : record::ResponseSource::kKey;
      answer.code = lowest_bit(button != 0 ? button : key);
    }
  }
}

/// Takes the pedal as an answer when it goes down during the question, from half that depth or
/// less.
void TrialPass::listen_to_pedal(const TrialQuestion& question, Answer& answer) noexcept {
  for (std::size_t i = 0; i < question.means.size() && !answer.given; ++i) {
    const double depth = question.means[i].pedal;
    if (depth > 0.0 && pedal_ >= depth && pedal_up_ <= 0.5 * depth) {
      answer.given = true;
      answer.choice = static_cast<int>(i);
      answer.source = record::ResponseSource::kPedal;
    }
  }
}

/// The answer is of the tick on which the tip came in; it counts when it has stayed.
void TrialPass::watch_places(const Readings& readings, Answer& answer) noexcept {
  constexpr double kRounding = 1e-9;  // [s]
  const PresentedQuestion& asked = setup_.questions[question_];
  for (std::size_t i = 0; i < asked.places.size(); ++i) {
    const TouchedPlace& place = asked.places[i];
    Dwell& dwell = dwells_[i];
    if (place.device >= device_count_ ||
        !place.shape.contains(readings[place.device].tool.position)) {
      dwell = {true, false, 0};
      continue;
    }
    if (dwell.was_outside && !dwell.inside) {
      dwell.inside = true;
      dwell.since = sequence_;
    }
    const double stayed = static_cast<double>(sequence_ - dwell.since) * tick_time_;
    if (dwell.inside && !answer.given && stayed >= asked.question->touch_for - kRounding) {
      answer.given = true;
      answer.choice = static_cast<int>(place.choice);
      answer.source = record::ResponseSource::kPlace;
      answer.code = place.region;
      answer.sequence = dwell.since;
    }
  }
}

/// Keys that went down on this tick; one that is held repeats itself, so that a mark need not be
/// moved step by step. Characters do not.
std::uint32_t TrialPass::repeated_keys(const TrialQuestion& question) noexcept {
  constexpr double kDelay = 0.4, kPeriod = 0.05;  // [s]
  if (pressed_keys_ != 0) {
    repeating_ = question.kind->traits().types ? 0 : pressed_keys_;
    held_for_ = -kDelay;
    return pressed_keys_;
  }
  repeating_ &= keys_;
  held_for_ += tick_time_;
  if (repeating_ == 0 || held_for_ < 0.0) {
    return 0;
  }
  held_for_ -= kPeriod;
  return repeating_;
}

/// An answer that enter finds not to be allowed is given anew.
void TrialPass::listen_to_keys(const TrialQuestion& question, char32_t typed,
                               Answer& answer) noexcept {
  const questions::QuestionKind& kind = *question.kind;
  const std::uint32_t keys = repeated_keys(question);
  if (typed != 0 && kind.traits().types) {
    kind.press(question, {KeyPress::kOther, typed}, draft_);
    view_.refused = false;
  }
  for (const HeardBit& each : question.heard) {
    if ((keys & each.bit) == 0) {
      continue;
    }
    const bool ends = each.key == KeyPress::kEnter ? (pressed_keys_ & each.bit) != 0
                                                   : kind.press(question, {each.key}, draft_) ==
                                                         questions::KeyEffect::kGiven;
    view_.refused = ends && !kind.is_complete(question, draft_);
    if (view_.refused) {
      draft_ = {};
    } else if (ends) {
      answer.given = true;
      answer.draft = draft_;
      answer.source = record::ResponseSource::kKey;
      answer.code = lowest_bit(each.bit);
      break;
    }
  }
  view_.show(draft_);
}

/// The mark follows the hand or the pointer once that has moved; a click on the line has placed it.
void TrialPass::listen_to_mark(const TrialQuestion& question, const Readings& readings,
                               Answer& answer) noexcept {
  const questions::QuestionKind& kind = *question.kind;
  const MarkMeans& mark = question.mark;
  const bool hand = mark.by == MarkedBy::kHand;
  const std::uint32_t press = hand ? mark.buttons & pressed_buttons_ : clicked_ & 1U;
  const std::uint32_t enter = question.heard.back().bit & pressed_keys_;
  const double x = hand ? readings[0].tool.position.x() : readings[0].pointer.x;
  if (std::isfinite(x)) {
    mark_from_ = mark_from_.value_or(x);
    mark_moved_ =
        mark_moved_ || std::abs(x - *mark_from_) > mark.least_movement() || (!hand && press != 0);
  }
  if (mark_moved_) {
    const double rightwards = setup_.questions[question_].rightwards;
    kind.move_mark(question, mark.share_at(rightwards * x), draft_);
    view_.refused = false;
  }
  if (press != 0 || enter != 0) {
    answer.given = mark_moved_;
    view_.refused = !mark_moved_;
    answer.draft = draft_;
    answer.source = press == 0 ? record::ResponseSource::kKey
                    : hand     ? record::ResponseSource::kButton
                               : record::ResponseSource::kPointer;
    answer.code = lowest_bit(press != 0 ? press : enter);
  }
  view_.show(draft_);
}

/// The participant hears whether the answer was right when this is shown.
int TrialPass::sound_of(const PresentedQuestion& asked, const Answer& answer) const noexcept {
  const bool told = asked.feedback && asked.right >= 0 && setup_.feedback_time > 0.0;
  const bool again = answer.pace != Pace::kInTime && asked.question->again;
  return !told || again                 ? -1
         : answer.choice == asked.right ? setup_.sound_right
                                        : setup_.sound_wrong;
}

void TrialPass::take(const Answer& given, PassOutput& out) noexcept {
  const PresentedQuestion& asked = setup_.questions[question_];
  Answer& answer = answers_[question_] = given;
  if (answer.source != record::ResponseSource::kPlace) {
    answer.sequence = sequence_;
  }
  std::uint64_t from = asked_at_;
  if (asked.onset >= 0) {
    const StageTimes& times =
        setup_.intervals.back().machine.times()[static_cast<std::size_t>(asked.onset)];
    from = first_ticks_.back() + static_cast<std::uint64_t>(std::max<std::int64_t>(0, times.begin));
  }
  const bool interrupted = suspended_at_ && *suspended_at_ >= from;
  answer.reaction_time = answer.silence || interrupted
                             ? std::numeric_limits<double>::quiet_NaN()
                             : static_cast<double>(answer.sequence - from + 1) * tick_time_;
  answer.pace = asked.question->pace_of(answer.reaction_time);
  out.onsets.add({record::MarkerOf::kResponse,
                  static_cast<std::int16_t>(asked.marker + std::max(0, answer.choice)), 0,
                  static_cast<std::int16_t>(sound_of(asked, answer))});
  const bool again = answer.pace != Pace::kInTime && asked.question->again;
  if (asked.feedback && asked.right >= 0 && !again) {
    view_.verdict = answer.choice == asked.right ? Verdict::kRight : Verdict::kWrong;
  }
  view_.pace = answer.pace;
  if (view_.told() && setup_.feedback_time > 0.0) {
    part_ = Part::kFeedback;
    time_ = 0.0;
    return;
  }
  go_on();
}

void TrialPass::abort(const char* why) noexcept {
  state_ = PassState::kAborted;
  why_ = why;
}

}  // namespace haptrial::protocols
