#include "experiments/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/record/damping_event.h"
#include "core/record/session_reader.h"
#include "experiments/drilling_study.h"
#include "experiments/interrupt.h"
#include "experiments/last_stop.h"
#include "experiments/live_drilling.h"
#include "experiments/rig.h"
#include "experiments/servo_thread.h"
#include "experiments/session_desk.h"
#include "experiments/session_notices.h"
#include "experiments/session_opening.h"
#include "experiments/session_pace.h"
#include "experiments/session_record.h"
#include "experiments/trials.h"
#include "protocols/session_task.h"

namespace haptrial::experiments {
namespace {

using protocols::PlannedTrial;
using realtime::ClockKind;

/// Where somebody looks at the figures: at a console, or at the end.
std::unique_ptr<LiveDrilling> open_live(const SessionRequest& request) {
  const bool seen = request.clock == ClockKind::kReal || request.control != nullptr;
  return seen && request.bone != nullptr
             ? std::make_unique<LiveDrilling>(procedure_setup(*request.bone), request.bone->rate)
             : nullptr;
}

/// Practice, and the first `most` trials of the study. @param most  0: all
std::vector<PlannedTrial> trials_within(std::vector<PlannedTrial> plan, int most) {
  if (most > 0) {
    std::erase_if(plan,
                  [most](const auto& trial) { return !trial.practice && trial.trial > most; });
  }
  return plan;
}

/// Whether somebody feels the forces.
bool is_felt(Rig& rig) { return !rig.device().info().simulated && rig.mouse() == nullptr; }

class Session {
 public:
  explicit Session(const SessionRequest& request);
  ~Session();
  SessionSummary run();
  bool hangs() const { return servo_.hangs(); }

 private:
  std::vector<stimulus::Observer*> observers();
  SessionDesk::Actions desk_actions();

  std::string instructions() const;
  void show_trial();
  void run_plan(const std::vector<PlannedTrial>& plan);
  bool has_break(const PlannedTrial& trial, const PlannedTrial& last) const;
  bool present(const PlannedTrial& trial);
  bool run_trial(const PlannedTrial& trial, int attempt);
  bool run_pass(const PlannedTrial& trial, record::Phase phase, int attempt);
  std::shared_ptr<const analysis::drilling::Procedure> of_earlier_run(const record::PassRow& pass);
  void note_damping(const protocols::PassResult& result);
  void after_abort(const protocols::PassResult& result);
  std::string why_broken_off();

  void finish();
  void give_up() noexcept;
  void end_servo();
  void note_troubles();

