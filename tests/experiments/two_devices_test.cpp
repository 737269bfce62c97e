// Two devices in one session: what each is given, what is recorded of each, and that a fault of one
// takes the force from both in the same tick.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/device/fault.h"
#include "core/device/registered_devices.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/device_rows.h"
#include "experiments/runner/devices.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/study/roster.h"
#include "protocols/interface/protocol.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::two_devices_test {
namespace {

using Eigen::Vector3d;

constexpr double kRunning = 0.5;  // a pass [s]

/// Trouble of the second device, and when.
struct Trouble {
  int at_tick{std::numeric_limits<int>::max()};
  bool read_fails{false};
  bool write_fails{false};
  Vector3d jump{Vector3d::Zero()};  // [m]
};

/// A device that moves on a circle of its own and notes what it is given.
class CirclingDevice final : public device::Device {
 public:
  CirclingDevice(double radius, const Trouble& trouble) : radius_(radius), trouble_(trouble) {
    info_.simulated = true;
    info_.name = "circling";
    info_.max_force = 20.0;
    info_.workspace_radius = 0.1;
  }
  const device::DeviceInfo& info() const noexcept override { return info_; }
  bool read(device::DeviceReading& reading) noexcept override {
    const bool fails = tick_ == trouble_.at_tick && trouble_.read_fails;
    said_ = fails ? "the cable is out" : "";
    if (fails) {
      ++tick_;
      return false;
    }
    const double angle = 1e-3 * tick_;
    reading.tool.position = radius_ * Vector3d(std::cos(angle), std::sin(angle), 0.0);
    if (tick_ >= trouble_.at_tick) {
      reading.tool.position += trouble_.jump;
    }
    reading.tool.velocity.setZero();
    reading.buttons = radius_ > 0.015 ? 2u : 0u;
    ++tick_;
    return true;
  }
  bool write(const device::Wrench& wrench) noexcept override {
    given.push_back(wrench.force);
    return !(trouble_.write_fails && tick_ > trouble_.at_tick && !wrench.force.isZero(0.0));
  }
  const char* trouble() const noexcept override { return said_; }
  std::vector<Vector3d> given;

