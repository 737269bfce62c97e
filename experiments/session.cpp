#include "experiments/session.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/record/session_writer.h"
#include "core/render/frames.h"
#include "experiments/frame_capture.h"
#include "experiments/interrupt.h"
#include "experiments/version.h"
#include "experiments/virtual_rig.h"
#include "protocols/recall_test.h"
#include "protocols/session_task.h"
#include "protocols/training_pass.h"

namespace haptrial::experiments {
namespace {

using realtime::ClockKind;

std::vector<record::StimulusRow> stimulus_rows(const stimulus::Stimulus& s, std::int32_t block,
                                               double rate) {
  std::vector<record::StimulusRow> rows;
  const auto count = static_cast<std::size_t>(s.path.duration() * rate) + 1;
  rows.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / rate;
    rows.push_back({block, t, s.path.at(t).position, s.force.at(t)});
  }
  return rows;
}

class Session {
 public:
  explicit Session(const SessionRequest& request);
  SessionSummary run();

 private:
  record::SessionInfo info() const;
  std::vector<stimulus::Observer*> observers();
  void run_trial(const protocols::PlannedTrial& trial);
  void run_pass(std::unique_ptr<protocols::TrajectoryPass> pass,
                const protocols::PlannedTrial& trial, record::Phase phase);
  void drive_until_idle();
  void drain();
  void recover();
  void pause(double seconds);
  void take_break();
  void draw_frames(const protocols::PlannedTrial& trial, record::Phase phase);
  void event(const std::string& kind, const std::string& text);
  void append_rest();
  void join_servo();
  void give_up() noexcept;
  void record_broken_pass();
  void record_pass(record::PassStatus status, std::uint64_t last_sample);
  bool asked_to_stop() const;
  void write_timing();

