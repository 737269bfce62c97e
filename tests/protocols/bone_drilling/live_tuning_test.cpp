// Tunable keys of a drilling: which there are, what they reach, and what a change is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <set>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/bone/simulator/simulator.h"
#include "core/device/envelope.h"
#include "protocols/bone_drilling/drilling_pass.h"
#include "protocols/bone_drilling/live_tuning.h"
#include "protocols/bone_drilling/tuning_page.h"
#include "tests/protocols/drilling_fixture.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/pressing_hand.h"
#include "tests/support/solid_bone.h"

namespace haptrial::protocols::live_tuning_test {
namespace {

using testing::HasSubstr;

/// The shipped drilling with a saw, and a tube in the other hand: every tunable key.
std::string everything() {
  std::string text =
      file_text(std::string(HAPTRIAL_SOURCE_DIR) + "/experiments/bone_drilling.toml");
  const std::string tools = "in_hand = [\"cutting\", \"diamond\", \"suction\"]";
  text.replace(text.find(tools), tools.size(),
               "in_hand = [\"cutting\", \"diamond\", \"suction\", \"saw\"]");
  return text + "\n[tools.saw]\ntype = \"saw\"\n[second_hand]\nhandle = [0.0, 0.8, 0.6]\n";
}

BoneDefinition definition(const std::string& text = everything()) {
  return parse_bone_definition(text, "study.toml");
}

/// All of the values as numbers.
std::vector<double> numbers(const TunedValues& v) {
  std::vector<double> all{v.vibration_gain, v.thin_bone.threshold, v.thin_bone.rise};
  const auto add = [&](const bone::FeelParameters& f) {
    all.insert(all.end(),
               {f.first_gain, f.second_gain, f.threshold, f.force_limit, f.least_agreement});
  };
  add(v.simulator.tube);
  for (const bone::BurrTuning& burr : v.simulator.burrs) {
    add(burr.feel);
    all.insert(all.end(), {burr.removal_rate, burr.falloff, burr.tangential_gain});
  }
  return all;
}

TEST(LiveTuningTest, EveryTunableKeyReachesExactlyOneNumberOfTheTick) {
  const BoneDefinition d = definition();
  std::set<std::string> keys;
  for (const TunableKey& key : d.tunable) {
    EXPECT_TRUE(keys.insert(key.key).second) << key.key << " is there twice";
    EXPECT_FALSE(key.text.empty()) << key.key;
    const double other = 0.9 * key.value;  // keeps second_gain above first_gain
    const auto before = numbers(tuned_values(d));
    const auto after =
        numbers(tuned_values(definition(tuned_text(d.text, "study.toml", key.key, other))));
    int changed = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (before[i] != after[i]) {
        ++changed;
        EXPECT_EQ(before[i], key.value) << key.key;
        EXPECT_EQ(after[i], other) << key.key << ": the text has the same bits";
      }
    }
    EXPECT_EQ(changed, 1) << key.key;
  }
  EXPECT_THAT(keys,
              testing::IsSupersetOf({"tools.cutting.feel.second_gain", "tools.diamond.falloff",
                                     "tools.saw.removal_rate", "second_hand.feel.force_limit",
                                     "sound.vibration_gain", "sound.thin_rise"}));
  EXPECT_EQ(keys.size(), 2U * 8U + 1U + 5U + 3U);
}

std::string refusal(LiveTuning& tuning, const std::string& key, double value) {
  try {
    tuning.change(key, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(LiveTuningTest, AChangeIsRefusedInTheWordsOfItsKeyAndChangesNothing) {
  LiveTuning tuning(definition());
  EXPECT_THAT(refusal(tuning, "envelope.max_force", 100.0),
              HasSubstr("envelope.max_force cannot be tuned while a pilot runs"));
  EXPECT_THAT(refusal(tuning, "tools.cutting.feel.second_gain", 1.0),
              HasSubstr("tools.cutting.feel.second_gain is 1; allowed: first_gain or more"));
  EXPECT_THAT(refusal(tuning, "sound.vibration_gain", -1.0), HasSubstr("allowed: a number"));
  const LiveTuning::View view = tuning.view();
  EXPECT_EQ(view.changes, 0U);
  EXPECT_EQ(view.text, everything());
  EXPECT_EQ(refusal(tuning, "sound.vibration_gain", 1.0), "") << "it has that value";
  EXPECT_EQ(tuning.view().changes, 0U);
}

TEST(LiveTuningTest, TheTunedTextIsADefinitionWithTheLastValues) {
  LiveTuning tuning(definition());
  tuning.change("tools.cutting.feel.second_gain", 2.5e9);
  tuning.change("tools.cutting.feel.second_gain", 3.0e9);
  tuning.change("sound.thin_rise", 0.7);
  const BoneDefinition saved = definition(tuning.view().text);
  EXPECT_EQ(saved.simulator.tools[0].as<bone::BurrTool>()->feel.second_gain, 3.0e9);
  EXPECT_EQ(saved.thin_bone.rise, 0.7);
  EXPECT_THAT(tuning.view().text, HasSubstr("This file holds every number"));
}

/// A pass takes changes between its ticks, the newest only, and none while a force is on its way.
TEST(LiveTuningTest, APassTakesTheNewestValuesAndTellsTheTick) {
  test::Workshop shop;
  const BoneDefinition d = definition();
  LiveTuning tuning(d);
  shop.new_pass(1000);
  shop.pass->tune_by(tuning);
  const device::DeviceReading away = test::at({0.0, 0.02, 0.0});
  shop.pass->tick(away, 1e-3);
  tuning.change("sound.vibration_gain", 2.0);
  tuning.change("sound.vibration_gain", 3.0);
  {
    const test::AllocationGuard guard;
    shop.pass->tick(away, 1e-3);
    EXPECT_EQ(guard.count(), 0U);
  }
  tuning.change("sound.thin_rise", 0.5);
  for (int tick = 0; tick < 400; ++tick) {
    shop.pass->tick(away, 1e-3);
  }
  std::vector<TakenTuning> taken;
  shop.logs.tunings.flush([&](auto rows) { taken.insert(taken.end(), rows.begin(), rows.end()); });
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].sequence, 1001U);
  EXPECT_NEAR(static_cast<double>(taken[1].sequence), 1001.0 + 250.0, 2.0);
  EXPECT_EQ(tuning.view().taken, 3U);
  EXPECT_EQ(tuning.thin_bone().rise, 0.5);
  const auto rows = tuning.rows_of(taken);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].key, "sound.vibration_gain");
  EXPECT_EQ(rows[1].before, 2.0);
  EXPECT_EQ(rows[1].after, 3.0);
  EXPECT_EQ(rows[1].sequence, 1001U);
  EXPECT_EQ(rows[2].sequence, taken[1].sequence);
}

