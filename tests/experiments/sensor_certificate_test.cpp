// A certificate through a force sensor's channel beside that of the built-in sensor: the same arm
// with planted faults, measured by an instrument with a rate, a latency and noise of its own; the
// same for a rotation and a grip, which are arms at the fingers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/device/certificate.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/device/sensed_mount.h"
#include "core/device/virtual_device.h"
#include "experiments/command/sessions/certificate_task.h"
#include "experiments/command/sessions/sensor_channel.h"
#include "tests/experiments/command.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_rdt.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using analysis::CertificatePart;
using analysis::CertificateResult;
using analysis::Interval;
using Eigen::Vector3d;

constexpr double kTicksPerSecond = 1000.0;
constexpr double kNoise = 0.02;      // of both sensors [N]
constexpr double kLatency = 1.6e-3;  // of the instrument's samples [s]
constexpr double kFingers = 0.03;    // of a rotation [m]

/// The quantities of an instrument on a part: forces, all six axes, or the grip alone.
std::vector<channel::Quantity> quantities_on(device::Part part) {
  if (part == device::Part::kGrip) {
    return {{"grip", "N"}};
  }
  std::vector<channel::Quantity> quantities{{"fx", "N"}, {"fy", "N"}, {"fz", "N"}};
  if (part == device::Part::kRotation) {
    for (const char* name : {"tx", "ty", "tz"}) {
      quantities.push_back({name, "N·m"});
    }
  }
  return quantities;
}

/// The force at the fingers in these quantities.
std::vector<double> values_on(device::Part part, const Vector3d& force) {
  if (part == device::Part::kGrip) {
    return {force.x()};
  }
  if (part == device::Part::kRotation) {
    const Vector3d torque = kFingers * force;
    return {0.0, 0.0, 0.0, torque.x(), torque.y(), torque.z()};
  }
  return {force.x(), force.y(), force.z()};
}

/// Samples on their way to the channel that reads them.
class Wire {
 public:
  struct Sample {
    double time{0.0};  // when it was measured [s]
    Vector3d force{Vector3d::Zero()};
  };
  void send(std::vector<Sample> samples) {
    {
      const std::lock_guard lock(mutex_);
      samples_.insert(samples_.end(), samples.begin(), samples.end());
    }
    came_.notify_all();
  }
  std::vector<Sample> take(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, patience, [this] { return !samples_.empty(); });
    return std::exchange(samples_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Sample> samples_;
};

class WireSource final : public channel::ChannelSource {
 public:
  WireSource(Wire& wire, device::Part part) : wire_(wire), part_(part) {}
  void read(channel::ChannelInbox& into, std::chrono::milliseconds patience) override {
    for (const Wire::Sample& sample : wire_.take(patience)) {
      channel::InstrumentSample measured;
      const std::vector<double> values = values_on(part_, sample.force);
      measured.values = values;
      measured.time = channel::SampleTime{std::llround(1e9 * sample.time), 1e-6};
      into.take(measured);
    }
  }

 private:
  Wire& wire_;
  device::Part part_;
};

/// The mount's force as an instrument measures it, of which the certificate knows the channel
/// alone.
class InstrumentOnMount final : public device::ForceSensor {
 public:
  InstrumentOnMount(device::SensedMount& mount, double rate, device::Part part)
      : mount_(mount),
        period_(1.0 / rate),
        sensor_(
            options(part), "x,y,z", [this] { return now_.load(); }, part, kFingers) {}

  bool read(device::MeasuredForce& measured) noexcept override {
    device::MeasuredForce clean;
    mount_.read(clean);
    std::rotate(forces_.begin(), forces_.begin() + 1, forces_.end());
    forces_.back() = clean.force;
    measure();
    arrive();
    while (sensor_.read(measured) ? measured.time != arrived_ : arrived_ >= 0.0) {
      std::this_thread::yield();
    }
    return arrived_ >= 0.0;
  }