 private:
  const char* said_{""};
  double radius_;
  Trouble trouble_;
  device::DeviceInfo info_;
  int tick_{0};
};

struct Pair final : protocols::Rig {
  explicit Pair(const Trouble& trouble, const device::EnvelopeLimits& limits)
      : second_limits(limits), first(0.01, {}), second(0.02, trouble) {
    first.given.reserve(100'000);
    second.given.reserve(100'000);
  }
  device::Device& device() override { return first; }
  std::vector<protocols::DeviceSet::Arm> others() override { return {{&second, second_limits}}; }
  device::EnvelopeLimits second_limits;
  CirclingDevice first;
  CirclingDevice second;
};

/// Pushes the first device along x with 1 N, the second along y with 8 N.
class Push final : public protocols::Pass {
 public:
  Push() { drive_.force = {0.0, 8.0, 0.0}; }
  protocols::PassOutput tick(const protocols::Readings& readings, double dt) noexcept override {
    time_ += dt;
    protocols::PassOutput out;
    out.force = {1.0, 0.0, 0.0};
    out.stage = record::Stage::kRun;
    apart_ = (readings[0].tool.position - readings[1].tool.position).norm();
    return out;
  }
  std::span<const protocols::Drive> others() const noexcept override { return {&drive_, 1}; }
  protocols::PassState state() const noexcept override {
    return time_ < kRunning ? protocols::PassState::kRunning : protocols::PassState::kCompleted;
  }
  double apart() const { return apart_; }

 private:
  protocols::Drive drive_;
  double time_{0.0};
  double apart_{0.0};
};

struct PairDefinition final : protocols::Definition {
  std::vector<protocols::DeviceArm> arms() const override {
    return {{envelope, "finger"}, {envelope, "thumb"}};
  }
  bool has_target() const override { return false; }
  std::vector<std::string> description() const override { return {}; }
  double longest(int trials) const override { return trials * kRunning; }
};

class PairTrials final : public protocols::Trials {
 public:
  PairTrials(std::unique_ptr<Pair>& rig) : rig_(rig) {}
  protocols::Extent extent(int) const override { return {2, 0, 2}; }
  std::optional<protocols::PlannedTrial> next(const protocols::Outcome*) override {
    return ++trial_ <= 2
               ? std::optional(protocols::PlannedTrial{trial_, trial_, 1, "push", 0, false})
               : std::nullopt;
  }
  std::span<const record::Phase> phases() const override {
    static constexpr std::array kPhases{record::Phase("push")};
    return kPhases;
  }
  std::unique_ptr<protocols::Rig> virtual_rig() const override { return std::move(rig_); }
  void prepare(const protocols::PlannedTrial&, protocols::SessionFile&) override {}
  protocols::MakeDrawing drawing() override { return {}; }
  protocols::Pass& make_pass(protocols::PlannedTrial&, const record::Phase&) override {
    pass_ = std::make_unique<Push>();
    return *pass_;
  }
  std::string why_aborted() const override { return "never"; }

 private:
  std::unique_ptr<Pair>& rig_;
  int trial_{0};
  std::unique_ptr<Push> pass_;
};

class PairProtocol final : public protocols::Protocol {
 public:
  std::string_view name() const override { return "pair"; }
  std::unique_ptr<protocols::Definition> read(Table&, std::string_view,
                                              const std::filesystem::path*) const override {
    return nullptr;
  }
  std::vector<std::pair<record::Phase, std::string>> phases() const override {
    return {{record::Phase("push"), "both are pushed"}};
  }
  std::unique_ptr<protocols::Trials> trials(const protocols::Definition&,
                                            const protocols::SessionPlace&) const override {
    return std::make_unique<PairTrials>(rig);
  }
  void replay(const protocols::ReplayRequest&) const override {}
  mutable std::unique_ptr<Pair> rig;
};

class TwoDevicesTest : public testing::Test {
 protected:
  TwoDevicesTest() {
    Table root = Table::load(test::shipped_definition());
    protocols::read_common(root, "pair.toml", definition_);
    definition_.design.trials = 2;
    definition_.design.break_after = 0;
    definition_.recovery = 0.01;
    second_limits_ = definition_.envelope;
  }
  record::SessionReader run(const Trouble& trouble = {}) {
    protocol_.rig = std::make_unique<Pair>(trouble, second_limits_);
    SessionRequest request = test::session_request(protocol_, definition_, folder_ / "S01.h5", 0);
    run_session(request);
    return record::SessionReader(request.file);
  }
  test::TemporaryFolder folder_;
  PairDefinition definition_;
  device::EnvelopeLimits second_limits_;
  PairProtocol protocol_;
};

TEST_F(TwoDevicesTest, EachIsRecorded) {
  const record::SessionReader file = run();
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  const auto samples = file.samples(0, file.sample_count());
  const auto rows = file.rows<record::DeviceRow>();
  ASSERT_EQ(rows.size(), samples.size()) << "a row a tick";
  double first = 0.0;
  double second = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].sequence, samples[i].sequence);
    EXPECT_EQ(rows[i].device, 1);
    EXPECT_NEAR(samples[i].position.norm(), 0.01, 2e-6);
    EXPECT_NEAR(rows[i].position.norm(), 0.02, 2e-6);
    EXPECT_EQ(rows[i].buttons, 2);
    first = std::max(first, samples[i].force.x());
    second = std::max(second, rows[i].force.y());
    EXPECT_EQ(samples[i].force.y(), 0.0);
    EXPECT_EQ(rows[i].force.x(), 0.0);
  }
  EXPECT_NEAR(first, 1.0, 1e-3);
  EXPECT_NEAR(second, 8.0, 1e-3);
}

double steepest(const std::vector<Vector3d>& forces) {
  double most = 0.0;  // [N] in a tick
  for (std::size_t i = 1; i < forces.size(); ++i) {
    most = std::max(most, (forces[i] - forces[i - 1]).norm());
  }
  return most;
}

