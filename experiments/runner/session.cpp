#include "experiments/runner/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/exception_words.h"
#include "core/record/read/session_facts.h"
#include "experiments/control/progress.h"
#include "experiments/control/session_controller.h"
#include "experiments/control/signals.h"
#include "experiments/plan/plan_log.h"
#include "experiments/runner/devices.h"
#include "experiments/runner/earlier_run.h"
#include "experiments/runner/last_answer.h"
#include "experiments/runner/loop_pacing.h"
#include "experiments/runner/next_trial.h"
#include "experiments/runner/participant_input.h"
#include "experiments/runner/servo_thread.h"
#include "experiments/runner/session_notices.h"
#include "experiments/runner/session_opening.h"
#include "experiments/runner/session_pages.h"
#include "experiments/runner/session_record.h"
#include "experiments/runner/trial_presenter.h"
#include "experiments/screen/screen.h"
#include "experiments/screen/speaker.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/groups.h"
#include "protocols/definition/speech_options.h"
#include "protocols/interface/recorded_definition.h"
#include "protocols/interface/session_task.h"
#include "protocols/interface/trials.h"
#include "protocols/tutoring/tutored_trials.h"

namespace haptrial::experiments {
namespace {

using protocols::Outcome;
using protocols::PlannedTrial;
using protocols::TrialEnd;
using realtime::ClockKind;

class Session {
 public:
  explicit Session(const SessionRequest& request);
  ~Session();
  SessionSummary run();
  bool hangs() const { return servo_.thread.hangs(); }

 private:
  std::vector<stimulus::Observer*> observers();
  SessionController::Actions controller_actions();

  std::unique_ptr<Speaker> open_speaker();
  void watch_flashes();
  void hear_inputs();
  std::vector<std::string> open_channels();
  std::vector<ChannelStatus> channel_status() const;
  void run_trials();
  void note_setting();
  bool has_break_after(const PlannedTrial& trial) const;
  bool is_hopeless() const;
  bool is_anything_left_after(const Outcome& outcome);
  std::string why_given_up() const;
  protocols::SessionPlace place();

  void finish();
  void give_up() noexcept;

