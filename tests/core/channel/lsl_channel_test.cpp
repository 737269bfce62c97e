// The kind `lsl` against a stand-in for liblsl whose senders have clocks of their own.

#include "core/channel/channel_kinds.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/channel/channel_set.h"
#include "tests/support/channel_run.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_lsl.h"

namespace haptrial::channel {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

const char* const kLslLibrary = HAPTRIAL_BINARY_DIR "/libstand_in_lsl.so";
constexpr double kLayerAhead = 7000.0;    // of the session's clock [s]
constexpr double kSenderAhead = 91234.0;  // of the layer's clock here, at first [s]
constexpr double kSenderDrift = 100e-6;   // its seconds are longer by this share

/// The sender's clock at a time of the session.
double sender_clock(double session) {
  return kLayerAhead + kSenderAhead + session / (1.0 + kSenderDrift);
}

class LslChannelTest : public testing::Test {
 protected:
  LslChannelTest() : library_(dlopen(kLslLibrary, RTLD_NOW)) {
    network_ = reinterpret_cast<test::LslNetwork* (*)()>(dlsym(library_, "stand_in_lsl_network"))();
    record_ = reinterpret_cast<test::LslRecord* (*)()>(dlsym(library_, "stand_in_lsl"))();
    *record_ = {};
    network_->offers.clear();
    network_->looked_for = 0.0;
    network_->has_clock = true;
    set_time(0.0);
  }
  ~LslChannelTest() override {
    run_.reset();
    EXPECT_EQ(record_->infos, 0) << "descriptions must be destroyed";
    for (const auto& offer : network_->offers) {
      EXPECT_EQ(offer->inlets, 0) << offer->name;
    }
    network_->offers.clear();
    network_->has_clock = false;
    dlclose(library_);
  }

  static std::string definition(const std::string& keys) {
    return fmt::format("[channels.eeg]\nkind = \"lsl\"\nlibrary = \"{}\"\n{}\n", kLslLibrary, keys);
  }
  std::shared_ptr<test::LslOffer> offer(const test::LslOffer& offered) {
    const std::lock_guard lock(network_->mutex);
    network_->offers.push_back(std::make_shared<test::LslOffer>(offered));
    return network_->offers.back();
  }
  /// A stream of two quantities whose sender the layer has just asked for its time.
  std::shared_ptr<test::LslOffer> offer_grip() {
    const auto grip = offer(
        {"Grip", "Force", "g-1", "lab-2", 2, 1, 250.0, {{"thumb", "N"}, {"index finger", "N"}}});
    measure(grip);
    return grip;
  }
  test::ChannelRun& run(const std::string& keys) {
    run_ = std::make_unique<test::ChannelRun>(definition(keys));
    return *run_;
  }
  /// Sets the session's clock and the layer's.
  void set_time(double session) {
    network_->clock = kLayerAhead + session;
    if (run_ != nullptr) {
      run_->set_now(session);
    }
  }
  double time() const { return network_->clock - kLayerAhead; }
  /// The layer measures the offset. @param wrong  by so much, within the uncertainty [s]
  void measure(const std::shared_ptr<test::LslOffer>& from, double wrong = 0.0,
               double uncertainty = 0.5e-3) {
    const std::lock_guard lock(network_->mutex);
    from->measured_at = sender_clock(time());
    from->offset = kLayerAhead + time() - from->measured_at + wrong;
    from->uncertainty = uncertainty;
  }
  /// Measures at a later time of the session, at which the channel looks for a new offset.
  void measure_at(double session, const std::shared_ptr<test::LslOffer>& from, double wrong = 0.0) {
    network_->clock = kLayerAhead + session;
    measure(from, wrong);
    run_->set_now(session);
  }
  void send(const std::shared_ptr<test::LslOffer>& from,
            std::vector<test::LslOffer::Sent> samples) {
    {
      const std::lock_guard lock(network_->mutex);
      from->sent.insert(from->sent.end(), samples.begin(), samples.end());
    }
    network_->came.notify_all();
  }
  void leave(const std::shared_ptr<test::LslOffer>& from) {
    {
      const std::lock_guard lock(network_->mutex);
      from->gone = true;
    }
    network_->came.notify_all();
  }

