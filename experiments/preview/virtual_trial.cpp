#include "experiments/preview/virtual_trial.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "core/base/error.h"
#include "core/realtime/servo_loop.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/control/live_status.h"
#include "protocols/definition/definition.h"
#include "protocols/interface/session_file.h"
#include "protocols/interface/session_task.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {
namespace {

using protocols::SessionTask;

/// Keeps the stages of what would be a session's file.
class StagesInMemory final : public protocols::SessionFile {
 public:
  std::vector<record::StageRow> stages;

  void keep_stimulus(std::int32_t, std::span<const record::StimulusRow>) override {}
  bool holds_stimulus(std::int32_t) const override { return true; }
  void event(const std::string&, const std::string&) override {}
  const std::vector<record::PassRow>& earlier_passes() const override { return none_; }
  bool was_cut_short(const protocols::PlannedTrial&) const override { return false; }

 protected:
  void put(const record::Rows& batch) override {
    const auto rows = batch.as<record::StageRow>();
    stages.insert(stages.end(), rows.begin(), rows.end());
  }

 private:
  std::vector<record::PassRow> none_;
};

/// A session of which one trial is presented.
class OneTrial {
 public:
  OneTrial(const protocols::Protocol& protocol, const protocols::Definition& d,
           const protocols::SessionPlace& place)
      : d_(d),
        trials_(protocol.trials(d, place)),
        rig_(trials_->virtual_rig()),
        loop_(realtime::ClockKind::kSimulated, d.rate),
        task_({.devices = rig_->arms(d.envelope),
               .loop = protocols::handle_loop(d),
               .log = log_,
               .device_log = &others_,
               .tick_log = trials_->tick_log(),
               .observers = observers()},
              SessionTask::Leave::kAfterPassOrSlice) {}

  VirtualTrial present(int number, double longest) {
    protocols::PlannedTrial trial = trial_at(number);
    trials_->prepare(trial, file_);
    trials_->begin_attempt(trial, true);
    shown_.completed = true;
    for (const record::Phase& phase : trials_->phases()) {
      phase_ = phase;
      run(trials_->make_pass(trial, phase), longest);
      trials_->empty_logs(file_);
      trials_->close_pass(file_, 0);
      note_answers();
      if (!shown_.completed) {
        break;
      }
    }
    note_stages();
    return std::move(shown_);
  }

 private:
  std::vector<stimulus::Observer*> observers() {
    std::vector<stimulus::Observer*> all = trials_->observers();
    if (rig_->subject() != nullptr) {
      all.insert(all.begin(), rig_->subject());
    }
    return all;
  }

  protocols::PlannedTrial trial_at(int number) {
    std::optional<protocols::PlannedTrial> trial = trials_->next(nullptr);
    for (int at = 1; trial && at < number; ++at) {
      const protocols::Outcome done{*trial, protocols::TrialEnd::kCompleted, {}};
      trial = trials_->next(&done);
    }
    if (!trial || number < 1) {
      throw InputError(fmt::format("--trial is {}; allowed: a trial of the session", number));
    }
    return *trial;
  }

  void run(protocols::Pass& pass, double longest) {
    task_.start(pass, 0);
    const auto most = static_cast<std::uint64_t>(longest * d_.rate);
    while (!task_.idle() && loop_.ticks() < most) {
      loop_.run(task_);
      take_samples();
      trials_->empty_logs(file_);
      rig_->attend();
    }
    if (!task_.idle()) {
      shown_.completed = false;
      shown_.why = fmt::format("it was left after {:g} s", longest);
      task_.break_off();
      while (!task_.idle()) {
        loop_.run(task_);
        take_samples();
      }
    } else if (task_.result().state != protocols::PassState::kCompleted) {
      shown_.completed = false;
      shown_.why = trials_->why_aborted();
    }
  }

  void take_samples() {
    log_.flush([this](std::span<const record::Sample> samples) {
      for (const record::Sample& sample : samples) {
        if (sample.pass < 0) {
          continue;
        }
        if (shown_.times.empty()) {
          begin_ = sample.sequence;
        }
        shown_.times.push_back(time_of(sample.sequence));
        shown_.positions.push_back(sample.position);
        shown_.velocities.push_back(sample.velocity);
        shown_.forces.push_back(sample.force);
        note_stage(sample);
      }
    });
    others_.flush([](std::span<const record::DeviceRow>) {});
  }

  /// Keeps the stages of samples, for a protocol that records no others.
  void note_stage(const record::Sample& sample) {
    if (sample.stage == record::Stage::kIdle) {
      return;
    }
    const std::string name = fmt::format("{}: {}", record::name_of(phase_), name_of(sample.stage));
    if (sampled_.empty() || sampled_.back().name != name) {
      sampled_.push_back({name, 0, time_of(sample.sequence), 0.0});
    }
    sampled_.back().end = time_of(sample.sequence + 1);
  }

  double time_of(std::uint64_t sequence) const {
    return (static_cast<double>(sequence) - static_cast<double>(begin_)) / d_.rate;
  }

  void note_stages() {
    for (const record::StageRow& row : file_.stages) {
      shown_.stages.push_back(
          {row.stage, row.interval, time_of(row.first_sample), time_of(row.last_sample + 1)});
    }
    if (shown_.stages.empty()) {
      shown_.stages = std::move(sampled_);
    }
  }

  void note_answers() {
    for (const record::ResponseRow& row : trials_->responses()) {
      const std::string words = !row.text.empty()          ? row.text
                                : std::isfinite(row.value) ? fmt::format("{:g}", row.value)
                                                           : "";
      if (!words.empty()) {
        shown_.answers.push_back(fmt::format("{}: {}", row.question, words));
      }
    }
  }

  const protocols::Definition& d_;
  std::unique_ptr<protocols::Trials> trials_;
  std::unique_ptr<protocols::Rig> rig_;
  SessionTask::Log log_{1024, 4};  // emptied after every slice
  SessionTask::DeviceLog others_{1024, 4};
  realtime::ServoLoop loop_;
  SessionTask task_;
  StagesInMemory file_;
  VirtualTrial shown_;
  record::Phase phase_;                // that runs
  std::vector<VirtualStage> sampled_;  // stages of the samples
  std::uint64_t begin_{0};             // sequence number of the first sample
};

}  // namespace

VirtualTrial virtual_trial(const protocols::Protocol& protocol, const protocols::Definition& d,
                           const protocols::SessionPlace& place, int number, double longest) {
  return OneTrial(protocol, d, place).present(number, longest);
}

}  // namespace haptrial::experiments
