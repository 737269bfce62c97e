// haptrial spectrum, as it is called from a shell.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sndfile.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/sound/spectrum_table.h"
#include "core/sound/wav.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using ::testing::HasSubstr;

class SpectrumCommandTest : public ::testing::Test {
 protected:
  /// A second of two sines, as a file.
  void record(const char* name, double frequency) {
    std::vector<float> samples(48'000);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double turn = 2.0 * std::numbers::pi * frequency * static_cast<double>(i) / 48'000.0;
      samples[i] = static_cast<float>(0.2 * std::sin(turn) + 0.1 * std::sin(2.0 * turn + 1.0));
    }
    sound::WavWriter wav(folder_ / name, 48'000);
    wav.write(samples);
    wav.finish();
  }
  test::CommandResult run(const std::string& line) {
    return test::run_command("cd '" + folder_.path().string() + "'\n" + line);
  }
  test::TemporaryFolder folder_;
};

TEST_F(SpectrumCommandTest, MakesATableLevelByLevel) {
  record("air.wav", 1140.0);
  record("bone.wav", 1000.0);
  const auto result =
      run("haptrial spectrum air.wav t.toml --level free\n"
          "haptrial spectrum bone.wav t.toml --add --level light --force 0.5 --wav again.wav\n"
          "haptrial spectrum again.wav --picture p.png");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("dominant    1140.0 Hz; fundamental 1140.0 Hz"));
  const auto table = sound::read_spectrum_table(folder_ / "t.toml");
  const auto& kind = table.of(sound::Burr::kCutting);
  ASSERT_EQ(kind.free.size(), 1U);
  ASSERT_EQ(kind.contact.size(), 1U);
  EXPECT_TRUE(kind.contact[0].measured);
  EXPECT_EQ(kind.contact[0].force, 0.5);
  EXPECT_NEAR(kind.contact[0].spectrum.peaks[0].frequency, 1000.0, 1.0);
  EXPECT_NEAR(kind.contact[0].spectrum.peaks[0].amplitude, 0.2, 0.002);
  EXPECT_NEAR(kind.contact[0].spectrum.peaks[1].amplitude, 0.1, 0.001);
  EXPECT_GT(std::filesystem::file_size(folder_ / "p.png"), 1000U);
}

/// Two sines of a sensor, as a table.
std::string sensed(const std::string& quantity, double amplitude, double unit_of_time = 1.0) {
  std::string text = "time," + quantity + "\n";
  for (int i = 0; i < 8192; ++i) {
    const double time = i / 4000.0;
    const double turn = 2.0 * std::numbers::pi * 300.0 * time;
    text += std::to_string(time / unit_of_time) + "," +
            std::to_string(amplitude * (std::sin(turn) + 0.5 * std::sin(2.0 * turn + 1.0))) + "\n";
  }
  return text;
}

/// A sensor of force, and one of acceleration on a handle of known mass: the same vibration.
TEST_F(SpectrumCommandTest, AForceOrAnAccelerationGivesATableInNewtons) {
  record("sensor.wav", 300.0);
  test::write_text(folder_ / "force.csv", sensed("force", 0.4));
  test::write_text(folder_ / "acceleration.csv", sensed("acceleration", 8.0));
  const auto result =
      run("haptrial spectrum force.csv force.toml\n"
          "haptrial spectrum acceleration.csv moved.toml --mass 0.05 --picture p.png\n"
          "haptrial spectrum sensor.wav wav.toml --unit N --full-scale 2\n"
          "haptrial spectrum acceleration.csv");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("amplitudes  N\n"));
  EXPECT_THAT(result.output, HasSubstr("amplitudes  m/s2\n"));
  for (const char* file : {"force.toml", "moved.toml", "wav.toml"}) {
    const auto table = sound::read_spectrum_table(folder_ / file);
    EXPECT_EQ(table.unit, sound::kNewton) << file;
    const sound::Spectrum& found = table.of(sound::Burr::kCutting).contact.at(0).spectrum;
    ASSERT_GE(found.count, 2) << file;
    EXPECT_NEAR(found.peaks[0].frequency, 300.0, 1.0) << file;
    EXPECT_NEAR(found.peaks[0].amplitude, 0.4, 0.004) << file;
    EXPECT_NEAR(found.peaks[1].amplitude, 0.2, 0.002) << file;
  }
}