 private:
  channel::ChannelOptions options(device::Part part) {
    channel::ChannelOptions options;
    options.name = "force";
    options.plan.quantities = quantities_on(part);
    options.plan.patience = 1e9;
    options.plan.open = [this, part] { return std::make_unique<WireSource>(wire_, part); };
    return options;
  }
  double tick_time(long ticks_ago) const {
    return static_cast<double>(tick_ - ticks_ago) / kTicksPerSecond;
  }
  /// Measures between the last tick but one and the last one: the cubic through four ticks.
  void measure() {
    ++tick_;
    for (; next_ <= tick_time(1); next_ += period_) {
      const double u = (next_ - tick_time(2)) * kTicksPerSecond;
      Vector3d force = -u * (u - 1.0) * (u - 2.0) / 6.0 * forces_[0] +
                       (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0 * forces_[1] -
                       (u + 1.0) * u * (u - 2.0) / 2.0 * forces_[2] +
                       (u + 1.0) * u * (u - 1.0) / 6.0 * forces_[3];
      for (double& axis : force) {
        axis += kNoise * random_.normal();
      }
      waiting_.push_back({next_, force});
    }
  }
  /// Lets arrive what has had the time to.
  void arrive() {
    std::vector<Wire::Sample> samples;
    while (!waiting_.empty() && waiting_.front().time + kLatency <= tick_time(0)) {
      samples.push_back(waiting_.front());
      waiting_.erase(waiting_.begin());
      arrived_ = 1e-9 * static_cast<double>(std::llround(1e9 * samples.back().time));
    }
    now_ = std::llround(1e9 * tick_time(0));
    wire_.send(std::move(samples));
  }

  device::SensedMount& mount_;
  double period_;
  RandomStream random_{5, "instrument"};
  Wire wire_;
  std::vector<Wire::Sample> waiting_;
  std::array<Vector3d, 4> forces_{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(),
                                  Vector3d::Zero()};  // of the last ticks, without noise
  double next_{0.0};                                  // when it measures next [s]
  double arrived_{-1.0};  // when the newest sample that has come was measured [s]
  long tick_{0};
  std::atomic<std::int64_t> now_{0};
  SensorChannel sensor_;
};

device::VirtualDeviceParameters faulty_arm() {
  device::VirtualDeviceParameters arm;
  arm.force_delay = 4;
  arm.faults.gain = 0.87;
  arm.faults.dead_zone = 0.15;
  arm.faults.resonance = 90.0;
  arm.faults.resonance_damping = 0.12;
  return arm;
}

/// @param instrument_rate  of the channel's samples [Hz]; 0: the built-in sensor
CertificateResult certificate_by(const std::vector<CertificatePart>& parts, double instrument_rate,
                                 device::Part part = device::Part::kTip) {
  const analysis::DrivenAxes axes =
      part == device::Part::kGrip ? analysis::DrivenAxes{0} : analysis::DrivenAxes{0, 1, 2};
  const analysis::Excitation excitation(kTicksPerSecond, 4.8, axes);
  const bool built_in = instrument_rate == 0.0;
  device::SensedMount mount({.noise = built_in ? kNoise : 0.0}, 7);
  device::VirtualDevice device(faulty_arm(), mount, kTicksPerSecond);
  std::unique_ptr<InstrumentOnMount> instrument;
  if (!built_in) {
    instrument = std::make_unique<InstrumentOnMount>(mount, instrument_rate, part);
    device::MeasuredForce first;
    while (!instrument->read(first)) {
    }
  }
  device::ForceSensor* sensor =
      built_in ? static_cast<device::ForceSensor*>(&mount) : instrument.get();
  CertificateTask task(device, sensor, excitation, parts, [&](CertificatePart now, long tick) {
    mount.hold(excitation.position(now, tick + 1, 0.04));
  });
  realtime::ServoLoop loop(realtime::ClockKind::kSimulated, kTicksPerSecond);
  loop.run(task);
  EXPECT_EQ(task.fault(), device::Fault::kNone);
  return identify_device(task.record(), excitation);
}

void expect_equal(const Interval& one, const Interval& other, const std::string& what) {
  const double both = std::hypot(one.high - one.low, other.high - other.low) / 2.0;
  EXPECT_GT(both, 0.0) << what;
  EXPECT_LE(std::abs(one.value - other.value), 1.5 * both)
      << what << ": " << one.value << " and " << other.value;
}

class EveryPartsSensorTest : public testing::TestWithParam<device::Part> {};

TEST_P(EveryPartsSensorTest, AChannelsCertificateEqualsThatOfTheBuiltInSensor) {
  const std::vector<CertificatePart> parts{CertificatePart::kRest, CertificatePart::kGrid,
                                           CertificatePart::kFrequency};
  const CertificateResult built_in = certificate_by(parts, 0.0, GetParam());
  const CertificateResult channel = certificate_by(parts, 7003.0, GetParam());
  ASSERT_TRUE(built_in.statics && channel.statics);
  expect_equal(channel.statics->gain, built_in.statics->gain, "gain");
  expect_equal(channel.statics->dead_zone, built_in.statics->dead_zone, "dead zone");
  ASSERT_EQ(channel.statics->levels.size(), built_in.statics->levels.size());
  for (std::size_t i = 0; i < channel.statics->levels.size(); ++i) {
    expect_equal(channel.statics->levels[i].error, built_in.statics->levels[i].error,
                 "error of the force at " + std::to_string(channel.statics->levels[i].level));
  }
  ASSERT_EQ(channel.response.size(), GetParam() == device::Part::kGrip ? 1u : 3u);
  for (std::size_t axis = 0; axis < channel.response.size(); ++axis) {
    const analysis::AxisResponse& one = channel.response.at(axis);
    const analysis::AxisResponse& other = built_in.response.at(axis);
    expect_equal(one.gain, other.gain, "gain of the response");
    expect_equal(one.delay, other.delay, "delay");
    ASSERT_TRUE(one.resonance && other.resonance);
    expect_equal(*one.resonance, *other.resonance, "resonance");
    expect_equal(*one.damping, *other.damping, "damping");
  }
  ASSERT_TRUE(channel.rest.sensor && built_in.rest.sensor);
  expect_equal(*channel.rest.sensor, *built_in.rest.sensor, "noise");
}

INSTANTIATE_TEST_SUITE_P(SensorCertificateTest, EveryPartsSensorTest,
                         testing::Values(device::Part::kTip, device::Part::kRotation,
                                         device::Part::kGrip),
                         [](const auto& part) { return device::part_word(part.param); });

TEST(SensorCertificateTest, TheNoiseOfASlowSensorIsThatOfItsMeasurements) {
  const CertificateResult found = certificate_by({CertificatePart::kRest}, 307.0);
  ASSERT_TRUE(found.rest.sensor);
  EXPECT_LE(found.rest.sensor->low, kNoise);
  EXPECT_GE(found.rest.sensor->high, kNoise);
}

}  // namespace

// A force sensor's channel as the sensor of a certificate.

namespace {

using testing::HasSubstr;

channel::ChannelOptions sensor_at(int port) {
  Table root = Table::parse(
      fmt::format("[channels.force]\nkind = \"rdt\"\nhost = \"127.0.0.1\"\nport = {}\n"
                  "counts_per_force = 1000.0\ncounts_per_torque = 1000.0\nrate = 1000.0\n",
                  port),
      "lab.toml");
  const std::vector<channel::ChannelOptions> channels = channel::read_channels(root);
  root.finish();
  return channels.front();
}

TEST(SensorChannelTest, AForceIsTurnedToTheWorldAndHasAnAge) {
  test::StandInRdt stand_in;
  SensorChannel sensor(sensor_at(stand_in.port()), "x,-z,y");
  device::MeasuredForce measured;
  std::uint32_t sequence = 2;
  const auto arrives = [&] {
    stand_in.send({sequence++, 0, {1000, 2000, 3000, 0, 0, 0}});
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return sensor.read(measured) && measured.force.x() == 1.0;
  };
  while (!arrives()) {
  }
  // Its y points along -z of the world, its z along y.
  EXPECT_LT((measured.force - Vector3d(1.0, 3.0, -2.0)).norm(), 1e-12);
  EXPECT_GE(measured.age, 0.0);
  EXPECT_LT(measured.age, 10.0);
}

TEST(SensorChannelTest, AxesThatAreNoRotationAreRefused) {
  EXPECT_EQ(rotation_of_axes("x,y,z"), Eigen::Matrix3d::Identity());
  EXPECT_EQ(rotation_of_axes("-x,-y,z") * Vector3d(1.0, 2.0, 3.0), Vector3d(-1.0, -2.0, 3.0));
  for (const char* wrong : {"", "x,y", "x,y,-z", "x,x,y", "x,y,w", "x,y,z,x"}) {
    EXPECT_THAT(test::message_of([&] { rotation_of_axes(wrong); }), HasSubstr("--sensor-axes is"))
        << wrong;
  }
}

TEST(SensorChannelTest, WhatIsNoForceSensorIsRefused) {
  test::StandInRdt stand_in;
  channel::ChannelOptions options = sensor_at(stand_in.port());
  options.plan.quantities[1].unit = "lbf";
  EXPECT_THAT(
      test::message_of([&] { SensorChannel(options, "x,y,z"); }),
      HasSubstr(
          "channels.force: a force sensor of a tip has the quantities fx, fy and fz in N; fy"));
}

TEST(SensorChannelTest, TheCommandSaysWhichChannelIsMissing) {
  const auto result = test::run_command(
      "haptrial device-test force-dimension --certificate nowhere --sensor force");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--sensor force needs --definition FILE with a table "
                                       "[channels.force]"));
  const auto of_virtual =
      test::run_command("haptrial device-test virtual --certificate nowhere --sensor force");
  EXPECT_EQ(of_virtual.status, 2);
  EXPECT_THAT(of_virtual.errors, HasSubstr("the virtual device has simulated sensors"));
}

}  // namespace
}  // namespace haptrial::experiments