  void* library_;
  test::LslNetwork* network_;
  test::LslRecord* record_;
  std::unique_ptr<test::ChannelRun> run_;
};

TEST_F(LslChannelTest, SamplesHaveTheTimeOfTheirStampsWhateverTheWayDoes) {
  const auto grip = offer_grip();
  test::ChannelRun& channel =
      run("name = \"Grip\"\nquantities = { thumb = \"N\", finger = \"N\" }\nlatency = 0.02\n"
          "latency_uncertainty = 0.0002");
  ASSERT_EQ(channel.channel().wait_until_open(), "");
  RandomStream random(11, "senders");
  std::vector<double> truth;
  double measured = 0.0;
  std::size_t offsets = 1;
  for (int pack = 0; pack < 1200; ++pack) {  // 24 s, five samples at a time
    const double came = 1.0 + 0.02 * pack + 0.05 * random.uniform();
    std::vector<test::LslOffer::Sent> samples;
    for (int i = 0; i < 5; ++i) {
      const double stamped = 1.0 + 0.02 * pack - 0.004 * (5 - i);
      truth.push_back(stamped - 0.02);
      samples.push_back({sender_clock(stamped), {stamped, -stamped}, {}});
    }
    set_time(std::max(came, time()));
    if (time() - measured > 5.0) {
      measured = time();
      measure(grip, 0.5e-3 * (2.0 * random.uniform() - 1.0));
      ++offsets;
    }
    send(grip, samples);
    channel.rows(truth.size());
  }
  const auto& rows = channel.rows(truth.size());
  double mean = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].values[0], truth[i] + 0.02);
    ASSERT_EQ(rows[i].values[1], -rows[i].values[0]);
    ASSERT_EQ(rows[i].device_time, sender_clock(truth[i] + 0.02)) << "the raw stamp";
    mean += rows[i].uncertainty / static_cast<double>(rows.size());
  }
  EXPECT_GT(test::share_within(rows, truth), 0.95);
  EXPECT_LT(mean, 2e-3);
  EXPECT_THAT(channel.of_kind(Incident::kClockStep), SizeIs(0));
  const auto kept = channel.incidents(Incident::kClockOffset, offsets);
  EXPECT_THAT(kept, SizeIs(offsets)) << "each once";
  EXPECT_NEAR(kept.back().amount, measured - sender_clock(measured), 0.5e-3 + 1e-9);
  EXPECT_THAT(kept.back().text, HasSubstr("within 0.000500 s; the layer measured -91233.99"));
}

TEST_F(LslChannelTest, AnOffsetThatJumpsIsAStepOfTheClock) {
  const auto grip = offer_grip();
  test::ChannelRun& channel = run("type = \"Force\"\nquantities = { a = \"N\", b = \"N\" }");
  set_time(1.0);
  send(grip, {{sender_clock(1.0), {1.0, 2.0}, {}}});
  channel.rows(1);
  measure_at(2.5, grip, -0.25);  // its clock goes 0.25 s further ahead
  test::wait_until([&] { return channel.of_kind(Incident::kClockStep).size() == 1; });
  EXPECT_NEAR(channel.of_kind(Incident::kClockStep)[0].amount, 0.25, 1e-3);
  send(grip, {{sender_clock(2.5) + 0.25, {1.0, 2.0}, {}}});
  EXPECT_NEAR(1e-9 * static_cast<double>(channel.rows(2)[1].time_ns), 2.5, 1e-6);
}

