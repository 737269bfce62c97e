#include "tests/analysis/exchange/small_session.h"

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/record/hdf5/session_writer.h"

namespace haptrial::exchange {
namespace {

constexpr int kApproach = 50;  // ticks before the run and after it
const char* const kConditions[] = {"haptic", "visual", "visuohaptic"};

record::SessionInfo info_of(const SmallSession& s) {
  record::SessionInfo info;
  info.program_version = "0.1.0";
  info.program_commit = "0123abc";
  info.definition = s.definition;
  info.definition_name = "small_study.toml";
  info.subject = s.subject;
  info.session = s.session;
  info.seed = 18446744073709551615u;
  info.device = "virtual";
  info.device_max_force = 12.0;
  info.device_workspace_radius = 0.075;
  info.clock = s.clock;
  info.rate = s.rate;
  info.start_utc = s.start_utc;
  info.simulated = s.simulated;
  info.pilot = s.pilot;
  info.participant = s.person;
  return info;
}

record::TableList tables_of(const SmallSession& session) {
  return session.other_devices > 0 ? record::TableList{&record::table_of<record::DeviceRow>()}
                                   : record::TableList{};
}

class Writer {
 public:
  Writer(const std::filesystem::path& file, const SmallSession& session)
      : session_(session),
        writer_(file, info_of(session), tables_of(session)),
        next_(session.first_tick) {}

  void write() {
    add_ticks_of_no_pass();
    for (int block = 1; block <= session_.practice; ++block) {
      writer_.add_stimulus(std::vector<record::StimulusRow>{{-block, 0.0, {-0.05, 0.0, 0.01}, 1.0},
                                                            {-block, 2.0, {0.05, 0.0, 0.0}, 2.5}});
      add_pass(block, record::Phase::kTraining, true);
      add_pass(block, record::Phase::kTest, true);
    }
    for (int trial = 1; trial <= session_.trials; ++trial) {
      writer_.add_stimulus(std::vector<record::StimulusRow>{{trial, 0.0, {-0.05, 0.0, 0.01}, 1.0},
                                                            {trial, 2.0, {0.05, 0.0, -0.01}, 2.5}});
      add_pass(trial, record::Phase::kTraining);
      add_pass(trial, record::Phase::kTest);
    }
    writer_.add_event({1'500'000'001, "notice", session_.note});
    writer_.set_timing({}, {next_, 0, 0});
    writer_.close();
  }

 private:
  void add_ticks_of_no_pass() {
    std::vector<record::Sample> samples;
    for (int k = 0; k < session_.ticks_of_no_pass; ++k) {
      add_tick(samples, 1, -kApproach);
      samples.back().pass = -1;
      samples.back().stage = record::Stage::kIdle;
    }
    writer_.append(samples);
  }

  void add_pass(int trial, record::Phase phase, bool practice = false) {
    record::PassRow row;
    row.trial = trial;
    row.condition = kConditions[(trial - 1) % 3];
    row.phase = phase;
    row.block = practice ? -trial : trial;
    row.practice = practice;
    row.repetition = 1;
    row.stimulus_seed = 9'007'199'254'740'993u + static_cast<std::uint64_t>(trial);  // above 2^53
    row.first_sample = next_;
    std::vector<record::Sample> samples;
    for (int k = -kApproach; k < kTicksOfPass + kApproach; ++k) {
      add_tick(samples, trial, k);
    }
    row.last_sample = next_ - 1;
    writer_.append(samples);
    add_devices(std::span(samples).first(samples.size() - 1));
    writer_.add_pass(row);
    ++pass_;
  }

  void add_devices(std::span<const record::Sample> samples) {
    std::vector<record::DeviceRow> rows;
    for (const record::Sample& sample : samples) {
      for (int device = 1; device <= session_.other_devices; ++device) {
        rows.push_back(small_device(sample, device));
      }
    }
    if (!rows.empty()) {
      writer_.add(std::span<const record::DeviceRow>(rows));
    }
  }

  void add_tick(std::vector<record::Sample>& samples, int trial, int k) {
    if (session_.gap > 0 && written_ == session_.gap_at) {
      next_ += session_.gap;
    }
    record::Sample s;
    s.sequence = next_;
    s.time_ns = static_cast<std::int64_t>(std::llround(1e9 * double(next_) / session_.rate)) +
                (session_.clock == "real" ? static_cast<std::int64_t>(next_ % 7) * 1000 : 0);
    s.time_ns += session_.late_at > 0 && written_ >= session_.late_at ? session_.late_ns : 0;
    s.pass = pass_;
    s.stage = k < 0 ? record::Stage::kApproach
                    : (k < kTicksOfPass ? record::Stage::kRun : record::Stage::kReturn);
    s.position = {-0.05 + 1e-4 * k, 1e-5 * trial, 0.013 * std::sin(0.01 * k)};
    s.velocity = {0.016, 0.0, -0.3 * std::cos(0.01 * k)};
    s.force = {0.25, 3.0 + 1e-3 * k, -1.0 / 3.0};
    s.target_force = small_target(trial, k);
    s.applied_force = small_applied(trial, k);
    if (session_.odd_values && k == 3) {
      s.applied_force = std::numeric_limits<double>::quiet_NaN();
    }
    s.saturated = k == 7;
    samples.push_back(s);
    ++next_;
    ++written_;
  }

  const SmallSession& session_;
  record::SessionWriter writer_;
  std::uint64_t next_;
  std::uint64_t written_{0};
  std::int32_t pass_{0};
};

}  // namespace

double small_target(int trial, int k) { return 5.0 + 3.0 * std::sin(0.008 * k + trial); }
double small_applied(int trial, int k) { return 4.5 + 2.5 * std::sin(0.0082 * k + trial - 0.2); }

record::DeviceRow small_device(const record::Sample& sample, int device) {
  record::DeviceRow row;
  row.sequence = sample.sequence;
  row.device = device;
  row.position = sample.position + 0.01 * device * Eigen::Vector3d::Ones();
  row.velocity = -sample.velocity;
  row.force = 0.5 * device * sample.force;
  row.buttons = device;
  return row;
}

void write_session(const std::filesystem::path& file, const SmallSession& session) {
  Writer(file, session).write();
}

}  // namespace haptrial::exchange