  const SessionRequest& request_;
  const protocols::Definition& d_;
  const bool real_;
  std::unique_ptr<Progress> progress_;  // of what takes seconds
  SessionSummary summary_;
  bool left_{false};  // trials that an abort kept from being presented to their end
  realtime::ServoLoop loop_;
  markers::OnsetLog onsets_;  // before the screen and the record, whose threads look at it
  // The trials stand before the servo: its thread may be using a pass when an error leaves a
  // function.
  protocols::SessionPlace place_;
  std::unique_ptr<protocols::Trials> trials_;
  std::unique_ptr<protocols::Rig> rig_;
  ParticipantInput input_;                 // before the screen, whose thread writes to it
  std::unique_ptr<SpeechLibrary> speech_;  // without it there is neither window nor file
  std::unique_ptr<Screen> screen_;
  std::optional<ScreenMirror> mirror_;  // of a screen
  std::unique_ptr<record::LiveFigures> live_;
  channel::ChannelSet channels_;
  SessionRecord record_;              // opened when everything else is there
  std::unique_ptr<Speaker> speaker_;  // plays on the record's sound card
  SessionController controller_;
  SessionServo servo_;
  LoopPacing pacing_;
  SessionPages pages_;
  NextTrial next_;
  LastAnswer last_answer_;
  SessionNotices notices_;
  TrialPresenter presenter_;
};

std::unique_ptr<protocols::Trials> trials_of(const SessionRequest& request,
                                             const protocols::SessionPlace& place) {
  auto trials = request.protocol->trials(*request.definition, place);
  const protocols::TutoringOptions& options = request.definition->tutoring;
  if (request.tutor) {
    const auto led = [&d = *request.definition, participant = place.participant,
                      session = place.session](int trial) {
      return d.is_led(session, {trial, participant, protocols::group_of(d.groups, participant)});
    };
    return protocols::tutored(std::move(trials), options, *request.tutor, request.definition->text,
                              led);
  }
  return request.link ? protocols::linked(std::move(trials), options, *request.link, place)
                      : std::move(trials);
}

protocols::SessionPlace Session::place() {
  protocols::SessionPlace place;
  place.subject = request_.subject;
  place.participant = request_.participant;
  place.seed = request_.seed;
  place.session = request_.session;
  const bool teaches = request_.link && request_.link->role == protocols::LinkRole::kTeaches;
  give_seeds(place, teaches ? "who teaches" : "");
  place.real = real_;
  place.window = request_.window;
  place.auxiliary_pages = request_.auxiliary_pages;
  place.frames_per_pass = request_.frames_per_pass;
  place.frames_folder = request_.frames_folder;
  place.resumed = resumed_file(request_);
  place.pulse = [this](const char* what, double share) {
    if (!progress_) {
      progress_ = std::make_unique<Progress>(what, 1.0);
    }
    pacing_.meanwhile();
    pacing_.show_progress(share);
    progress_->update(share, "", 0.0);
  };
  place.stop = [this] { servo_.task.emergency_stop(); };
  return place;
}

Session::Session(const SessionRequest& request)
    : request_(request),
      d_(*request.definition),
      real_(request.clock == ClockKind::kReal),
      loop_(request.clock, d_.rate),
      place_(place()),
      trials_(trials_of(request, place_)),
      rig_(make_rig(choices_of(request), d_, [this] { return trials_->virtual_rig(); })),
      input_(choices_of(request).front(), d_, real_,
             [this](const std::string& trial) {
               record_.event("participant_error", trial);
               notices_.note(
                   fmt::format("the participant says that the answer of {} is a mistake", trial));
             }),
      speech_(open_speech(request)),
      screen_(open_screen(request, *rig_, input_, [this] { return loop_.elapsed_ns(); })),
      live_(open_live(request)),
      channels_(make_channels(request)),
      record_(request, rig_->device().info(), loop_, *trials_, onsets_, channels_, live_.get()),
      speaker_(open_speaker()),
      controller_(request.control, controller_actions()),
      servo_(loop_,
             {.devices = rig_->arms(d_.envelope),
              .loop = protocols::handle_loop(d_),
              .log = record_.log(),
              .device_log = &record_.device_log(),
              .tick_log = trials_->tick_log(),
              .observers = observers(),
              .window = &input_.window,
              .pedal = input_.pedal.pedal(),
              .channels = d_.channels.empty() ? nullptr : &channels_,
              .onsets = d_.markers.used ? &onsets_ : nullptr},
             real_, record_.origin()),
      pacing_({request, loop_, record_, controller_, servo_.task, rig_->felt(), screen_.get(),
               &input_.begin_pressed, live_.get(),
               [this] {
                 hear_inputs();
                 last_answer_.see_to_request();
                 notices_.note(trials_->take_warnings());
                 controller_.status().partner = trials_->partner();
                 controller_.status().channels = channel_status();
                 if (live_ == nullptr) {
                   controller_.status().figures = trials_->live();
                 }
               },
               rig_.get(), [this] { return speaker_ != nullptr && speaker_->speaks(); }}),
      pages_({request, record_, controller_, pacing_, input_.page_keys, screen_.get(),
              place_.session_seed}),
      next_({request, *trials_, record_, pages_}),
      last_answer_({*trials_, record_, controller_}),
      notices_({request, loop_, record_, controller_, summary_}),
      presenter_({d_, *trials_, servo_.task, record_, controller_, pacing_, notices_, last_answer_,
                  input_.mistakes, screen_.get(), summary_, real_, [this] { progress_.reset(); }}) {
  SessionStatus& status = controller_.status();
  status.subject = request.subject;
  status.device = request.device.name;
  status.pilot = request.pilot;
  status.window = screen_ != nullptr;
  status.simulated = rig_->device().info().simulated;
  status.rate = d_.rate;
  status.force_limit = std::min(d_.envelope.max_force, rig_->device().info().max_force);
  status.has_target = d_.has_target();
  watch_flashes();
  if (screen_) {
    screen_->speak_with(speaker_.get());
  }
  if (request.control != nullptr) {
    request.control->on_emergency([this] { servo_.task.emergency_stop(); });
    if (screen_) {
      mirror_.emplace(*screen_);
      request.control->on_mirror([this] { return mirror_->picture(); });
    }
  }
}

std::unique_ptr<Speaker> Session::open_speaker() {
  return speech_ == nullptr
             ? nullptr
             : std::make_unique<Speaker>(
                   [this](const std::string& text) { return speech_->samples(text); },
                   *record_.markers().player(), protocols::speech_of(d_).seconds);
}

/// The frames that show a photodiode what began.
void Session::watch_flashes() {
  if (screen_ && d_.screen.photodiode == protocols::Photodiode::kOnset) {
    screen_->flash_with(&onsets_);
    record_.markers().watch([this] {
      std::vector<Flash> flashes = screen_->take_flashes();
      for (Flash& flash : flashes) {
        flash.time_ns = record_.session_time(flash.time_ns);
      }
      return flashes;
    });
  }
}

void Session::hear_inputs() {
  for (const InputNews& news : input_.take_news(rig_->gamepad())) {
    record_.event(news.event, news.text);
    notices_.note(news.notice);
  }
  notices_.note(channels_.take_news());
  notices_.note(screen_ ? screen_->trouble() : "");
  for (const SpokenText& spoken : speaker_ ? speaker_->take_spoken() : std::vector<SpokenText>{}) {
    record_.event_at(spoken.begun_ns, "spoken", spoken.text);
  }
  if (!record_.in_pass()) {  // else its end shows whether it was answered before
    input_.mistakes.see_to(record_.pass());
  }
}

/// The channels' threads outlive the record, and ask for the time until they end.
/// @returns sentences on those that do not answer
std::vector<std::string> Session::open_channels() {
  const auto now = [&loop = loop_, start_ns = record_.session_time(0)] {
    return start_ns + loop.elapsed_ns();
  };
  return channels_.start(now, next_samples(request_, channels_));
}

std::vector<ChannelStatus> Session::channel_status() const {
  std::vector<ChannelStatus> all;
  for (const auto& [options, state] : channels_.seen()) {
    ChannelStatus status{options->name, state.live, {}};
    const auto& quantities = options->plan.quantities;
    for (std::size_t i = 0; state.live && i < quantities.size(); ++i) {
      status.values.push_back({quantities[i].name, state.values[i], quantities[i].unit});
    }
    all.push_back(std::move(status));
  }
  return all;
}

Session::~Session() {
  if (screen_) {
    screen_->speak_with(nullptr);
  }
  servo_.watched.reset();
  if (request_.control != nullptr) {
    request_.control->on_emergency(nullptr);
    request_.control->on_mirror(nullptr);
  }
}

SessionController::Actions Session::controller_actions() {
  return {[this] { servo_.task.break_off(); }, [this] { servo_.task.clear_fault(); },
          [this](const std::string& kind, const std::string& text) { record_.event(kind, text); },
          request_.link ? [this](bool take) { trials_->take_lead(take); }
                        : std::function<void(bool)>()};
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
  const protocols::Extent extent = trials_->extent(request_.max_trials);
  try {
    const std::vector<std::string> missing = open_channels();
    record_.set_planned(extent.trials);
    record_.open(planned_of(extent, trials_->extent(0).trials));
    if (real_) {
      servo_.thread.start();
    }
    notices_.note_real_time();
    channels_.begin();  // after the first tick: before it, the session's clock stands
    notices_.note(missing);
    notices_.note(record_.notice());
    notices_.note(device_change(request_, record_.earlier().info));
    if (screen_) {
      notices_.note(screen_->summary().notice);
    }
    notices_.note(record_.markers().notice());
    notices_.note(input_.pedal.notice());
    notices_.note(trials_->notices());
    notices_.say_plan(extent, trials_->extent(0).trials,
                      finished_trials(record_.earlier(), trials_->phases().back()));
    run_trials();
    finish();
  } catch (...) {
    give_up();
    throw;
  }
  return summary_;
}

void Session::run_trials() {
  note_setting();
  if (const std::string tutor = tutor_text(request_); !tutor.empty()) {
    record_.event("tutor", tutor);
  }
  if (!pages_.before()) {
    left_ = !pages_.declined();
    if (pages_.declined()) {
      notices_.note("the participant did not agree to take part, so nothing was presented");
      pacing_.let_read(d_.texts.declined, "thanks");
    }
    return;
  }
  pacing_.wait_to_begin(d_.instructions());
  bool practised = false;
  std::optional<PlannedTrial> trial = next_.after(nullptr);
  while (trial) {
    if (controller_.requests().abort) {
      left_ = true;
      break;
    }
    if (trial->practice != practised) {  // practice begins or is over
      pacing_.wait_to_begin(trial->practice ? d_.texts.practice : d_.texts.counts);
      practised = trial->practice;
    }
    const Outcome outcome = presenter_.present(*trial);
    if (last_answer_.goes_back()) {
      trial = last_answer_.go_back();
      continue;
    }
    left_ = left_ || (outcome.end == TrialEnd::kAborted && controller_.requests().abort);
    if (is_hopeless()) {
      break;
    }
    const bool stopped = controller_.requests().abort;
    const bool rests = has_break_after(*trial) && !stopped;
    if (stopped) {
      left_ = left_ || is_anything_left_after(outcome);
      break;
    }
    trial = next_.after(&outcome);
    const PlannedTrial& over = outcome.trial;
    if (!trial || trial->block != over.block) {
      last_answer_.forget();
      if (!pages_.after_block(over.block, over.block_name)) {
        left_ = true;
        break;
      }
    }
    if (rests && trial) {
      pacing_.take_break();
      trial = last_answer_.goes_back() ? last_answer_.go_back() : trial;
    }
  }
  left_ = left_ || next_.ended_at_page() || is_hopeless();
  if (!left_ && !pages_.after()) {
    left_ = true;
  }
  pacing_.let_read(d_.texts.thanks, "thanks");
}

/// Events for each run: a resumed session may go on in another language, and with other devices.
void Session::note_setting() {
  const int devices = protocols::tips_of(d_.arms());
  if (devices > 1 && request_.device.name != "virtual") {
    record_.event(kDevicesEvent, devices_text(choices_of(request_), devices));
  }
  if (!d_.language.empty()) {
    record_.event(protocols::kLanguageEvent, d_.language);
    record_.event(protocols::kLanguageTextsEvent, d_.language_texts);
  }
  if (const std::string name = d_.case_of_session(); !name.empty()) {
    record_.event(record::kCaseEvent, name);
  }
  if (d_.display.mirrored) {
    record_.event(record::kMirroredEvent,
                  "x of W runs to the left: the participant is left-handed");
  }
}

/// A virtual participant whose first 20 passes were all aborted will not complete any other.
bool Session::is_hopeless() const {
  constexpr int kTries = 20;
  return !real_ && summary_.passes >= kTries && summary_.aborted_passes == summary_.passes;
}

/// The reason that no further trial is presented; empty: none are left, or somebody asked for it.
std::string Session::why_given_up() const {
  return is_hopeless() ? fmt::format(
                             "the session ended with trials left, since each of its {} "
                             "passes was aborted",
                             summary_.passes)
                       : trials_->why_given_up();
}

/// Whether a break follows, after every `break_after` trials.
bool Session::has_break_after(const PlannedTrial& trial) const {
  const int after = d_.design.break_after;
  return after > 0 && !trial.practice && trial.trial % after == 0;
}

/// Trials, or pages after the last block; those at the end of the session refuse by themselves.
bool Session::is_anything_left_after(const Outcome& outcome) {
  return next_.after(&outcome) || pages_.has_after_block(outcome.trial.block_name);
}

void Session::finish() {
  servo_.end();
  if (screen_) {
    record_.keep_frames(screen_->take_frames());
  }
  hear_inputs();
  notices_.note(input_.losses(rig_->gamepad()));
  notices_.note_troubles(live_.get(), screen_.get());
  notices_.note(trials_->notices());  // what came up meanwhile
  const PendingRequests& requests = controller_.requests();
  summary_.stopped = left_ && requests.abort && !requests.for_good;
  if (summary_.stopped) {
    record_.stop("by the experimenter; --resume continues at the first unfinished trial");
  } else {
    if (left_ && requests.for_good) {
      record_.event(record::kEndedForGood, "by the experimenter, with trials left");
    }
    if (const std::string why = why_given_up(); !why.empty()) {
      record_.event(record::kGivenUp, why);
      notices_.note(why);
      summary_.given_up = true;
    }
    record_.close(requests.abort ? "ended by the experimenter" : "");
  }
  if (live_) {
    live_->finish();
    summary_.figures = live_->done();
  }
  summary_.markers = record_.markers().latencies();
  summary_.simulated = rig_->device().info().simulated;
  summary_.ticks = loop_.ticks();
  summary_.overruns = loop_.overruns();
  summary_.dropped = record_.dropped();
  pacing_.publish("ended");
}

void Session::give_up() noexcept {
  try {
    servo_.task.break_off();
    servo_.end();
  } catch (const std::exception&) {
    // The thread is left behind; what it recorded is kept all the same.
  }
  try {
    record_.give_up(servo_.task);
  } catch (const std::exception&) {
    // The error to report is the one that stopped the session; the writer keeps the rows that it
    // could.
  }
}

/// The session is done whether or not its plan's log can be written.
void note_closed(const std::filesystem::path& file) {
  try {
    note_closed_session(file);
  } catch (const std::exception& error) {
    fmt::print(stderr, "warning: the plan's log does not have this session: {}\n",
               sentence_of(error));
  }
}

}  // namespace

SessionSummary run_session(const SessionRequest& request) {
  if (request.resume && repair_or_close(request)) {
    SessionSummary closed;
    note_closed(request.file);
    closed.notices.push_back("the session had ended before: its file only had to be closed");
    return closed;
  }
  auto session = std::make_unique<Session>(request);
  SessionSummary done;
  try {
    done = session->run();
  } catch (...) {
    if (session->hangs()) {
      static_cast<void>(session.release());  // its servo thread may yet come back to it
    }
    throw;
  }
  if (!done.stopped) {
    note_closed(request.file);
  }
  return done;
}

}  // namespace haptrial::experiments