TEST(TuningPageTest, TellsKeysOnceAndRefusesWhatIsNoChange) {
  TuningPage page(definition());
  EXPECT_TRUE(page.is_for_pilots());
  const AuxiliaryPage::Events events = page.events();
  const auto first = nlohmann::json::parse(events());
  EXPECT_EQ(first["keys"].size(), 25U);
  EXPECT_EQ(first["file"], "study.toml");
  EXPECT_FALSE(nlohmann::json::parse(events()).contains("keys"));
  page.ask(R"({"key": "sound.thin_rise", "value": 0.5})");
  const auto changed = nlohmann::json::parse(events());
  EXPECT_EQ(changed["changes"], 1);
  EXPECT_EQ(changed["taken"], 0);
  EXPECT_EQ(changed["keys"].back()["first"], 0.3);
  EXPECT_EQ(changed["keys"].back()["value"], 0.5);
  for (const char* body : {"", "[]", R"({"key": 1, "value": 2})", R"({"key": "sound.thin_rise"})",
                           R"({"key": "sound.thin_rise", "value": "high"})"}) {
    EXPECT_THROW(page.ask(body), InputError) << body;
  }
}

}  // namespace
}  // namespace haptrial::protocols::live_tuning_test

namespace haptrial::protocols::tuned_press_test {
namespace {

// A hand presses a burr on bone through the envelope while the feel of the bone is tuned.

using Eigen::Vector3d;
using test::PressingHand;
constexpr double kDt = 1e-3;
constexpr double kRadius = 2e-3;

/// @param stiffer  gains over the default ones
bone::SimulatorParameters with_gains(double stiffer) {
  bone::BurrTool tool;
  tool.burr = bone::default_burr(bone::BurrKind::kCutting, 2.0 * kRadius);
  tool.feel = bone::default_feel(kRadius);
  tool.feel.first_gain *= stiffer;
  tool.feel.second_gain *= stiffer;
  bone::SimulatorParameters p;
  p.tools = {{"burr", 2.5e-3, 0.1, tool}};
  return p;
}

/// The contact of a burr at rest that stands upright.
Vector3d force_at(bone::Simulator& simulator, const Vector3d& tip) {
  bone::SimulatorInput input;
  input.tool.tip.position = tip;
  input.dt = kDt;
  return simulator.tick(input).force;
}

/// A hand that presses while its bone becomes another, through the envelope as a session has it.
struct Pressed {
  double greatest_step{0.0};  // of the force between two ticks, once the hand is at rest [N]
  double force{0.0};          // at the end [N]
  device::Fault fault{device::Fault::kNone};
};
Pressed press_through_a_change(double newtons, double stiffer) {
  bone::Simulator simulator(test::flat_bone(48, 0.5e-3), with_gains(1.0));
  simulator.begin(0);
  force_at(simulator, {0.0, 0.0, 3.0 * kRadius});  // it has been free
  device::EnvelopeLimits limits;
  limits.ramp_in = 0.05;
  device::Envelope envelope(limits);
  PressingHand hand({0.0, 0.0, kRadius}, {.press = newtons});
  Vector3d force = Vector3d::Zero();
  Pressed out;
  for (int tick = 0; tick < 6000; ++tick) {
    if (tick == 3000) {
      simulator.tune(bone::tuning_of(with_gains(stiffer)));
    }
    device::DeviceReading reading;
    reading.tool = {hand.position(), hand.velocity()};
    out.fault = envelope.check(true, reading);
    const Vector3d now = envelope.limit(force_at(simulator, hand.position()), kDt);
    out.greatest_step = std::max(out.greatest_step, tick < 2900 ? 0.0 : (now - force).norm());
    force = now;
    hand.step(force, kDt);
  }
  out.force = force.z();
  return out;
}

TEST(TunedPressTest, AChangeUnderAPressingHandStepsNoForce) {
  for (const double newtons : {0.5, 3.0, 8.0}) {
    for (const double stiffer : {0.2, 3.0}) {
      const Pressed pressed = press_through_a_change(newtons, stiffer);
      const double limit = bone::default_feel(kRadius).force_limit;
      // Beside the transition the hand moves, whose force follows it.
      EXPECT_LT(pressed.greatest_step, 2.0 * limit * kDt / bone::ForceTransition::kTime + 0.05)
          << newtons << ' ' << stiffer;
      EXPECT_LT(pressed.greatest_step, device::EnvelopeLimits{}.max_force_rate * kDt);
      EXPECT_NEAR(pressed.force, newtons, 0.15) << "the hand is at rest again";
      EXPECT_EQ(pressed.fault, device::Fault::kNone);
    }
  }
}

}  // namespace
}  // namespace haptrial::protocols::tuned_press_test
