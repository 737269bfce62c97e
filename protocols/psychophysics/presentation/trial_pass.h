#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/realtime/block_log.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/object_rows.h"
#include "core/scene/scene.h"
#include "core/scene/shape.h"
#include "protocols/interface/pass.h"
#include "protocols/psychophysics/definition/measurement.h"
#include "protocols/psychophysics/definition/moving_target.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/definition/stage_machine.h"
#include "protocols/psychophysics/presentation/cursor.h"
#include "protocols/psychophysics/presentation/trial_view.h"

namespace haptrial::protocols {

/// Log of the servo thread for contacts that are recorded.
using ContactLog = realtime::BlockLog<record::ContactRow>;

/// Log of the servo thread for the cursor.
using CursorLog = realtime::BlockLog<record::CursorRow>;

/// A field of a scene that is an object of the definition, both from 0.
struct RecordedObject {
  std::size_t field{0};
  std::int32_t object{0};
};

/// Log of the servo thread for moving targets.
using TargetLog = realtime::BlockLog<record::TargetRow>;

/// A moving target, and how long it has been shown in the interval.
struct ShownTarget {
  MovingTarget target;
  std::int64_t ticks{-1};  // since it was shown first; -1: not yet
};

/// Content of the screen during a stage.
struct StageSight {
  std::vector<Mark> marks;
  std::vector<SeenObject> objects;
  DotsShown dots;
  bool hand{false};
  bool cursor{false};
  bool interval_number{false};
  int sound{-1};  // that begins with the stage; -1: none
};

/// One interval, ready to be presented.
struct IntervalRun {
  std::vector<scene::Scene> scenes;  // (devices)
  StageMachine machine;
  std::vector<StageSight> sights;  // (stages)
  std::uint64_t pushing{0};        // fields that are to work on the hand, a bit each
  int marker{-1};                  // index of its onset's marker; -1: it has none
  std::vector<RecordedObject> recorded{};
  std::size_t first_object{0};  // the field that is the definition's first object
  std::optional<Cursor> cursor{};
  std::vector<ShownTarget> targets{};
  std::vector<Measurement> measurements{};  // of the definition's measures
};

/// A measure of a trial: the interval in which it is taken, in the order of their presentation, and
/// whether the participant is told.
struct TakenMeasure {
  std::size_t interval{0};
  bool told{false};
};

/// A place that gives a choice when the tip of the tool is moved into it.
struct TouchedPlace {
  scene::PlacedShape shape;
  std::size_t device{0};  // whose tool
  std::size_t choice{0};  // from 0
  int region{-1};         // of the definition's [regions], in the order of their names
};

/// A question after the intervals.
struct PresentedQuestion {
  const TrialQuestion* question{nullptr};  // outlives the pass
  int right{-1};                           // choice, from 0; -1: none is known to be right
  bool feedback{false};                    // tells whether it was right
  int onset{-1};  // stage of the last interval from which the reaction counts; -1: the question
  int marker{0};  // index of the first answer's marker; those of the others follow
  std::vector<TouchedPlace> places{};  // in the order of the choices that they give
  StageSight sight{};                  // these places, and the hand
  double rightwards{1.0};              // x of W on the screen; -1: to the left
};

/// An answer.
struct Answer {
  bool given{false};
  bool silence{false};           // the silent choice, of which no reaction time is known
  int choice{-1};                // from 0; -1: the question has no choices
  questions::AnswerDraft draft;  // of a question without choices
  record::ResponseSource source{record::ResponseSource::kNone};
  int code{-1};                                                    // of the button or the key's bit
  std::uint64_t sequence{0};                                       // of the tick
  double reaction_time{std::numeric_limits<double>::quiet_NaN()};  // [s]; NaN: not known
  Pace pace{Pace::kInTime};
};

/// One trial: its intervals one after the other, then its questions. Servo thread, all but the
/// constructor and what is read after the pass.
class TrialPass final : public Pass {
 public:
  struct Setup {
    std::int32_t trial{0};
    std::vector<IntervalRun> intervals;
    std::vector<PresentedQuestion> questions;
    std::vector<TakenMeasure> measures{};  // as those of every interval
    double feedback_time{0.0};             // [s]
    int most_repeats{5};
    /// The sum of a device's fields is scaled to at most this (devices) [N].
    std::array<double, kMostDevices> max_force{8.0, 8.0, 8.0, 8.0};
    SimulatedAnswer* said{nullptr};        // null: a person answers
    const LeftDecision* left{nullptr};     // null: nothing is left to the session's thread
    ContactLog* contacts{nullptr};         // of recorded objects; null if there are none
    CursorLog* cursors{nullptr};           // null if there is no cursor
    TargetLog* targets{nullptr};           // null if nothing moves
    int sound_right{-1}, sound_wrong{-1};  // with the feedback; -1: none
  };
  explicit TrialPass(Setup setup);

  void begin(std::uint64_t sequence) noexcept override;
  PassOutput tick(const Readings& readings, double dt) noexcept override;
  void note_suspension() noexcept override { suspended_at_ = sequence_; }
  std::span<const Drive> others() const noexcept override {
    return {drives_.data() + 1, device_count_ - 1};
  }
  PassState state() const noexcept override { return state_; }
  bool names_onsets() const noexcept override { return true; }
  bool wants_attention() noexcept override {
    return setup_.left != nullptr && setup_.left->waits();
  }

  // Enters a stage in a replay, which knows the stages, in place of begin() and tick().
  void enter_again(std::size_t interval, std::size_t stage) noexcept;
  /// @param hands  (devices) on a tick of that stage, all of its ticks in order
  /// @returns what presses the seen bodies
  const SeenForces& feel_again(std::span<const PointState> hands) noexcept;