  const SessionRequest& request_;
  const Setup& d_;
  const bool real_;
  bool may_go_on_;  // with a bone of an earlier run
  std::uint64_t session_seed_;
  SessionSummary summary_;
  bool left_{false};  // trials that an abort kept from being presented to their end
  realtime::ServoLoop loop_;
  // Before the task: the servo thread may be using its pass when an error
  // leaves a function.
  std::unique_ptr<Trials> trials_;
  std::unique_ptr<Rig> rig_;
  std::atomic<std::uint32_t> held_keys_{0};  // functions, from the screen's thread
  std::atomic<bool> begin_pressed_{false};   // likewise, without an experimenter
  std::unique_ptr<Screen> screen_;
  std::unique_ptr<LiveDrilling> live_;
  SessionRecord record_;  // opened when everything else is there
  SessionDesk desk_;
  protocols::SessionTask task_;
  SessionPace pace_;
  SessionNotices notices_;
  ServoThread servo_;  // on a real clock
  SessionStop stop_;
  std::optional<WatchedStop> watched_;  // on a real clock
};

Session::Session(const SessionRequest& request)
    : request_(request),
      d_(setup_of(request)),
      real_(request.clock == ClockKind::kReal),
      may_go_on_(request.resume),
      session_seed_(derived_seed(request.seed, "participant " + request.subject)),
      loop_(request.clock, d_.rate),
      trials_(make_trials(request, session_seed_)),
      rig_(make_rig(request.device, d_, [this] { return trials_->virtual_rig(session_seed_); })),
      screen_(open_screen(request, rig_->mouse(), &held_keys_, &begin_pressed_)),
      live_(open_live(request)),
      record_(request, rig_->device().info(), loop_, trials_->bones(), live_.get()),
      desk_(request.control, desk_actions()),
      task_(rig_->device(), d_.envelope, record_.log(), observers(),
            real_ ? protocols::SessionTask::Leave::kNever
                  : protocols::SessionTask::Leave::kAfterPassOrSlice,
            record_.origin(), record_.tool_log(), &held_keys_),
      pace_({request, loop_, record_, desk_, task_, is_felt(*rig_), screen_.get(), &begin_pressed_,
             live_.get()}),
      notices_({request, loop_, record_, desk_, summary_}),
      servo_(loop_, task_, longest_fade(d_.envelope)),
      stop_(task_, servo_, rig_->device()) {
  SessionStatus& status = desk_.status();
  status.subject = request.subject;
  status.device = request.device.name;
  status.simulated = rig_->device().info().simulated;
  status.rate = d_.rate;
  if (real_) {
    watched_.emplace(stop_);
  }
  if (request.control != nullptr) {
    request.control->on_emergency([this] { task_.emergency_stop(); });
  }
}

Session::~Session() {
  watched_.reset();
  if (request_.control != nullptr) {
    request_.control->on_emergency(nullptr);
  }
}

SessionDesk::Actions Session::desk_actions() {
  return {[this] { task_.break_off(); }, [this] { task_.clear_fault(); },
          [this](const std::string& kind, const std::string& text) { record_.event(kind, text); }};
}

std::vector<stimulus::Observer*> Session::observers() {
  std::vector<stimulus::Observer*> all;
  if (rig_->subject() != nullptr) {
    all.push_back(rig_->subject());
  }
  for (stimulus::Observer* observer : trials_->observers()) {
    all.push_back(observer);
  }
  if (screen_) {
    all.push_back(screen_.get());
  }
  return all;
}

SessionSummary Session::run() {
  const std::vector<PlannedTrial> plan = trials_within(trials_->plan(), request_.max_trials);
  try {
    const record::Phase last = trials_->phases().back();
    const auto under_way = std::find_if(
        plan.begin(), plan.end(), [&](const auto& trial) { return !record_.holds(trial, last); });
    const bool drills = last == record::Phase::kDrilling && under_way != plan.end();
    record_.set_planned(
        std::count_if(plan.begin(), plan.end(), [](const auto& trial) { return !trial.practice; }));
    record_.open(planned_of(plan, d_.design.trials), drills ? &*under_way : nullptr);
    if (real_) {
      servo_.start();
    }
    notices_.note(record_.notice());
    for (const std::string& notice : trials_->notices()) {
      notices_.note(notice);
    }
    notices_.note_real_time();
    notices_.say_plan(plan, last);
    run_plan(plan);
    finish();
  } catch (...) {
    give_up();
    throw;
  }
  return summary_;
}

void Session::run_plan(const std::vector<PlannedTrial>& plan) {
  pace_.wait_to_begin(instructions());
  bool practised = false;
  for (const PlannedTrial& trial : plan) {
    if (record_.holds(trial, trials_->phases().back())) {
      continue;
    }
    if (desk_.wishes().abort) {
      left_ = true;
      break;
    }
    if (trial.practice && !std::exchange(practised, true)) {
      pace_.wait_to_begin(d_.texts.practice);
    }
    left_ = !present(trial) || left_;
    if (has_break(trial, plan.back()) && !desk_.wishes().abort) {
      pace_.take_break();
    }
  }
  pace_.let_read(d_.texts.thanks, "thanks");
}

/// What a square in the corner means, too, for those who may see one.
std::string Session::instructions() const {
  const bool may_see_it = request_.definition != nullptr;
  return may_see_it ? d_.texts.instructions + "\n" + d_.texts.limit : d_.texts.instructions;
}

void Session::show_trial() {
  pace_.clear_text();
  if (screen_) {
    trials_->show(*screen_);
  }
}

/// One trial until it is done: again when the experimenter repeats it, or when
/// it was aborted while an experimenter is there to see to the cause.
/// @returns whether nothing of it is left to do
bool Session::present(const PlannedTrial& trial) {
  trials_->prepare(trial, record_);
  Wishes& wishes = desk_.wishes();
  for (int attempt = record_.attempts(trial) + 1; !wishes.abort; ++attempt) {
    const bool anew = std::exchange(wishes.repeat, false);
    wishes.skip = false;
    trials_->begin_attempt(trial, anew);
    show_trial();
    record_.mark_trial("trial_begin", trial, attempt);
    const bool done = run_trial(trial, attempt);
    pace_.pause_where_asked();
    const bool skipped = wishes.skip && !done;
    const char* how = done ? "completed" : skipped ? "skipped" : "aborted";
    record_.mark_trial("trial_end", trial, attempt, how);
    notices_.say_trial(trial, how);
    if (skipped) {
      record_.skip(trial);
    }
    if ((done && !wishes.repeat) || wishes.skip || !desk_.attended()) {
      return true;
    }
  }
  return false;
}

/// A break follows every `break_after` trials, except the last.
bool Session::has_break(const PlannedTrial& trial, const PlannedTrial& last) const {
  const int after = d_.design.break_after;
  return after > 0 && !trial.practice && trial.trial % after == 0 && trial.trial != last.trial;
}

/// @returns whether all passes were completed.
bool Session::run_trial(const PlannedTrial& trial, int attempt) {
  bool done = true;
  const std::span<const record::Phase> phases = trials_->phases();
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (i > 0) {
      pace_.pause_where_asked();
      const Wishes& wishes = desk_.wishes();
      if (wishes.repeat || wishes.skip || wishes.abort) {
        return false;
      }
    }
    const bool completed = run_pass(trial, phases[i], attempt);
    if (!completed && desk_.attended()) {
      return false;  // the trial is presented again, from its first pass on
    }
    done = done && completed;
  }
  return done;
}

bool Session::run_pass(const PlannedTrial& trial, record::Phase phase, int attempt) {
  if (pace_.text_shown()) {
    show_trial();
  }
  PlannedTrial row = trial;
  protocols::Pass& pass = trials_->make_pass(row, phase, record_);
  const std::int32_t number = record_.begin_pass(row, phase, attempt);
  if (live_) {
    live_->begin(record_.pass(), trials_->bone(), of_earlier_run(record_.pass()));
  }
  task_.start(pass, number);
  ++summary_.passes;
  pace_.drive_until_idle();
  notices_.note_overruns(pace_.watch());
  const protocols::PassResult& result = task_.result();
  const bool aborted = result.state == protocols::PassState::kAborted;
  trials_->close_pass(record_, number);
  record_.end_pass(result);
  note_damping(result);
  if (aborted) {
    after_abort(result);
  }
  trials_->draw_pictures(trial, phase);
  return !aborted;
}

/// What the file held of the bone that the first pass after --resume goes on with.
std::shared_ptr<const analysis::drilling::Procedure> Session::of_earlier_run(
    const record::PassRow& pass) {
  if (!std::exchange(may_go_on_, false) || pass.practice || pass.attempt < 2) {
    return nullptr;
  }
  try {
    const record::SessionReader file(request_.file.string() + ".partial");
    const auto passes = file.passes();
    const bool same_bone = std::any_of(passes.begin(), passes.end(), [&](const auto& row) {
      return row.trial == pass.trial && !row.practice && row.repetition == pass.repetition;
    });
    for (auto& procedure : load_procedures(file, procedure_setup(*request_.bone))) {
      if (same_bone && procedure.number == pass.trial) {
        return std::make_shared<const analysis::drilling::Procedure>(std::move(procedure));
      }
    }
  } catch (const std::exception& error) {  // nothing that a session should end for
    record_.event(
        "notice",
        fmt::format("live figures leave out the passes before the session was resumed: {}",
                    error.what()));
  }
  return nullptr;
}

/// A hand that did not carry all the damping was guided less firmly, which an analyst has to know.
void Session::note_damping(const protocols::PassResult& result) {
  if (result.reduced_ticks > 0) {
    record_.event(
        record::kDampingReduced,
        to_text(record::DampingReduced{record_.pass().trial, result.least_damping,
                                       static_cast<double>(result.reduced_ticks) / d_.rate}));
  }
}

void Session::after_abort(const protocols::PassResult& result) {
  desk_.status().aborted_passes = ++summary_.aborted_passes;
  const bool fault = result.fault != device::Fault::kNone;
  const std::string why = fault ? device::describe(result.fault) : why_broken_off();
  const std::string trouble = fault ? rig_->device().trouble() : "";
  const bool overloaded = !pace_.overload().empty();  // and no better the next time
  record_.event("aborted", fmt::format("trial {}: {}{}{}", record_.pass().trial, why,
                                       trouble.empty() ? "" : "; ", trouble));
  if (result.fault == device::Fault::kStopButton) {
    record_.event("emergency_stop", "by the handle");
  }
  if ((fault || overloaded) && desk_.attended()) {
    desk_.status().fault = trouble.empty() ? why : why + "; " + trouble;
    desk_.wishes().stopped = true;  // a person sees to the cause
  } else if ((fault || overloaded) && real_) {
    // Nobody is at a console or keyboard to see to the cause and say that it may go on.
    pace_.let_read(d_.texts.stopped, "stopped");
    pace_.end_early(trouble.empty() ? why : why + "; " + trouble);
  } else {
    pace_.recover();
  }
}

std::string Session::why_broken_off() {
  const Wishes& wishes = desk_.wishes();
  if (!pace_.overload().empty()) {
    return pace_.overload();
  }
  if (wishes.repeat) {
    return "to be repeated";
  }
  if (wishes.skip) {
    return "skipped";
  }
  if (wishes.abort) {
    return wishes.for_good ? "the session was ended for good" : "the session was stopped";
  }
  return trials_->why_aborted();
}

void Session::finish() {
  end_servo();
  if (screen_) {
    record_.keep_frames(screen_->take_frames());
  }
  note_troubles();
  const Wishes& wishes = desk_.wishes();
  summary_.stopped = left_ && wishes.abort && !wishes.for_good;
  if (summary_.stopped) {
    record_.stop("by the experimenter; --resume continues at the first unfinished trial");
  } else {
    if (left_ && wishes.for_good) {
      record_.event("ended_for_good", "by the experimenter, with trials left");
    }
    record_.close(wishes.abort ? "ended by the experimenter" : "");
  }
  if (live_) {
    live_->finish();
    summary_.procedures = live_->procedures();
  }
  summary_.simulated = rig_->device().info().simulated;
  summary_.ticks = loop_.ticks();
  summary_.overruns = loop_.overruns();
  summary_.dropped = record_.dropped();
  pace_.publish("ended");
}

void Session::give_up() noexcept {
  try {
    task_.break_off();
    end_servo();
  } catch (const std::exception&) {
    // The thread is left behind; what it recorded is kept all the same.
  }
  try {
    record_.give_up(task_);
  } catch (const std::exception&) {
    // What stopped the session is the error to report; the writer keeps what it
    // could.
  }
}

/// The force fades when nothing is wrong with the device; a fault has cut it already.
void Session::end_servo() {
  servo_.end();
  rig_->device().write(Eigen::Vector3d::Zero());
}

void Session::note_troubles() {
  notices_.note(live_ ? live_->trouble() : "");
  notices_.note(loop_.real_time_status().notice);
  if (loop_.resynchronised() > 0) {
    notices_.note(fmt::format("the loop was suspended {} times and continued at the present time",
                              loop_.resynchronised()));
  }
  if (screen_) {
    notices_.note(screen_->summary().notice);
    notices_.note(screen_->trouble());
  }
}

}  // namespace

SessionSummary run_session(const SessionRequest& request) {
  if (request.resume && close_what_had_ended(request.file)) {
    SessionSummary closed;
    closed.notices.push_back("the session had ended before: its file only had to be closed");
    return closed;
  }
  auto session = std::make_unique<Session>(request);
  try {
    return session->run();
  } catch (...) {
    if (session->hangs()) {
      static_cast<void>(session.release());  // its servo thread may yet come back to it
    }
    throw;
  }
}

double estimated_ticks(const BoneDefinition& d, int trials) {
  return d.rate * trials * d.drilling.time_limit;
}

double estimated_ticks(const Definition& d, int trials) {
  // A wandering curve is about twice as long as its extent; approach and return
  // take seconds.
  const double run = 2.0 * d.trajectory.length_x / d.trajectory.speed;
  const double around =
      d.guidance.wait + 2.0 * 1.875 * d.trajectory.length_x / d.guidance.approach_speed;
  return d.rate * 2.0 * trials * (run + around);
}

}  // namespace haptrial::experiments
