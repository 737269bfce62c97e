#include "experiments/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/render/frames.h"
#include "experiments/frame_capture.h"
#include "experiments/interrupt.h"
#include "experiments/rig.h"
#include "experiments/session_desk.h"
#include "experiments/session_opening.h"
#include "protocols/recall_test.h"
#include "protocols/session_task.h"
#include "protocols/training_pass.h"

namespace haptrial::experiments {
namespace {

using protocols::PlannedTrial;
using realtime::ClockKind;
using Clock = std::chrono::steady_clock;

class Session {
 public:
  explicit Session(const SessionRequest& request);
  ~Session();
  SessionSummary run();

 private:
  std::vector<stimulus::Observer*> observers();
  SessionDesk::Actions desk_actions();

  void run_plan(const std::vector<PlannedTrial>& plan);
  bool already_done(const PlannedTrial& trial) const;
  void prepare(const PlannedTrial& trial);
  void present(const PlannedTrial& trial);
  bool run_trial(const PlannedTrial& trial, int attempt);
  bool run_pass(std::unique_ptr<protocols::TrajectoryPass> pass, const PlannedTrial& trial,
                record::Phase phase, int attempt);
  void record_pass(record::PassStatus status, std::uint64_t last_sample);
  void after_abort(const protocols::PassResult& result);
  const char* why_broken_off();

  void drive_until_idle();
  void collect();
  void take(std::span<const record::Sample> samples);
  void take_frames();
  void wait(double seconds, const char* state);
  void wait_for_experimenter(const char* state);
  void recover();
  void take_break();
  void show_text(const std::string& text, const std::string& hint, double countdown = 0.0);
  void publish(const char* state);
  void draw_pictures(const PlannedTrial& trial, record::Phase phase);
  void event(const std::string& kind, const std::string& text);
  std::int64_t now_ns() const;

  void finish();
  void give_up() noexcept;
  void record_broken_passes();
  void append_rest();
  void join_servo();
  bool asked_to_stop() const;
  void write_timing();