  // The following functions are for after the pass.
  /// Sequence number of the first tick of an interval; 0 for one that did not begin.
  std::uint64_t first_tick(std::size_t interval) const { return first_ticks_[interval]; }
  const StageMachine& machine(std::size_t interval) const {
    return setup_.intervals[interval].machine;
  }
  std::size_t intervals_begun() const { return begun_; }
  /// Scenes of a device in an interval.
  std::span<const scene::Scene> scenes(std::size_t interval) const {
    return setup_.intervals[interval].scenes;
  }
  const StageSight& sight(std::size_t interval, std::size_t stage) const {
    return setup_.intervals[interval].sights[stage];
  }
  std::int32_t trial() const { return setup_.trial; }  // as the view has it
  std::uint64_t last_tick() const { return sequence_ - 1; }
  const std::vector<Answer>& answers() const { return answers_; }
  /// Content of the screen beside a question's text.
  const StageSight& question_sight(std::size_t question) const {
    return setup_.questions[question].sight;
  }
  /// A measure of the definition in the interval in which it is taken.
  const Measurement& measurement(std::size_t measure) const {
    return setup_.intervals[setup_.measures[measure].interval].measurements[measure];
  }
  const std::vector<TakenMeasure>& measures() const { return setup_.measures; }
  /// Reason in words; empty if the pass was not aborted by itself.
  const char* why_aborted() const noexcept { return why_; }

 private:
  enum class Part : std::uint8_t { kIntervals, kQuestions, kFeedback, kResults };

  void begin_interval() noexcept;
  void go_on_feeling() noexcept;
  void note_stage(const IntervalRun& run, PassOutput& out) noexcept;
  int sound_of(const PresentedQuestion& asked, const Answer& answer) const noexcept;
  void feel(const Readings& readings) noexcept;
  bool flew_apart(const IntervalRun& run) const noexcept;
  void present(const Readings& readings, double dt, PassOutput& out) noexcept;
  void show_pressed(const IntervalRun& run, const StageSight& sight, std::size_t devices) noexcept;
  void move_targets(IntervalRun& run, double dt) noexcept;
  Eigen::Vector3d move_cursor(IntervalRun& run, const StageSight& sight,
                              const Readings& readings) noexcept;
  void log_contacts(const IntervalRun& run, std::size_t device) noexcept;
  Drive drive(const IntervalRun& run, std::size_t device, const Eigen::Vector3d& force) noexcept;
  void take_measures(IntervalRun& run, const Readings& readings, double dt) noexcept;
  void take_measure(const IntervalRun& run, const Readings& readings, double dt,
                    Measurement& measurement) const noexcept;
  double distance_of(const Measure& measure, const IntervalRun& run, const Eigen::Vector3d& place,
                     double dt) const noexcept;
  void tell_measures() noexcept;
  void end_interval() noexcept;
  void ask() noexcept;
  void listen(const Readings& readings, double dt, PassOutput& out) noexcept;
  void listen_to_choice(const TrialQuestion& question, Answer& answer) noexcept;
  void listen_to_pedal(const TrialQuestion& question, Answer& answer) noexcept;
  void watch_places(const Readings& readings, Answer& answer) noexcept;
  void listen_to_keys(const TrialQuestion& question, char32_t typed, Answer& answer) noexcept;
  void listen_to_mark(const TrialQuestion& question, const Readings& readings,
                      Answer& answer) noexcept;
  std::uint32_t repeated_keys(const TrialQuestion& question) noexcept;
  void take(const Answer& answer, PassOutput& out) noexcept;
  void go_on() noexcept;
  void look_at_hands(const Readings& readings) noexcept;
  void abort(const char* why) noexcept;

  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  Setup setup_;
  std::vector<std::uint64_t> first_ticks_;
  std::vector<Answer> answers_;
  PassState state_{PassState::kRunning};
  Part part_{Part::kIntervals};
  std::size_t interval_{0};
  std::size_t begun_{0};
  std::uint64_t stage_begun_{kNever};  // tick at which the stage that was told last began
  std::size_t question_{0};
  TrialView view_;
  std::array<Drive, kMostDevices> drives_{};             // of the last tick
  std::array<double, kMostDevices> passed_{1, 1, 1, 1};  // by the limit, of the forces' sum
  std::size_t device_count_{1};
  bool saturated_{false};
  std::uint64_t sequence_{0};
  std::uint64_t asked_at_{0};                           // sequence number
  std::optional<std::uint64_t> suspended_at_;           // first tick after the last suspension
  double time_{0.0};                                    // in the question or the feedback [s]
  double tick_time_{0.0};                               // [s]
  std::uint32_t buttons_{0}, keys_{0};                  // held
  std::uint32_t pressed_buttons_{0}, pressed_keys_{0};  // went down on this tick
  std::uint32_t clicks_{0}, clicked_{0};                // of the pointer, likewise
  double pedal_{0.0};                                   // how far it is down, 0 to 1
  double pedal_up_{0.0};                                // the least since the question
  /// The tip in a place that can be touched: it counts when it comes from outside.
  struct Dwell {
    bool was_outside{false};
    bool inside{false};
    std::uint64_t since{0};  // sequence number
  };
  std::array<Dwell, kMostTouched> dwells_{};  // (places of the question)
  bool hands_known_{false};
  questions::AnswerDraft draft_;     // of a question without choices
  std::optional<double> mark_from_;  // where the hand or pointer was when the question came [m]
  bool mark_moved_{false};           // from there
  std::uint32_t repeating_{0};       // key that is held down, of those in pressed_keys_
  double held_for_{0.0};             // until it repeats itself [s]
  const char* why_{""};
};

}  // namespace haptrial::protocols