/// A balanced pair has the mean 0, and a sensor beside an empty channel half of what it felt.
TEST_F(SpectrumCommandTest, ChannelsAreNotMixed) {
  constexpr int kSamples = 48'000;
  SF_INFO info{};
  info.samplerate = kSamples;
  info.channels = 2;
  info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
  std::vector<float> frames;
  for (int i = 0; i < kSamples; ++i) {
    const double turn = 2.0 * std::numbers::pi * 300.0 * i / kSamples;
    frames.push_back(static_cast<float>(0.2 * std::sin(turn)));
    frames.push_back(-2.0F * frames.back());
  }
  SNDFILE* file = sf_open((folder_ / "pair.wav").c_str(), SFM_WRITE, &info);
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(sf_writef_float(file, frames.data(), kSamples), kSamples);
  sf_close(file);
  const std::string sensor = "haptrial spectrum pair.wav --unit N --full-scale 2 ";
  ASSERT_EQ(run(sensor + "first.toml --channel 1\n" + sensor + "second.toml --channel 2").status,
            0);
  for (const auto& [table, amplitude] : {std::pair{"first.toml", 0.4}, {"second.toml", 0.8}}) {
    const auto found = sound::read_spectrum_table(folder_ / table);
    EXPECT_NEAR(found.of(sound::Burr::kCutting).contact.at(0).spectrum.peaks[0].amplitude,
                amplitude, 0.01 * amplitude);
  }
  const std::map<std::string, std::string> refusals{
      {"", "add --channel, 1 to 2, that of the sensor"},
      {"--channel 3", "--channel is 3; allowed: 1 to 2"},
      {"--channel -1", "--channel is -1; allowed: 1 to 2"}};
  for (const auto& [channel, refusal] : refusals) {
    const auto result = run("haptrial spectrum pair.wav " + channel);
    EXPECT_EQ(result.status, 2) << channel;
    EXPECT_THAT(result.errors, HasSubstr("pair.wav: has 2 channels; " + refusal));
  }
}

TEST_F(SpectrumCommandTest, UnitsAreNotMixed) {
  record("air.wav", 1140.0);
  test::write_text(folder_ / "force.csv", sensed("force", 0.4));
  test::write_text(folder_ / "acceleration.csv", sensed("acceleration", 8.0));
  test::write_text(folder_ / "milliseconds.csv", sensed("force", 0.4, 1e-3));
  test::write_text(folder_ / "millinewtons.csv", sensed("force", 400.0));
  test::write_text(folder_ / "none.csv", sensed("force", 0.0));
  test::write_text(folder_ / "neither.csv", "time,volts\n0,1\n");
  test::write_text(folder_ / "one.csv", "time,force\n0,1\n");
  test::write_text(folder_ / "uneven.csv", "time,force\n0,1\n0.001,1\n0.002,1\n0.004,1\n");
  ASSERT_EQ(run("haptrial spectrum force.csv t.toml --level free").status, 0);
  for (const auto& [line, why] :
       {std::pair{"air.wav t.toml --add", "t.toml: has the unit N; allowed: full scale"},
        {"acceleration.csv new.toml", "--mass is 0; allowed: above 0 kg"},
        {"force.csv new.toml --mass 1", "--mass is 1; allowed"},
        {"air.wav --unit N", "--unit is 'N' and --full-scale 0; allowed: neither, or both"},
        {"air.wav --unit g --full-scale 2", "--unit is 'g'; allowed: N, m/s2"},
        {"force.csv --unit N --full-scale 2", "is a table, whose columns say the unit"},
        {"force.csv --wav out.wav", "--wav makes a sound, and force.csv is in N"},
        {"milliseconds.csv", "has 4 rows a second by its column time; allowed: 200 to 1e+06"},
        {"millinewtons.csv", "allowed: at most 100 [N]"},
        {"none.csv none.toml", "has no line above its noise"},
        {"neither.csv", "has the columns time, volts; allowed: time [s] and either force [N]"},
        {"one.csv", "one.csv: has 1 samples; allowed: at least 4096"},
        {"uneven.csv", "uneven.csv:5: time is '0.004'; allowed: about 0.001 s after"}}) {
    const auto result = run(std::string("haptrial spectrum ") + line);
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(why)) << line;
  }
}

TEST_F(SpectrumCommandTest, BadInputGetsASentence) {
  record("air.wav", 1140.0);
  const auto refused = [&](const std::string& line, const std::string& why) {
    const auto result = run(line);
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(why)) << line;
  };
  refused("haptrial spectrum absent.wav", "absent.wav: cannot be read");
  refused("haptrial spectrum air.wav --burr blunt", "--burr is 'blunt'; allowed: diamond, cutting");
  refused("haptrial spectrum air.wav --level 'a b'", "--level is 'a b'");
  refused("haptrial spectrum air.wav --segment 1000", "--segment is 1000");
  refused("haptrial spectrum air.wav --peaks 0", "--peaks is 0");
  refused("haptrial spectrum air.wav --picture p.jpg", "allowed: .png, .svg");
  refused("touch t.toml; haptrial spectrum air.wav t.toml", "t.toml: exists already");
}

}  // namespace
}  // namespace haptrial