  const SessionRequest& request_;
  const Definition& d_;
  const bool real_;
  std::uint64_t session_seed_;
  SessionSummary summary_;
  std::unique_ptr<Rig> rig_;
  FrameCapture capture_;
  std::optional<render::FrameRenderer> renderer_;
  std::unique_ptr<Screen> screen_;
  record::Resumed before_;        // what a resumed file holds
  record::SessionWriter writer_;  // opened when everything else is there
  std::unique_ptr<stream::LslOutlet> outlet_;
  SessionDesk desk_;
  protocols::SessionTask::Log log_;
  protocols::SessionTask task_;
  realtime::ServoLoop loop_;
  // Kept here, not in a function: the servo thread may be using them when an error leaves it.
  std::optional<stimulus::Stimulus> stimulus_;
  std::unique_ptr<protocols::TrajectoryPass> pass_;
  std::thread servo_;     // on a real clock
  record::PassRow row_;   // of the present pass
  bool row_open_{false};  // and is not in the file yet
  Clock::time_point flushed_{};
};

Session::Session(const SessionRequest& request)
    : request_(request),
      d_(*request.definition),
      real_(request.clock == ClockKind::kReal),
      session_seed_(derived_seed(request.seed, "participant " + request.subject)),
      rig_(make_rig(request.device, d_, session_seed_)),
      capture_(request.frames_per_pass),
      screen_(open_screen(request, rig_->mouse())),
      writer_(open_writer(request, before_)),
      desk_(request.control, desk_actions()),
      task_(rig_->device(), d_.envelope, log_, observers(),
            real_ ? protocols::SessionTask::Leave::kNever
                  : protocols::SessionTask::Leave::kAfterPassOrSlice,
            {before_.next_sequence, before_.last_time_ns + 1}),
      loop_(request.clock, d_.rate) {
  if (request.frames_per_pass > 0) {
    renderer_.emplace(d_.display);
  }
  std::string notice;
  outlet_ = open_outlet(request, rig_->subject() != nullptr, notice);
  if (!notice.empty()) {
    summary_.notices.push_back(notice);
  }
  const auto stop = [](void* task) {
    static_cast<protocols::SessionTask*>(task)->emergency_stop();
  };
  if (real_) {
    call_on_interrupt(stop, &task_);
  }
  if (request.control != nullptr) {
    request.control->on_emergency([this] { task_.emergency_stop(); });
  }
}

Session::~Session() {
  if (real_) {
    call_on_interrupt(nullptr, nullptr);
  }
  if (request_.control != nullptr) {
    request_.control->on_emergency(nullptr);
  }
}

SessionDesk::Actions Session::desk_actions() {
  return {[this] { task_.break_off(); }, [this] { task_.clear_fault(); },
          [this](const std::string& kind, const std::string& text) { event(kind, text); }};
}

std::vector<stimulus::Observer*> Session::observers() {
  std::vector<stimulus::Observer*> all;
  if (rig_->subject() != nullptr) {
    all.push_back(rig_->subject());
  }
  if (request_.frames_per_pass > 0) {
    all.push_back(&capture_);
  }
  if (screen_) {
    all.push_back(screen_.get());
  }
  return all;
}

SessionSummary Session::run() {
  const auto plan =
      protocols::plan_trials(d_.design, request_.participant, request_.seed, session_seed_);
  try {
    record_broken_passes();
    event(before_.rows > 0 ? "session_resumed" : "session_start",
          fmt::format("{} trials planned", plan.size()));
    if (real_) {
      servo_ = std::thread([this] { loop_.run(task_); });
    }
    run_plan(plan);
    finish();
  } catch (...) {
    give_up();
    throw;
  }
  return summary_;
}

void Session::run_plan(const std::vector<PlannedTrial>& plan) {
  desk_.status().trials = d_.design.trials;
  desk_.status().blocks = d_.design.blocks();
  if (desk_.attended()) {
    show_text(d_.texts.instructions, "The experimenter starts");
    wait_for_experimenter("instructions");
  }
  for (const PlannedTrial& trial : plan) {
    const bool enough =
        request_.max_trials > 0 && !trial.practice && trial.trial > request_.max_trials;
    if (enough || desk_.wishes().abort) {
      break;
    }
    if (already_done(trial)) {
      continue;
    }
    present(trial);
    if (!trial.practice && trial.trial == d_.design.break_after) {
      take_break();
    }
  }
  show_text(d_.texts.thanks, "");
}

/// Whether a resumed file holds the trial's test already.
bool Session::already_done(const PlannedTrial& trial) const {
  return std::any_of(before_.passes.begin(), before_.passes.end(), [&](const auto& pass) {
    return pass.trial == trial.trial && pass.practice == trial.practice &&
           pass.condition == trial.condition && pass.phase == record::Phase::kTest &&
           pass.status == record::PassStatus::kCompleted;
  });
}

void Session::prepare(const PlannedTrial& trial) {
  if (stimulus_ && row_.stimulus_seed == trial.stimulus_seed) {
    return;
  }
  stimulus_ = stimulus::make_stimulus(d_.trajectory, d_.force_pattern, trial.stimulus_seed);
  row_.stimulus_seed = trial.stimulus_seed;
  const auto& stored = before_.blocks;
  if (!trial.practice && std::find(stored.begin(), stored.end(), trial.block) == stored.end()) {
    writer_.add_stimulus(stimulus_rows(*stimulus_, trial.block, d_.stimulus_rate));
  }
  if (renderer_) {
    renderer_->set_trajectory(stimulus_->path.points());
  }
}

/// One trial until it is done: again when the experimenter repeats it, or when it was aborted while
/// an experimenter is there to see to the cause.
void Session::present(const PlannedTrial& trial) {
  prepare(trial);
  Wishes& wishes = desk_.wishes();
  for (int attempt = 1; !wishes.abort; ++attempt) {
    wishes.repeat = wishes.skip = false;
    if (screen_) {
      screen_->show_trial(stimulus_->path.points());
    }
    const bool done = run_trial(trial, attempt);
    if (wishes.stopped || wishes.pause) {
      wait_for_experimenter(wishes.stopped ? "stopped" : "paused");
    }
    if (done || wishes.skip || !desk_.attended()) {
      return;
    }
  }
}

/// @returns whether both passes were completed.
bool Session::run_trial(const PlannedTrial& trial, int attempt) {
  const bool learnt =
      run_pass(protocols::make_training_pass(trial.condition, *stimulus_, d_.guidance, trial.block),
               trial, record::Phase::kTraining, attempt);
  if (!learnt && desk_.attended()) {
    return false;  // the trial is presented again, from its training on
  }
  const bool tested =
      run_pass(std::make_unique<protocols::RecallTest>(*stimulus_, d_.guidance, trial.block), trial,
               record::Phase::kTest, attempt);
  return learnt && tested;
}

bool Session::run_pass(std::unique_ptr<protocols::TrajectoryPass> pass, const PlannedTrial& trial,
                       record::Phase phase, int attempt) {
  pass_ = std::move(pass);
  row_ = {};
  row_.trial = trial.trial;
  row_.condition = trial.condition;
  row_.phase = phase;
  row_.block = trial.block;
  row_.repetition = trial.repetition;
  row_.stimulus_seed = trial.stimulus_seed;
  row_.practice = trial.practice;
  row_.attempt = attempt;
  row_open_ = true;
  const auto known = before_.passes.size() + before_.open_passes.size();
  task_.start(*pass_, static_cast<std::int32_t>(known) + summary_.passes++);
  drive_until_idle();
  const protocols::PassResult& result = task_.result();
  const bool aborted = result.state == protocols::PassState::kAborted;
  record_pass(aborted ? record::PassStatus::kAborted : record::PassStatus::kCompleted,
              result.last_sample);
  if (aborted) {
    after_abort(result);
  }
  if (renderer_) {
    draw_pictures(trial, phase);
  }
  return !aborted;
}

void Session::record_pass(record::PassStatus status, std::uint64_t last_sample) {
  append_rest();
  row_.first_sample = task_.result().first_sample;
  row_.last_sample = last_sample;
  row_.status = status;
  writer_.add_pass(row_);
  row_open_ = false;
  if (real_) {
    writer_.sync();
  }
}

void Session::after_abort(const protocols::PassResult& result) {
  ++summary_.aborted_passes;
  const bool fault = result.fault != device::Fault::kNone;
  const std::string why = fault ? device::describe(result.fault) : why_broken_off();
  const std::string trouble = fault ? rig_->device().trouble() : "";
  event("aborted",
        fmt::format("trial {}: {}{}{}", row_.trial, why, trouble.empty() ? "" : "; ", trouble));
  if (fault && desk_.attended()) {
    desk_.status().fault = trouble.empty() ? why : why + "; " + trouble;
    desk_.wishes().stopped = true;  // a person sees to the cause
  } else {
    recover();
  }
}

const char* Session::why_broken_off() {
  const Wishes& wishes = desk_.wishes();
  if (wishes.repeat) {
    return "to be repeated";
  }
  if (wishes.skip) {
    return "skipped";
  }
  return wishes.abort ? "the session was ended"
                      : "the tool did not come to the start, or to the end, in time";
}

void Session::drive_until_idle() {
  while (!task_.idle()) {
    if (real_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } else {
      loop_.run(task_);
    }
    collect();
    publish(row_.practice ? "practice" : "running");
    if (asked_to_stop()) {
      task_.emergency_stop();
      throw RunError(real_ ? fmt::format("interrupted; what was recorded is in {}.partial",
                                         request_.file.string())
                           : "interrupted");
    }
  }
}

/// What has come since the last call: records, pictures shown, messages.
void Session::collect() {
  const auto take = [this](std::span<const record::Sample> samples) { this->take(samples); };
  const std::size_t count = real_ ? log_.flush(take) : log_.drain(take);
  if (request_.ticks != nullptr) {
    request_.ticks->fetch_add(count, std::memory_order_relaxed);
  }
  take_frames();
  desk_.take_messages();
  constexpr std::chrono::milliseconds kFlushEvery{500};
  if (real_ && Clock::now() - flushed_ >= kFlushEvery) {
    flushed_ = Clock::now();
    writer_.flush();
  }
}

void Session::take(std::span<const record::Sample> samples) {
  writer_.append(samples);
  desk_.follow(samples, 1e9 / d_.rate);
  if (outlet_) {
    outlet_->push(samples);
  }
}

void Session::take_frames() {
  if (screen_) {
    writer_.add_frames(screen_->take_frames());
  }
}

/// On the real clock, without force.
void Session::wait(double seconds, const char* state) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end && !asked_to_stop() && !desk_.wishes().abort) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    desk_.status().break_left = std::chrono::duration<double>(end - Clock::now()).count();
    collect();
    publish(state);
  }
  desk_.status().break_left = 0.0;
}

