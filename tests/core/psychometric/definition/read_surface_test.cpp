// A threshold surface as a definition states it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "core/psychometric/definition/read_tracks.h"
#include "core/psychometric/procedure/threshold_surface.h"
#include "tests/support/message_of.h"

namespace haptrial::psychometric {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kKeys =
    "guess = 0.5\nlapse = 0.04\nstop = { trials = 30 }\n"
    "stimulus.force = [2.0, 1.0, 0.0]\n"
    "stimulus.rate = { from = 10.0, to = 1000.0, count = 3, spacing = \"log\" }\n";

std::vector<Track> read(const std::string& keys) {
  Table root = Table::parse("[procedure]\nkind = \"surface\"\n" + keys, "surface.toml");
  std::vector<Track> tracks = read_tracks(root);
  root.finish();
  return tracks;
}

TEST(ReadSurfaceTest, ItsKeysAreRead) {
  const std::vector<Track> tracks =
      read(std::string(kKeys) + "rising = [\"rate\"]\npresent = \"$force * $rate < 1500\"\n");
  EXPECT_THAT(tracks.at(0).variables(), ElementsAre("force", "rate"));
  EXPECT_EQ(tracks[0].most_trials, 30);
  const auto begun = tracks[0].begin(1, "track 1");
  const auto& p = dynamic_cast<const ThresholdSurface&>(*begun).parameters();
  EXPECT_THAT(p.variables[0].levels, ElementsAre(0.0, 1.0, 2.0)) << "in order";
  EXPECT_NEAR(p.variables[1].levels[1], 100.0, 1e-9);
  EXPECT_TRUE(p.variables[1].rises);
  EXPECT_DOUBLE_EQ(p.target, 0.73) << "halfway from 0.5 to 0.96";
  EXPECT_TRUE(p.allowed({1.0, 1000.0}));
  EXPECT_FALSE(p.allowed({2.0, 1000.0}));
}

TEST(ReadSurfaceTest, MistakesAreNamed) {
  const auto told = [](const std::string& keys) { return test::message_of([&] { read(keys); }); };
  EXPECT_THAT(told("stop = { trials = 30 }\nstimulus.a = [0, 1]\n"), HasSubstr("guess"));
  const std::string keys = kKeys;
  EXPECT_THAT(told(keys + "rising = [\"weight\"]\n"),
              HasSubstr("rising is \"weight\"; allowed: force, rate"));
  EXPECT_THAT(told(keys + "present = \"$weight > 1\"\n"),
              HasSubstr("procedure.present cannot be used as stated: names weight"));
  EXPECT_THAT(told(keys + "target = 0.3\n"), HasSubstr("target must be above guess"));
  EXPECT_THAT(told(keys + "stimulus.mass = [1.0]\n"), HasSubstr("levels of mass"));
  EXPECT_THAT(told(keys + "present = \"$force > 9\"\n"), HasSubstr("allowed must leave"));
}

}  // namespace
}  // namespace haptrial::psychometric
