// Ten hours of hands that do nothing wrong: they rest, tense, let go, tremble (8 to 12 Hz, 0.5 N),
// press with up to 15 N and move, an hour with each feeling. The loop takes none of it for a frozen
// reading, a jitter, an oscillation or energy that nobody meant.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/control/pd_controller.h"
#include "core/control/swing_counter.h"
#include "core/device/virtual_device.h"
#include "core/scene/scene.h"
#include "protocols/interface/device_set.h"
#include "tests/support/hand_on_handle.h"

namespace haptrial::protocols::calm_hands_test {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 1000.0;  // [Hz]
constexpr double kStrong = 18.0;  // limit of every field [N]

scene::Field floor_of(double stiffness, double damping) {
  scene::SurfaceParameters wall;
  wall.shape = scene::HalfSpace{{0.0, -0.005, 0.0}, Vector3d::UnitY()};
  wall.gains = {stiffness, damping};
  return {"floor", wall, kStrong};
}

/// Sensations for an hour.
struct Feeling {
  std::string name;
  std::vector<scene::Field> fields;
  std::uint64_t gives_way{~0u};  // which of them do nothing but that, a bit each
};
void PrintTo(const Feeling& feeling, std::ostream* out) { *out << feeling.name; }

std::vector<Feeling> feelings() {
  const scene::Field floor = floor_of(2000.0, 5.0);
  scene::PlaneParameters plane;
  plane.gains = {2000.0, 300.0};
  scene::FrictionParameters rough;
  rough.static_level = rough.dynamic_level = 5.0;
  rough.stiffness = 5000.0;
  return {{"soft wall", {floor_of(360.0, 0.0)}},
          {"stiff wall", {floor}},
          {"damped wall", {floor_of(1000.0, 100.0)}},
          {"plane of the force study", {{"plane", plane, 12.0}}, 0},
          {"spring",
           {{"spring", scene::SpringParameters{Vector3d::Zero(), {900.0, 20.0}}, kStrong}},
           0},
          {"medium", {floor, {"medium", scene::ViscousParameters{20.0}, kStrong}}},
          {"thick medium", {floor, {"medium", scene::ViscousParameters{100.0}, kStrong}}},
          {"friction", {floor, {"friction", rough, kStrong}}},
          {"mass", {floor, {"mass", scene::InertiaParameters{0.5, 20.0}, kStrong}}, 1},
          {"weight", {floor, {"weight", scene::ConstantParameters{{0.0, -3.0, 0.0}}, kStrong}}, 1}};
}

/// Does one thing after the other, each for up to four seconds.
class Person {
 public:
  Person(std::uint64_t seed, test::HandOnHandle& hand) : random_(seed, "person"), hand_(hand) {}

  /// @returns whether the handle was taken back to the middle, because it had gone away from it.
  bool tick() {
    const bool begins = time_ >= ends_;
    const bool away = begins && hand_.state().position.norm() > 0.02;
    if (begins) {
      begin();
    }
    if (away) {
      hand_.put(Vector3d::Zero());
    }
    time_ += 1.0 / kRate;
    const double grown = std::min(1.0, time_ / rise_);
    const double beat = std::sin(2.0 * std::numbers::pi * beats_ * time_);
    hand_.press = grown * press_ + 3.0 * (beats_ > 0.0 ? beat : 0.0);
    hand_.shake = tremor_ * std::sin(2.0 * std::numbers::pi * tremor_frequency_ * time_);
    return away;
  }

 private:
  void begin() {
    constexpr double kTremor = 0.5 * std::numbers::sqrt2;  // its root mean square is 0.5 N
    time_ = 0.0;
    ends_ = random_.uniform(0.3, 4.0);
    rise_ = random_.uniform(0.05, 1.0);
    const std::uint64_t does = random_.below(5);
    const bool lets_go = does == 0;
    hand_.hold(lets_go ? 0.0 : mass_[random_.below(mass_.size())]);
    press_ = does == 1 || does == 2 ? random_.uniform(0.5, 15.0) : 0.0;
    beats_ = does == 3 ? random_.uniform(0.3, 3.0) : 0.0;
    tremor_frequency_ = random_.uniform(8.0, 12.0);
    const Vector3d way(random_.normal(), random_.normal(), random_.normal());
    tremor_ = !lets_go && random_.below(2) == 0 ? Vector3d(kTremor * way.normalized())
                                                : Vector3d(Vector3d::Zero());
  }