TEST_F(TwoDevicesTest, EachHasAnEnvelopeOfItsOwn) {
  second_limits_.max_force_rate = 4.0;  // [N/s], and 40 are asked for
  const record::SessionReader file = run();
  std::vector<Vector3d> first;
  for (const record::Sample& sample : file.samples(0, file.sample_count())) {
    first.push_back(sample.force);
  }
  std::vector<Vector3d> second;
  for (const record::DeviceRow& row : file.rows<record::DeviceRow>()) {
    second.push_back(row.force);
  }
  EXPECT_LE(steepest(second), 0.004 + 2.0 * 0x1p-13) << "what its own envelope allows in a tick";
  EXPECT_GT(steepest(first), 0.0045) << "1 N in 0.2 s";
}

/// A force that the first device may have is a fault of one whose limit is lower.
TEST_F(TwoDevicesTest, AForceAboveTheLimitOfOneStopsBoth) {
  second_limits_.max_force = 3.0;  // and 8 N are asked for
  const record::SessionReader file = run();
  for (const record::PassRow& pass : file.passes()) {
    EXPECT_EQ(pass.status, record::PassStatus::kAborted);
  }
  for (const record::Sample& sample : file.samples(0, file.sample_count())) {
    EXPECT_EQ(sample.force.norm(), 0.0);
  }
}

/// A fault of the second device in mid-pass.
void expect_both_stop(const record::SessionReader& file, int at_tick) {
  const auto samples = file.samples(0, file.sample_count());
  const auto rows = file.rows<record::DeviceRow>();
  const auto at = static_cast<std::size_t>(at_tick);
  ASSERT_GT(samples.size(), at);
  EXPECT_GT(samples[at - 1].force.norm(), 0.1);
  EXPECT_GT(rows[at - 1].force.norm(), 0.1);
  EXPECT_EQ(samples[at].force.norm(), 0.0) << "in the same tick";
  EXPECT_EQ(rows[at].force.norm(), 0.0);
  ASSERT_FALSE(file.passes().empty());
  EXPECT_EQ(file.passes().front().status, record::PassStatus::kAborted);
  EXPECT_EQ(file.passes().back().status, record::PassStatus::kCompleted) << "the session goes on";
}

TEST_F(TwoDevicesTest, AFailedReadOfOneStopsBoth) {
  Trouble trouble;
  trouble.at_tick = 300;
  trouble.read_fails = true;
  expect_both_stop(run(trouble), 300);
}

TEST_F(TwoDevicesTest, AJumpOfOneStopsBoth) {
  Trouble trouble;
  trouble.at_tick = 300;
  trouble.jump = {0.02, 0.0, 0.0};
  expect_both_stop(run(trouble), 300);
}

/// Though it is well again on the next tick.
TEST_F(TwoDevicesTest, TheFileSaysWhichDeviceItWasAndWhatItSaid) {
  Trouble trouble;
  trouble.at_tick = 300;
  trouble.read_fails = true;
  const record::SessionReader file = run(trouble);
  std::string aborted;
  for (const record::EventRow& event : file.events()) {
    if (event.kind == "aborted") {
      aborted = event.text;
    }
  }
  EXPECT_THAT(aborted, testing::AllOf(testing::HasSubstr(": thumb: the device did not answer"),
                                      testing::HasSubstr("; the cable is out")));
}

/// The second device refuses its force: the first, which had taken its own, is given zero after it.
TEST_F(TwoDevicesTest, ARefusedForceIsTakenBackFromTheOther) {
  Trouble trouble;
  trouble.at_tick = 300;
  trouble.write_fails = true;
  CirclingDevice first(0.01, {});
  CirclingDevice second(0.02, trouble);
  protocols::DeviceSet set({{&first, definition_.envelope}, {&second, definition_.envelope}});
  protocols::PassOutput wanted;
  wanted.force = {1.0, 0.0, 0.0};
  protocols::Drive other;
  other.force = {0.0, 1.0, 0.0};
  set.engage();
  bool taken = true;
  for (int tick = 0; tick < 400 && taken; ++tick) {
    set.read({}, 1e-3);
    set.limit(wanted, {&other, 1}, 1e-3);
    taken = set.write();
  }
  EXPECT_FALSE(taken);
  EXPECT_EQ(set.fault(), device::Fault::kWriteFailed);
  EXPECT_EQ(set.faulty(), 1u);
  EXPECT_TRUE(first.given.back().isZero(0.0));
  EXPECT_TRUE(second.given.back().isZero(0.0));
  EXPECT_GT(first.given[first.given.size() - 2].norm(), 0.1);
}