TEST_F(LslChannelTest, AStreamThatIsGoneIsFoundAgainWithItsNewClock) {
  const auto grip = offer_grip();
  test::ChannelRun& channel = run("source_id = \"g-1\"\nquantities = { a = \"N\", b = \"N\" }");
  set_time(1.0);
  send(grip, {{sender_clock(1.0), {1.0, 2.0}, {}}});
  channel.rows(1);
  leave(grip);
  EXPECT_THAT(channel.incidents(Incident::kLost, 1)[0].text,
              HasSubstr("the stream with source_id='g-1' is gone"));
  set_time(3.0);
  const auto again = offer_grip();
  {
    const std::lock_guard lock(network_->mutex);
    again->measured_at = 5.0;  // the computer began anew
    again->offset = kLayerAhead + 3.0 - 5.0;
  }
  send(again, {{5.25, {3.0, 4.0}, {}}});
  const auto& rows = channel.rows(2);
  EXPECT_EQ(rows[1].values[0], 3.0);
  EXPECT_NEAR(1e-9 * static_cast<double>(rows[1].time_ns), 3.25, 1e-6);
  EXPECT_EQ(channel.incidents(Incident::kBack, 1)[0].amount, 2.0);
  EXPECT_THAT(channel.incidents(Incident::kClockOffset, 2), SizeIs(2));
}

TEST_F(LslChannelTest, AStreamThatIsThereIsNotWaitedFor) {
  const auto looked_for = [&] {
    const std::lock_guard lock(network_->mutex);
    return std::exchange(network_->looked_for, 0.0);
  };
  const auto grip = offer_grip();
  test::ChannelRun& channel = run("name = \"Grip\"\nquantities = { a = \"N\", b = \"N\" }");
  ASSERT_EQ(channel.channel().wait_until_open(), "");
  const double second = looked_for();
  EXPECT_GT(second, 0.0) << "another one is looked for";
  EXPECT_LE(second, 0.5);
  offer_grip();
  leave(grip);
  channel.incidents(Incident::kLost, 1);
  {
    const std::lock_guard lock(network_->mutex);
    network_->offers.back()->sent.push_back({sender_clock(1.0), {1.0, 2.0}, {}});
  }
  channel.rows(1);
  EXPECT_EQ(looked_for(), 0.0) << "one that is back";
  run_.reset();
  leave(network_->offers.back());
  EXPECT_NE(run("name = \"Grip\"").channel().wait_until_open(), "");
  EXPECT_EQ(looked_for(), 2.0) << "one that is absent";
}

TEST_F(LslChannelTest, TextsAreMessagesAtTheirOwnTime) {
  const auto markers = offer({"Stimuli", "Markers", "s-1", "lab-3", 2, 3, 0.0});
  measure(markers);
  test::ChannelRun& channel = run("type = \"Markers\"");
  ASSERT_EQ(channel.channel().wait_until_open(), "");
  EXPECT_TRUE(channel.channel().seen().live);
  set_time(5.0);
  const std::string title = std::string(300, 'a') + "\u00e4";
  send(markers, {{sender_clock(4.5), {}, {"go", "7"}}, {sender_clock(4.75), {}, {title, "\xe4"}}});
  const auto said = channel.incidents(Incident::kMessage, 3);
  ASSERT_THAT(said, SizeIs(3)) << "a long text is divided";
  EXPECT_EQ(said[0].text, "go\t7");
  EXPECT_NEAR(1e-9 * static_cast<double>(said[0].time_ns), 4.5, said[0].amount);
  EXPECT_LT(said[0].amount, 2e-3);
  EXPECT_EQ(said[1].text, std::string(256, 'a'));
  EXPECT_EQ(said[2].text, std::string(44, 'a') + "??\t?") << "a file holds UTF-8 only";
  EXPECT_EQ(said[2].time_ns, said[1].time_ns);
  measure_at(12.0, markers);
  channel.incidents(Incident::kClockOffset, 2);
  EXPECT_THAT(channel.of_kind(Incident::kLost), SizeIs(0)) << "silence is no loss";
  const auto set_silent = [&](bool silent) {
    const std::lock_guard lock(network_->mutex);
    markers->silent = silent;
  };
  set_silent(true);
  set_time(30.0);
  EXPECT_THAT(channel.incidents(Incident::kLost, 1)[0].text, HasSubstr("no longer answers"));
  EXPECT_FALSE(channel.channel().seen().live);
  set_time(32.0);
  set_silent(false);
  EXPECT_EQ(channel.incidents(Incident::kBack, 1)[0].amount, 2.0);
  EXPECT_TRUE(channel.channel().seen().live);
}