  RandomStream random_;
  test::HandOnHandle& hand_;
  std::vector<double> mass_{0.3, 0.8, 2.0};  // [kg]
  double time_{0.0};
  double ends_{0.0};
  double rise_{1.0};
  double press_{0.0};
  double beats_{0.0};
  double tremor_frequency_{10.0};
  Vector3d tremor_{Vector3d::Zero()};
};

device::EnvelopeLimits limits() {
  device::EnvelopeLimits wide;
  wide.max_force = 20.0;
  wide.workspace_radius = 1000.0;  // a hand that nothing holds back goes where it likes
  wide.max_speed = 1000.0;
  wide.max_jump = 1000.0;
  return wide;
}

/// Feels a scene as a pass of trials does.
PassOutput feel(scene::Scene& scene, const device::DeviceReading& reading,
                std::uint64_t gives_way) {
  PassOutput out;
  out.force = control::saturate(scene.force(reading.tool, reading.shares), limits().max_force);
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const scene::FieldState& state = scene.state(i);
    out.intent.stimulus += state.stimulus;
    out.intent.stored += state.stored;
    out.intent.added += state.added;
    if ((gives_way >> i & 1) == 0) {
      out.intent.push += state.force;
    }
  }
  return out;
}

class CalmHandsTest : public testing::TestWithParam<Feeling> {};

TEST_P(CalmHandsTest, NothingThatAHandDoesIsTakenForAFault) {
  constexpr int kTicks = 3'600'000;
  const Feeling& feeling = GetParam();
  test::HandOnHandle hand(0.8);
  Person person(derived_seed(1, feeling.name), hand);
  device::VirtualDeviceParameters parameters;
  parameters.max_force = 20.0;
  parameters.workspace_radius = 1000.0;
  device::VirtualDevice device(parameters, hand, kRate);
  DeviceSet devices({{&device, limits()}});
  scene::Scene scene(feeling.fields, kRate);
  scene.switch_to(scene::Scene::kAll);
  for (int tick = 0; tick < kTicks; ++tick) {
    if (person.tick()) {
      devices.resume();
    }
    devices.read({}, 1.0 / kRate);
    devices.limit(feel(scene, devices.readings()[0], feeling.gives_way), {}, 1.0 / kRate);
    ASSERT_EQ(devices.fault(), device::Fault::kNone)
        << device::describe(devices.fault()) << ", after " << tick << " ms";
    devices.write();
  }
}

/// Ridges so fine that no hand damps its swing in a groove: their curvature of 31,600 1/m times a
/// press of 3 N is 95 N/mm. Hands that press and rest are calmed, or their pass ends.
TEST(GrooveTest, AHandThatSwingsInAGrooveIsSeen) {
  scene::GratingParameters ridges{"wall"};
  ridges.amplitude = 0.0002;
  ridges.period = 0.0005;
  for (const double mass : {0.05, 0.3, 0.8}) {
    test::HandOnHandle hand(mass);
    hand.press = 3.0;
    device::VirtualDevice device({}, hand, kRate);
    DeviceSet devices({{&device, device::EnvelopeLimits{}}});
    scene::Scene scene({{"wall", floor_of(1000.0, 2.0).kind, 8.0}, {"ridges", ridges, 8.0}}, kRate);
    scene.switch_to(scene::Scene::kAll);
    double longest = 0.0;
    control::SwingCounter swings(2.0, 0.06);
    for (int tick = 0; tick < 3000 && devices.fault() == device::Fault::kNone; ++tick) {
      devices.read({}, 1.0 / kRate);
      devices.limit(feel(scene, devices.readings()[0], ~0u), {}, 1.0 / kRate);
      devices.write();
      const auto train = swings.look(devices.forces()[0], Vector3d::Zero(), 1.0 / kRate);
      longest = std::max(longest, train.lasted);
    }
    const bool ended = devices.fault() != device::Fault::kNone;
    EXPECT_TRUE(ended || longest < 0.3) << mass << " kg swings for " << longest << " s";
  }
}

INSTANTIATE_TEST_SUITE_P(All, CalmHandsTest, testing::ValuesIn(feelings()), [](const auto& one) {
  std::string name = one.param.name;
  std::erase(name, ' ');
  return name;
});

}  // namespace
}  // namespace haptrial::protocols::calm_hands_test
