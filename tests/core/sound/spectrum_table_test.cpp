#include "core/sound/spectrum_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "tests/core/sound/lines.h"

namespace haptrial::sound {
namespace {

using ::testing::HasSubstr;

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
