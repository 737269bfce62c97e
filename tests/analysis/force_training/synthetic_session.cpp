#include "tests/analysis/force_training/synthetic_session.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/record/hdf5/session_writer.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::analysis {
namespace {

using record::Phase;
using record::Stage;

const char* const kConditions[] = {"haptic", "visual", "visuohaptic"};

Eigen::Vector3d path(double t) { return {0.016 * t - 0.05, 0.0, synthetic_path_z(t)}; }

class Writer {
 public:
  Writer(const std::filesystem::path& file, const SyntheticSession& session)
      : session_(session),
        writer_(file, info(session), {&record::table_of<record::DampingRow>()}) {}

  void write() {
    for (int block = 1; block <= session_.blocks; ++block) {
      add_stimulus(block);
      for (int repetition = 1; repetition <= session_.repetitions; ++repetition) {
        add_trial(block, repetition);
      }
    }
    if (!session_.finished) {
      writer_.flush();
      return;
    }
    const std::vector<record::TimingRow> histogram{{0, 1'000'000, 0, 99, 90},
                                                   {1'000'000, 2'000'000, 99, 1, 10},
                                                   {2'000'000, 3'000'000, 1, 0, 0}};
    writer_.set_timing(histogram, {next_, 2, 0});
    writer_.close();
  }

 private:
  static record::SessionInfo info(const SyntheticSession& session) {
    record::SessionInfo info;
    info.program_version = "0.1.0";
    info.program_commit = "0123abc";
    info.definition = "name = \"synthetic <definition>\"\n";
    info.definition_name = "synthetic.toml";
    info.subject = session.subject;
    info.device = "virtual";
    info.clock = session.clock;
    info.rate = session.rate;
    info.start_utc = "2026-11-20T09:30:00Z";
    info.simulated = session.simulated;
    info.session = static_cast<std::uint64_t>(session.session);
    return info;
  }

  void add_stimulus(int block) {
    std::vector<record::StimulusRow> rows;
    for (int i = 0; i * 0.01 < session_.seconds + 0.01; ++i) {
      rows.push_back({block, i * 0.01, path(i * 0.01), session_.target(i * 0.01)});
    }
    if (session_.stimulus_backwards) {
      std::reverse(rows.begin(), rows.end());
    }
    writer_.add_stimulus(rows);
  }

  void add_trial(int block, int repetition) {
    const int trial = (block - 1) * session_.repetitions + repetition;
    record::PassRow row{trial, kConditions[(block - 1) % 3], Phase::kTraining, block, repetition};
    row.attempt = trial == session_.second_attempt ? 2 : 1;
    record::PassRow training = row;
    if (trial == session_.untrained_trial) {
      training.status = record::PassStatus::kAborted;
    }
    add_pass(training, 1.0);
    if (trial == session_.untested_trial) {
      return;
    }
    record::PassRow test = row;
    test.phase = Phase::kTest;
    if (trial == session_.aborted_trial) {
      test.status = record::PassStatus::kAborted;
    }
    if (trial == session_.repeated_trial) {
      add_pass(test, 2.0);
    }
    add_pass(test, 1.0);
  }

  void add_pass(record::PassRow row, double force_factor) {
    row.first_sample = next_;
    std::vector<record::Sample> samples;
    add_rest(samples, Stage::kApproach);
    const auto count = static_cast<int>(session_.seconds * session_.rate);
    for (int k = 0; k < count; ++k) {
      const double t = k / session_.rate;
      auto& s = add_tick(samples, Stage::kRun);
      s.position = path(t - session_.lag) + session_.offset;
      s.target_force = session_.target(t);
      s.applied_force =
          force_factor * session_.applied(row.condition, row.trial, t, s.target_force);
      if (session_.force_limit > 0.0 && std::abs(s.applied_force) >= session_.force_limit) {
        s.saturated = true;
        s.applied_force = std::copysign(session_.force_limit, s.applied_force);
      }
    }
    add_rest(samples, Stage::kReturn);
    row.last_sample = next_ - 1;
    if (row.trial == session_.damaged_trial && row.phase == Phase::kTest) {
      samples.erase(samples.begin() + 100);
    }
    writer_.append(samples);
    writer_.add_pass(row);
    ++pass_;
    if (row.phase == Phase::kTraining) {
      add_training_events(row.trial, samples.front().time_ns, samples.back().time_ns);
    }
  }

  void add_training_events(int trial, std::int64_t begin, std::int64_t end) {
    if (trial == session_.reduced_trial) {
      const record::DampingRow row{end, trial, 0.25, 1.0};
      writer_.add(record::Rows(std::span(&row, 1)));
    }
    if (session_.frozen_trial != 0) {
      std::vector<record::FrameRow> frames;
      for (std::int64_t t = begin; t < end; t += 20'000'000) {
        frames.push_back({t, 1'000'000, trial == session_.frozen_trial ? 1 : 0});
      }
      writer_.add_frames(frames);
    }
  }

  // The hand rests far from the path and presses hard: none of it may reach a score.
  void add_rest(std::vector<record::Sample>& samples, Stage stage) {
    for (int k = 0; k < 20; ++k) {
      auto& s = add_tick(samples, stage);
      s.position = {0.5, 0.5, 0.5};
      s.applied_force = 50.0;
    }
  }

  record::Sample& add_tick(std::vector<record::Sample>& samples, Stage stage) {
    record::Sample s;
    s.sequence = next_;
    s.time_ns =
        static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(next_) / session_.rate));
    s.stage = stage;
    s.pass = pass_;
    ++next_;
    return samples.emplace_back(s);
  }

  const SyntheticSession& session_;
  record::SessionWriter writer_;
  std::uint64_t next_{0};
  std::int32_t pass_{0};
};

}  // namespace

double synthetic_path_z(double t) {
  return 0.02 * std::sin(2.1 * t + 0.3) + 0.012 * std::sin(0.9 * t + 1.0) +
         0.006 * std::sin(2.9 * t);
}

void write_session(const std::filesystem::path& file, const SyntheticSession& session) {
  Writer(file, session).write();
}

}  // namespace haptrial::analysis