void Session::wait_for_experimenter(const char* state) {
  Wishes& wishes = desk_.wishes();
  wishes.pause = true;
  while ((wishes.pause || wishes.stopped) && !wishes.abort) {
    wait(0.02, wishes.stopped ? "stopped" : state);
    if (asked_to_stop()) {
      throw RunError(
          fmt::format("interrupted; what was recorded is in {}.partial", request_.file.string()));
    }
  }
}

/// For the hand to come back into the workspace; ticks are recorded all the same.
void Session::recover() {
  if (real_) {
    wait(d_.guidance.recovery, "recovering");
  } else {
    const std::uint64_t end =
        loop_.ticks() + static_cast<std::uint64_t>(d_.guidance.recovery * d_.rate);
    task_.leave_before(end);
    while (loop_.ticks() < end) {
      loop_.run(task_);
      collect();
    }
  }
  task_.clear_fault();
}

void Session::take_break() {
  event("break", fmt::format("{} s", d_.design.break_duration));
  if (real_) {
    show_text(d_.texts.rest, "", d_.design.break_duration);
    wait(d_.design.break_duration, "break");
  }
}

void Session::show_text(const std::string& text, const std::string& hint, double countdown) {
  if (screen_) {
    render::TextPage page = page_of(text, hint);
    if (countdown > 0.0) {
      page.countdown = countdown;
    }
    screen_->show_text(std::move(page));
  }
  desk_.status().screen = text;
}

