#include "core/channel/sample_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/random.h"

namespace haptrial::channel {
namespace {

/// An instrument whose clock is planted, and a way on which its samples take a random time.
struct PlantedClock {
  double rate{1000.0};     // samples a second by its own clock [Hz]
  double drift{100e-6};    // its seconds are longer by this share
  double latency{0.4e-3};  // that no sample undercuts [s]
  double delay{0.5e-3};    // mean of what comes on top [s]
  double burst{0.0};       // every tenth of a second comes together, this late [s]
  double step{0.0};        // of its clock after half of the time [s]
};

struct Followed {
  double within{0.0};  // share of samples whose planted time is within their uncertainty
  double worst{0.0};   // error of the last quarter [s]
  double mean_uncertainty{0.0};
  int steps{0};
  double step{0.0};  // the last of them [s]
};

Followed follow(const PlantedClock& planted, double seconds, std::uint64_t seed) {
  RandomStream random(seed, "way");
  SampleClock clock({planted.latency, 0.1e-3});
  Followed result;
  const auto count = static_cast<int>(seconds * planted.rate);
  double came_before = 0.0;
  for (int i = 0; i < count; ++i) {
    const double truth = 3.0 + i / planted.rate * (1.0 + planted.drift);
    const double device = 1000.0 + i / planted.rate + (2 * i > count ? planted.step : 0.0);
    double came = truth + planted.latency - planted.delay * std::log(1.0 - random.uniform());
    if (planted.burst > 0.0 && i / 100 % 10 == 0) {
      came = std::max(came, truth + planted.latency + planted.burst);
    }
    came_before = came = std::max(came, came_before);  // in order
    const SampleTime time = clock.time_of(device, std::llround(1e9 * came));
    const double error = std::abs(1e-9 * static_cast<double>(time.time_ns) - truth);
    result.within += error <= time.uncertainty ? 1.0 / count : 0.0;
    result.mean_uncertainty += time.uncertainty / count;
    result.steps += time.step != 0.0 ? 1 : 0;
    result.step = time.step != 0.0 ? time.step : result.step;
    if (4 * i > 3 * count) {
      result.worst = std::max(result.worst, error);
    }
  }
  return result;
}

TEST(SampleClockTest, PlantedTimesAreWithinTheStatedUncertainty) {
  for (const double rate : {100.0, 250.0, 1000.0, 7000.0}) {
    for (const double drift : {-100e-6, 0.0, 100e-6}) {
      const Followed followed = follow({.rate = rate, .drift = drift}, 60.0, 7);
      EXPECT_GT(followed.within, 0.95) << rate << " Hz, " << drift;
      EXPECT_LT(followed.worst, 1e-3) << rate << " Hz, " << drift;
      EXPECT_LT(followed.mean_uncertainty, 2e-3) << rate << " Hz, " << drift;
      EXPECT_EQ(followed.steps, 0) << rate << " Hz, " << drift;
    }
  }
}

/// From the second point on; how late the first one comes cannot be known.
TEST(SampleClockTest, TheFirstSecondsOfASlowClockStateWhatFewPointsTell) {
  constexpr int kRuns = 500;
  for (const double rate : {2.0, 10.0, 30.0}) {
    for (const double delay : {5e-3, 30e-3}) {
      RandomStream random(11, "way");
      int within = 0;
      int all = 0;
      for (int run = 0; run < kRuns; ++run) {
        SampleClock clock({0.0, 1e-4});
        double came = 0.0;
        for (int i = 0; i < 3.0 * rate; ++i) {
          const double truth = i / rate;
          came = std::max(came, truth - delay * std::log(1.0 - random.uniform()));
          const SampleTime time = clock.time_of(truth, std::llround(1e9 * came));
          const double error = std::abs(1e-9 * static_cast<double>(time.time_ns) - truth);
          if (truth >= 0.5) {
            ++all;
            within += error <= time.uncertainty ? 1 : 0;
          }
        }
      }
      EXPECT_GT(static_cast<double>(within) / all, 0.93) << rate << " Hz, " << delay;
    }
  }
}

TEST(SampleClockTest, BurstsAreNoSteps) {
  const Followed followed = follow({.burst = 0.08}, 60.0, 3);
  EXPECT_GT(followed.within, 0.95);
  EXPECT_EQ(followed.steps, 0);
  EXPECT_LT(followed.worst, 1e-3);
}

TEST(SampleClockTest, AClockThatStepsIsSeenOnceAndFollowedAnew) {
  for (const double step : {-0.5, -0.02, 0.02, 0.5}) {
    const Followed followed = follow({.step = step}, 60.0, 5);
    EXPECT_EQ(followed.steps, 1) << step;
    EXPECT_NEAR(followed.step, step, 2e-3) << "forward is above 0";
    EXPECT_GT(followed.within, 0.95) << step;
    EXPECT_LT(followed.worst, 1e-3) << step;
  }
}

/// A clock that stops for 0.3 s lags from then on; its samples come late as if they were delayed.
TEST(SampleClockTest, BeforeAStepBackIsKnownTheUncertaintyCoversIt) {
  SampleClock clock({0.0, 1e-4});
  for (int i = 0; i < 6000; ++i) {
    const double truth = 1e-3 * i;
    const double device = truth - (i >= 5000 ? 0.3 : 0.0);
    const SampleTime time = clock.time_of(device, std::llround(1e9 * truth));
    EXPECT_LE(std::abs(1e-9 * static_cast<double>(time.time_ns) - truth), time.uncertainty + 1e-9)
        << i;
  }
}

TEST(SampleClockTest, WithoutAClockASampleLiesBetweenTwoReadings) {
  const SampleClock clock({2e-3, 1e-3});
  const SampleTime time = clock.time_of(1'000'000'000, 10e-3);
  EXPECT_EQ(time.time_ns, 993'000'000) << "5 ms of waiting and 2 ms of latency";
  EXPECT_NEAR(time.uncertainty, std::hypot(5e-3, 1e-3), 1e-12);
}

}  // namespace
}  // namespace haptrial::channel
