#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/sound/drill_sound.h"
#include "core/sound/spectrum_table.h"
#include "core/sound/wav.h"
#include "tests/core/sound/lines.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::sound {
namespace {

using ::testing::HasSubstr;

TEST(DrillSoundTest, PitchRisesLinearlyWhereBoneIsThin) {
  const ThinBone thin{2e-3, 0.4};
  DrillState drill{Burr::kCutting, 1.0, true, 1.0, 5e-3};
  EXPECT_EQ(pitch(thin, drill), 1.0);
  drill.thickness = 1e-3;
  EXPECT_DOUBLE_EQ(pitch(thin, drill), 1.2);
  drill.thickness = 0.0;
  EXPECT_DOUBLE_EQ(pitch(thin, drill), 1.4);
  drill.contact = false;
  EXPECT_EQ(pitch(thin, drill), 1.0);
}

TEST(DrillSoundTest, IsSilentWhenOffAndKeepsToFullScale) {
  DrillSound sound(default_sound(), {}, 1);
  sound.set({});
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(sound.next(), 0.0F);
  }
  SpectrumTable loud = default_sound();
  for (auto& level : loud.of(Burr::kCutting).free) {
    level.spectrum.noise = 10.0;
  }
  DrillSound shouting(loud, {}, 1);
  shouting.set({Burr::kCutting, 1.0, false, 0.0, 1.0});
  for (int i = 0; i < 10'000; ++i) {
    ASSERT_LE(std::abs(shouting.next()), 1.0F);
  }
}