/// A study of two devices, of which the first is held.
class TwoDevicesStudyTest : public testing::Test {
 protected:
  TwoDevicesStudyTest() {
    test::write_text(folder_ / "two.toml",
                     "[experiment]\nprotocol = \"trials\"\nname = \"two\"\n"
                     "[design]\nparticipants = 4\n[devices.finger]\nstart = [-0.01, 0.0, 0.0]\n"
                     "[devices.thumb]\nstart = [0.01, 0.0, 0.0]\n"
                     "[[blocks]]\nname = \"one\"\ntrials = 1\n"
                     "[[stages]]\nname = \"wait\"\nuntil = { time = 0.05 }\n");
    experiment_ = load_experiment(folder_ / "two.toml");
  }
  static void SetUpTestSuite() {
    device::register_device(
        {"circling", "goes round by itself",
         [](const std::string&, int, double) -> std::unique_ptr<device::Device> {
           return std::make_unique<CirclingDevice>(0.01, Trouble{});
         }});
  }
  void record(const std::string& subject, std::vector<DeviceChoice> more) const {
    SessionRequest request =
        test::session_request(experiment_, folder_ / "out" / (subject + ".h5"), 1, subject);
    request.participant = subject.back() - '1';
    request.device = {"circling", "", 0};
    request.more_devices = std::move(more);
    std::filesystem::create_directory(folder_ / "out");
    run_session(request);
  }
  std::string next_command() const {
    return make_roster({&experiment_.study->protocol(),
                        experiment_.definition.get(),
                        "two.toml",
                        folder_ / "out",
                        {}})
        .next.front()
        .command;
  }

  test::TemporaryFolder folder_;
  Experiment experiment_;
};

TEST_F(TwoDevicesStudyTest, TheNextSessionHasTheDevicesOfTheOneBefore) {
  record("P01", {{"virtual", "", 0}});
  EXPECT_THAT(next_command(), testing::HasSubstr(" --device circling --device virtual --out "));
}

TEST_F(TwoDevicesStudyTest, ADeviceWithoutAChoiceIsLikeTheOneBefore) {
  record("P01", {});
  EXPECT_THAT(next_command(), testing::HasSubstr(" --device circling --device circling --out "));
}

TEST_F(TwoDevicesStudyTest, ACertificateIsThatOfTheDevice) {
  const auto refusal = [&](const char* name, bool simulated) {
    test::write_text(folder_ / "arm.json",
                     fmt::format(R"({{"certificate": 1, "device": "{}", "simulated": {}, )"
                                 R"("summary": {{"findings": {{}}}}}})",
                                 name, simulated));
    test::write_text(folder_ / "certified.toml",
                     file_text(folder_ / "two.toml") + "[device]\ncertificate = \"arm.json\"\n");
    const Experiment certified = load_experiment(folder_ / "certified.toml");
    const std::vector<DeviceChoice> choices{{"circling", "", 0}, {"circling", "", 0}};
    return test::message_of<InputError>([&] { make_rig(choices, *certified.definition, nullptr); });
  };
  EXPECT_THAT(refusal("virtual", true),
              testing::HasSubstr("arm.json is the certificate of virtual (simulated), and the "
                                 "session's device is circling"));
  EXPECT_THAT(refusal("circling", false), testing::HasSubstr("is the certificate of circling"));
  EXPECT_EQ(refusal("circling", true), "nothing was thrown");
}

TEST_F(TwoDevicesStudyTest, ThePointerMovesTheFirstDeviceAlone) {
  for (const std::vector<DeviceChoice>& choices :
       {std::vector<DeviceChoice>{{"mouse", "", 0}},
        std::vector<DeviceChoice>{{"circling", "", 0}, {"mouse", "", 0}},
        std::vector<DeviceChoice>{{"mouse", "", 0}, {"gamepad", "", 0}}}) {
    EXPECT_THAT(
        test::message_of<InputError>([&] { make_rig(choices, *experiment_.definition, nullptr); }),
        testing::HasSubstr(fmt::format(
            "two.toml: device thumb would be driven by --device {}, which drives the first",
            choices.back().name)));
  }
}

}  // namespace
}  // namespace haptrial::experiments::two_devices_test