void Session::publish(const char* state) {
  if (!desk_.attended()) {
    return;
  }
  SessionStatus& status = desk_.status();
  status.subject = request_.subject;
  status.device = request_.device;
  status.simulated = rig_->subject() != nullptr;
  status.rate = d_.rate;
  status.trial = row_.trial;
  status.block = row_.block;
  status.condition = row_.condition;
  status.phase = row_.phase == record::Phase::kTest ? "test" : "training";
  status.ticks = loop_.ticks();
  status.overruns = loop_.overruns();
  status.dropped = log_.dropped();
  status.aborted_passes = summary_.aborted_passes;
  desk_.publish(state);
}

void Session::draw_pictures(const PlannedTrial& trial, record::Phase phase) {
  int number = 0;
  for (const stimulus::Presentation& moment : capture_.take()) {
    const auto file =
        request_.frames_folder /
        fmt::format("{}-trial{:02}-{}-{:02}.png", request_.subject, trial.trial,
                    phase == record::Phase::kTest ? "test" : trial.condition, ++number);
    render::write_png(file, renderer_->draw(moment));
  }
}

std::int64_t Session::now_ns() const {
  const double seconds = static_cast<double>(loop_.ticks()) / d_.rate;
  return before_.last_time_ns + 1 + static_cast<std::int64_t>(seconds * 1e9);
}