  const SessionRequest& request_;
  const Definition& d_;
  std::uint64_t session_seed_;
  VirtualRig rig_;
  FrameCapture capture_;
  std::optional<render::FrameRenderer> renderer_;
  protocols::SessionTask::Log log_;
  protocols::SessionTask task_;
  realtime::ServoLoop loop_;
  record::SessionWriter writer_;
  // Kept here, not in a function: the servo thread may be using them when an error leaves it.
  std::optional<stimulus::Stimulus> stimulus_;
  std::unique_ptr<protocols::TrajectoryPass> pass_;
  std::thread servo_;    // on a real clock
  record::PassRow row_;  // of the present pass
  SessionSummary summary_;
};

Session::Session(const SessionRequest& request)
    : request_(request),
      d_(*request.definition),
      session_seed_(derived_seed(request.seed, "participant " + request.subject)),
      rig_(d_, session_seed_),
      capture_(request.frames_per_pass),
      task_(rig_.device(), d_.envelope, log_, observers(),
            request.clock == ClockKind::kReal ? protocols::SessionTask::Leave::kNever
                                              : protocols::SessionTask::Leave::kAfterPassOrSlice),
      loop_(request.clock, d_.rate),
      writer_(request.file, info()) {
  if (request.frames_per_pass > 0) {
    renderer_.emplace(d_.display);
  }
}

std::vector<stimulus::Observer*> Session::observers() {
  std::vector<stimulus::Observer*> all{&rig_.subject()};
  if (request_.frames_per_pass > 0) {
    all.push_back(&capture_);
  }
  return all;
}

record::SessionInfo Session::info() const {
  record::SessionInfo info;
  info.program_version = program_version();
  info.program_commit = program_commit();
  info.definition = d_.text;
  info.definition_name = d_.file_name;
  info.subject = request_.subject;
  info.seed = request_.seed;
  info.device = "virtual";
  info.device_max_force = d_.device.max_force;
  info.device_workspace_radius = d_.device.workspace_radius;
  info.clock = request_.clock == ClockKind::kReal ? "real" : "simulated";
  info.rate = d_.rate;
  info.start_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  info.simulated = true;
  return info;
}

SessionSummary Session::run() {
  const auto plan =
      protocols::plan_trials(d_.design, request_.participant, request_.seed, session_seed_);
  event("session_start", fmt::format("{} trials planned", plan.size()));
  if (request_.clock == ClockKind::kReal) {
    servo_ = std::thread([this] { loop_.run(task_); });
  }
  try {
    for (const protocols::PlannedTrial& trial : plan) {
      if (request_.max_trials > 0 && trial.trial > request_.max_trials) {
        break;
      }
      run_trial(trial);
      if (trial.trial == d_.design.break_after) {
        take_break();
      }
    }
    join_servo();
    append_rest();
    event("session_end", "");
    write_timing();
    writer_.close();
  } catch (...) {
    give_up();
    throw;
  }
  return summary_;
}

void Session::give_up() noexcept {
  try {
    join_servo();
    if (request_.clock == ClockKind::kSimulated) {
      writer_.discard();  // a dry run can be repeated; half of one is of no use
    } else {
      append_rest();
      record_broken_pass();
      event("interrupted", "the session did not come to its end");
      write_timing();
    }
  } catch (const std::exception&) {
    // What stopped the session is the error to report; the writer keeps what it could.
  }
}

bool Session::asked_to_stop() const {
  return interrupted() ||
         (request_.cancel != nullptr && request_.cancel->load(std::memory_order_relaxed));
}

void Session::run_trial(const protocols::PlannedTrial& trial) {
  if (trial.repetition == 1) {
    stimulus_ = stimulus::make_stimulus(d_.trajectory, d_.force_pattern, trial.stimulus_seed);
    writer_.add_stimulus(stimulus_rows(*stimulus_, trial.block, d_.stimulus_rate));
    if (renderer_) {
      renderer_->set_trajectory(stimulus_->path.points());
    }
  }
  run_pass(protocols::make_training_pass(trial.condition, *stimulus_, d_.guidance, trial.block),
           trial, record::Phase::kTraining);
  run_pass(std::make_unique<protocols::RecallTest>(*stimulus_, d_.guidance, trial.block), trial,
           record::Phase::kTest);
}

void Session::run_pass(std::unique_ptr<protocols::TrajectoryPass> pass,
                       const protocols::PlannedTrial& trial, record::Phase phase) {
  pass_ = std::move(pass);
  row_ = {};
  row_.trial = trial.trial;
  row_.condition = trial.condition;
  row_.phase = phase;
  row_.block = trial.block;
  row_.repetition = trial.repetition;
  row_.stimulus_seed = trial.stimulus_seed;
  task_.start(*pass_, summary_.passes++);
  drive_until_idle();
  const protocols::PassResult& result = task_.result();
  const bool aborted = result.state == protocols::PassState::kAborted;
  record_pass(aborted ? record::PassStatus::kAborted : record::PassStatus::kCompleted,
              result.last_sample);
  if (aborted) {
    ++summary_.aborted_passes;
    const bool fault = result.fault != device::Fault::kNone;
    event("aborted", fmt::format("trial {}: {}", trial.trial,
                                 fault ? device::describe(result.fault)
                                       : "the tool did not settle at the start in time"));
    recover();
  }
  if (renderer_) {
    draw_frames(trial, phase);
  }
}

void Session::record_pass(record::PassStatus status, std::uint64_t last_sample) {
  row_.first_sample = task_.result().first_sample;
  row_.last_sample = last_sample;
  row_.status = status;
  writer_.add_pass(row_);
  if (request_.clock == ClockKind::kReal) {
    writer_.flush();
  }
}

/// The pass during which the session ended: its samples are there, so it has a row. Without a servo
/// thread.
void Session::record_broken_pass() {
  if (!task_.idle() && task_.result().begun) {
    record_pass(record::PassStatus::kAborted, loop_.ticks() - 1);
  }
}

void Session::drive_until_idle() {
  while (!task_.idle()) {
    if (request_.clock == ClockKind::kSimulated) {
      loop_.run(task_);
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    drain();
    if (asked_to_stop()) {
      task_.emergency_stop();
      throw RunError(request_.clock == ClockKind::kReal
                         ? fmt::format("interrupted; what was recorded is in {}.partial",
                                       request_.file.string())
                         : "interrupted");
    }
  }
}

void Session::drain() {
  const std::size_t count =
      log_.drain([this](std::span<const record::Sample> samples) { writer_.append(samples); });
  if (request_.ticks != nullptr) {
    request_.ticks->fetch_add(count, std::memory_order_relaxed);
  }
}

void Session::pause(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end && !asked_to_stop()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    drain();
  }
}

/// Without force, for the hand to come back into the workspace; ticks are recorded all the same.
void Session::recover() {
  if (request_.clock == ClockKind::kReal) {
    pause(d_.guidance.recovery);
  } else {
    const std::uint64_t end =
        loop_.ticks() + static_cast<std::uint64_t>(d_.guidance.recovery * d_.rate);
    task_.leave_before(end);
    while (loop_.ticks() < end) {
      loop_.run(task_);
      drain();
    }
  }
  task_.clear_fault();
}

void Session::take_break() {
  event("break", fmt::format("{} s", d_.design.break_duration));
  writer_.flush();
  if (request_.clock == ClockKind::kReal) {
    pause(d_.design.break_duration);
  }
}

void Session::draw_frames(const protocols::PlannedTrial& trial, record::Phase phase) {
  int number = 0;
  for (const stimulus::Presentation& moment : capture_.take()) {
    const auto file =
        request_.frames_folder /
        fmt::format("{}-trial{:02}-{}-{:02}.png", request_.subject, trial.trial,
                    phase == record::Phase::kTest ? "test" : trial.condition, ++number);
    render::write_png(file, renderer_->draw(moment));
  }
}

void Session::event(const std::string& kind, const std::string& text) {
  const double seconds = static_cast<double>(loop_.ticks()) / d_.rate;
  writer_.add_event({static_cast<std::int64_t>(seconds * 1e9), kind, text});
}

void Session::join_servo() {
  if (servo_.joinable()) {
    loop_.request_stop();
    servo_.join();
  }
  rig_.device().write(Eigen::Vector3d::Zero());
}

void Session::append_rest() {
  log_.flush([this](std::span<const record::Sample> samples) { writer_.append(samples); });
}

void Session::write_timing() {
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
  summary_.notice = loop_.real_time_status().notice;
  if (!summary_.notice.empty()) {
    event("notice", summary_.notice);
  }
  if (loop_.resynchronised() > 0) {
    event("notice", fmt::format("the loop was suspended {} times and took up the present time",
                                loop_.resynchronised()));
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