TEST(DrillVibrationTest, IsAcrossTheDrillAndAsStrongAsTheTableSays) {
  SpectrumTable table;
  table.unit = "N";
  table.of(Burr::kCutting).contact = {{"one", 1.0, false, lines({{100.0, 0.25, 0.0}})}};
  DrillVibration vibration(table, 2.0, 1000.0, 3);
  ToolState tool;
  tool.orientation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  const DrillState drill{Burr::kCutting, 1.0, true, 1.0, 1.0};
  double square = 0.0;
  const test::AllocationGuard guard;
  for (int i = 0; i < 2200; ++i) {
    const Eigen::Vector3d force = vibration.tick(drill, tool);
    ASSERT_NEAR(force.dot(tool.axis()), 0.0, 1e-12);
    square += i < 200 ? 0.0 : force.squaredNorm();  // the line has come up by then
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_NEAR(std::sqrt(square / 2000.0), 0.5 / std::sqrt(2.0), 1e-3);
  tool.orientation.coeffs().setConstant(std::nan(""));
  EXPECT_TRUE(vibration.tick(drill, tool).isZero(0.0));
}

TEST(SoundTrackTest, IsAsLongAsTheStatesAndTheSameEachTime) {
  const test::TemporaryFolder folder;
  std::vector<DrillState> states(700, {Burr::kDiamond, 1.0, true, 1.0, 1e-3});
  const auto bytes = [&](const char* name, std::uint64_t seed) {
    SoundTrack track(folder / name, 1000.0, default_sound(), {}, seed);
    for (const DrillState& state : states) {
      track.add(state);
    }
    track.finish();
    return file_text(folder / name);
  };
  const std::string first = bytes("a.wav", 1);
  EXPECT_EQ(first, bytes("b.wav", 1));
  EXPECT_NE(first, bytes("c.wav", 2));
  EXPECT_EQ(read_recording(folder / "a.wav").samples.size(), 33'600U);
  EXPECT_THROW(bytes("a.wav", 1), InputError);  // is there already
  EXPECT_THROW(SoundTrack(folder / "no" / "d.wav", 1e3, default_sound(), {}, 1), InputError);
  { const SoundTrack unfinished(folder / "e.wav", 1000.0, default_sound(), {}, 1); }
  EXPECT_FALSE(std::filesystem::exists(folder / "e.wav"));
  EXPECT_FALSE(std::filesystem::exists(folder / "e.wav.partial"));
}

TEST(RecordingTest, WhatIsNoSoundGetsASentence) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(read_recording(folder / "absent.wav"), InputError);
  std::ofstream(folder / "text.wav") << "this is no sound";
  EXPECT_THROW(read_recording(folder / "text.wav"), InputError);
  WavWriter empty(folder / "empty.wav", 48'000);
  empty.finish();
  EXPECT_THROW(read_recording(folder / "empty.wav"), InputError);
}

TEST(SoundOutputTest, FeedsACardAtItsRate) {
  const auto start = std::chrono::steady_clock::now();
  SoundOutput output(default_sound(), {}, 1, "null");  // ALSA's card that swallows everything
  const test::AllocationGuard guard;
  output.set({Burr::kCutting, 1.0, true, 1.0, 1.0});
  EXPECT_EQ(guard.count(), 0U);
  test::wait_until([&] { return output.played() > 48'000; });
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  EXPECT_GT(passed.count(), 0.5) << "no more than a card would";
  EXPECT_FALSE(output.lost());
}

TEST(SoundOutputTest, WithoutACardThereIsASentence) {
  try {
    const SoundOutput output(default_sound(), {}, 1, "hw:no-such-card");
    FAIL() << "a card that is not there was opened";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("sound card 'hw:no-such-card'"));
    EXPECT_THAT(error.what(), HasSubstr("WAV"));
  }
}

TEST(SpectrumTableTest, BlendsBetweenForcesAndFallsBack) {
  SpectrumTable table;
  table.of(Burr::kCutting).contact = {
      {"light", 1.0, false, lines({{100.0, 1.0, 2.0}}, 0.1)},
      {"hard", 3.0, false, lines({{80.0, 3.0, 4.0}, {160.0, 1.0, 0.0}}, 0.3)}};
  check(table);
  const Spectrum middle = table.at(Burr::kCutting, true, 1.5);
  EXPECT_DOUBLE_EQ(middle.peaks[0].frequency, 95.0);
  EXPECT_DOUBLE_EQ(middle.peaks[0].amplitude, 1.5);
  EXPECT_DOUBLE_EQ(middle.peaks[1].frequency, 160.0);
  EXPECT_DOUBLE_EQ(middle.peaks[1].amplitude, 0.25);
  EXPECT_DOUBLE_EQ(middle.noise, 0.15);
  EXPECT_DOUBLE_EQ(table.at(Burr::kCutting, true, 0.0).peaks[0].frequency, 100.0);
  EXPECT_DOUBLE_EQ(table.at(Burr::kCutting, true, 99.0).peaks[0].frequency, 80.0);
  EXPECT_DOUBLE_EQ(table.at(Burr::kCutting, false, 99.0).peaks[0].frequency, 100.0);
  EXPECT_DOUBLE_EQ(table.at(Burr::kDiamond, true, 2.0).peaks[0].frequency, 90.0);
  const double nan = std::nan("");
  EXPECT_TRUE(std::isfinite(table.at(Burr::kCutting, true, nan).peaks[0].frequency));
  std::swap(table.of(Burr::kCutting).contact[0], table.of(Burr::kCutting).contact[1]);
  EXPECT_THROW(check(table), std::invalid_argument);
  EXPECT_THROW(check({}), std::invalid_argument);
}

TEST(SpectrumTableTest, AFileGivesBackWhatWasWritten) {
  for (const SpectrumTable& table : {default_sound(), default_vibration()}) {
    check(table);
    const std::string text = to_toml(table);
    EXPECT_EQ(to_toml(parse_spectrum_table(text, "t.toml")), text);
  }
}

TEST(SpectrumTableTest, ABadFileGetsASentence) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      parse_spectrum_table(text, "t.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string head = "source = 's'\nunit = 'N'\n";
  const std::string level =
      "measured = true\nfrequencies = [1]\namplitudes = [1]\nbandwidths = [1]\nnoise = 0\n";
  EXPECT_EQ(message(head + "[cutting.free]\n" + level), "no error");
  EXPECT_THAT(message(head), HasSubstr("without a level"));
  EXPECT_THAT(message(head + "[cutting.light]\n" + level), HasSubstr("force"));
  EXPECT_THAT(message(head + "[cutting.free]\nx = 1\n" + level), HasSubstr("x"));
  EXPECT_THAT(
      message(head + "[cutting.a]\nforce = 1\n" + level + "[cutting.b]\nforce = 1\n" + level),
      HasSubstr("give each level its own"));
  EXPECT_THAT(message(head + "[cutting.free]\nmeasured = true\nfrequencies = [1, 2]\n"
                             "amplitudes = [1]\nbandwidths = [1, 2]\nnoise = 0\n"),
              HasSubstr("as many as frequencies"));
}

}  // namespace
}  // namespace haptrial::sound