void Session::event(const std::string& kind, const std::string& text) {
  writer_.add_event({now_ns(), kind, text});
  if (outlet_) {
    outlet_->mark(kind + (text.empty() ? "" : ": " + text), now_ns());
  }
}

void Session::finish() {
  join_servo();
  append_rest();
  take_frames();
  event("session_end", desk_.wishes().abort ? "ended by the experimenter" : "");
  write_timing();
  writer_.close();
  publish("ended");
}

void Session::give_up() noexcept {
  try {
    join_servo();
    if (!real_) {
      writer_.discard();  // a dry run can be repeated; half of one is of no use
      return;
    }
    append_rest();
    if (row_open_ && task_.result().begun) {
      record_pass(record::PassStatus::kAborted, task_.idle()
                                                    ? task_.result().last_sample
                                                    : before_.next_sequence + loop_.ticks() - 1);
    }
    event("interrupted", "the session did not come to its end");
    writer_.sync();
  } catch (const std::exception&) {
    // What stopped the session is the error to report; the writer keeps what it could.
  }
}

/// Rows for the passes during which an earlier run of this session ended.
void Session::record_broken_passes() {
  for (const record::OpenPass& open : before_.open_passes) {
    record::PassRow row;
    row.condition = "unknown";
    row.first_sample = open.first_sample;
    row.last_sample = open.last_sample;
    row.status = record::PassStatus::kAborted;
    writer_.add_pass(row);
  }
}

void Session::join_servo() {
  if (servo_.joinable()) {
    loop_.request_stop();
    servo_.join();
  }
  rig_->device().write(Eigen::Vector3d::Zero());
}

void Session::append_rest() {
  log_.flush([this](std::span<const record::Sample> samples) { take(samples); });
}

bool Session::asked_to_stop() const {
  return interrupted() ||
         (request_.cancel != nullptr && request_.cancel->load(std::memory_order_relaxed));
}

void Session::write_timing() {
  const auto note = [this](const std::string& notice) {
    if (!notice.empty()) {
      summary_.notices.push_back(notice);
    }
  };
  note(loop_.real_time_status().notice);
  if (loop_.resynchronised() > 0) {
    note(fmt::format("the loop was suspended {} times and took up the present time",
                     loop_.resynchronised()));
  }
  if (screen_) {
    note(screen_->summary().notice);
    note(screen_->trouble());
  }
  for (const std::string& notice : summary_.notices) {
    event("notice", notice);
  }
  const realtime::LoopTiming& timing = loop_.timing();
  std::vector<record::TimingRow> rows;
  for (std::size_t i = 0; i < realtime::DurationHistogram::kBins; ++i) {
    const auto period = timing.period.bin(i);
    const auto lateness = timing.lateness.bin(i);
    const auto compute = timing.compute.bin(i);
    if (period.count + lateness.count + compute.count > 0) {
      rows.push_back({period.low, period.high, period.count, lateness.count, compute.count});
    }
  }
  summary_.ticks = loop_.ticks();
  summary_.overruns = loop_.overruns();
  summary_.dropped = log_.dropped();
  writer_.set_timing(rows, {summary_.ticks, summary_.overruns, summary_.dropped});
}

}  // namespace

SessionSummary run_session(const SessionRequest& request) { return Session(request).run(); }

double estimated_ticks(const Definition& d, int trials) {
  // A wandering curve is about twice as long as its extent; approach and return take seconds.
  const double run = 2.0 * d.trajectory.length_x / d.trajectory.speed;
  const double around =
      d.guidance.wait + 2.0 * 1.875 * d.trajectory.length_x / d.guidance.approach_speed;
  return d.rate * 2.0 * trials * (run + around);
}

}  // namespace haptrial::experiments
