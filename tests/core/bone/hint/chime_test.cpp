// The chime of a hint: two notes that end, and nothing before it is rung.

#include "core/bone/hint/chime.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace haptrial::hint {
namespace {

constexpr double kCard = 48'000.0;

int crossings(const std::vector<float>& samples, double from, double to) {
  int count = 0;
  const auto end = static_cast<std::size_t>(to * kCard);
  for (auto i = static_cast<std::size_t>(from * kCard) + 1; i < end; ++i) {
    count += samples[i - 1] < 0.0F && samples[i] >= 0.0F ? 1 : 0;
  }
  return count;
}

TEST(ChimeTest, IsAHighNoteAndALowerOneAndThenSilence) {
  Chime chime({}, kCard);
  std::vector<float> silence(1000, 0.0F);
  chime.mix(silence);
  EXPECT_TRUE(std::ranges::all_of(silence, [](float s) { return s == 0.0F; }));
  chime.ring();
  std::vector<float> samples(48'000, 0.0F);
  for (std::size_t at = 0; at < samples.size(); at += 480) {
    chime.mix(std::span(samples).subspan(at, 480));
  }
  EXPECT_NEAR(crossings(samples, 0.01, 0.11), 88, 1) << "880 Hz";
  EXPECT_NEAR(crossings(samples, 0.15, 0.25), 66, 1) << "659 Hz";
  EXPECT_EQ(*std::max_element(samples.begin() + 14'000, samples.end()), 0.0F);
  EXPECT_LE(*std::ranges::max_element(samples), 0.2F);
  chime.ring();
  std::vector<float> again(480, 0.5F);
  chime.mix(again);
  EXPECT_NE(again[200], 0.5F) << "it adds to what is there";
}

}  // namespace
}  // namespace haptrial::hint