TEST_F(LslChannelTest, WhatAStreamSaysOfItsQuantitiesIsInTheSentenceToCopy) {
  measure(offer({"Hand",
                 "Force",
                 "",
                 "lab",
                 4,
                 4,
                 100.0,
                 {{"thumb", "N"}, {"thumb", ""}, {"index finger", "microvolts"}}}));
  EXPECT_THAT(run("name = \"Hand\"").channel().wait_until_open(),
              HasSubstr("quantities = { thumb = \"N\", thumb_2 = \"1\", index_finger = "
                        "\"microvolts\", channel_4 = \"1\" }"));
}

TEST_F(LslChannelTest, AStreamOfTextsHasNoSamplesInADryRun) {
  ChannelSet set(test::channels_of(definition("type = \"Markers\"")), {}, false);
  int batches = 0;
  set.collect(2'000'000'000, [&](const record::Rows&) { ++batches; });
  EXPECT_EQ(batches, 0);
}

TEST_F(LslChannelTest, AStreamThatDoesNotFitIsASentence) {
  const auto why = [&](const std::string& keys) {
    run_.reset();
    return run(keys).channel().wait_until_open();
  };
  EXPECT_THAT(why("name = \"Grip\""), HasSubstr("no stream of the Lab Streaming Layer has "
                                                "name='Grip'; start it"));
  offer_grip();
  EXPECT_THAT(why("name = \"Grip\"\nquantities = { a = \"N\" }"),
              HasSubstr("has 2 quantities, and the definition 1; state quantities = { thumb = "
                        "\"N\", index_finger = \"N\" }"));
  EXPECT_THAT(why("name = \"Grip\""), HasSubstr("and the definition 0"));
  EXPECT_THAT(why("name = \"Grip\"\ntype = \"EEG\""), HasSubstr("name='Grip' and type='EEG'"));
  const auto second = offer_grip();
  {
    const std::lock_guard lock(network_->mutex);
    second->host = "lab-9";
  }
  EXPECT_THAT(why("name = \"Grip\""), HasSubstr("'Grip' of lab-2 and 'Grip' of lab-9"));
  measure(offer({"Cap", "EEG", "", "lab", kMostQuantities + 1, 1, 500.0}));
  EXPECT_THAT(why("name = \"Cap\""), HasSubstr("65 channels; allowed: at most 64"));
  measure(offer({"Log", "Markers", "", "lab", 1, 3, 0.0}));
  EXPECT_THAT(why("name = \"Log\"\nquantities = { a = \"1\" }"), HasSubstr("remove `quantities`"));
  offer({"Dumb", "EEG", "", "lab", 1, 1, 500.0});
  EXPECT_THAT(why("name = \"Dumb\"\nquantities = { a = \"1\" }"), HasSubstr("no longer answers"));
}

TEST_F(LslChannelTest, MistakesOfADefinitionAreSentences) {
  const auto problem = [&](const std::string& keys) {
    return test::message_of<InputError>([&] { test::channels_of(definition(keys)); });
  };
  EXPECT_THAT(problem(""), HasSubstr("state name, type or source_id"));
  EXPECT_THAT(problem("name = \"it's\""), HasSubstr("a text without '"));
  auto absent = test::channels_of(
                    "[channels.eeg]\nkind = \"lsl\"\nname = \"Grip\"\n"
                    "library = \"libnowhere_lsl.so\"")
                    .at(0);
  EXPECT_THAT(test::message_of<InputError>([&] { absent.plan.open(); }),
              HasSubstr("libnowhere_lsl.so"));
}

}  // namespace
}  // namespace haptrial::channel
