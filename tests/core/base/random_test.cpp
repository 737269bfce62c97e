#include "core/base/random.h"

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace haptrial {
namespace {

/// xoshiro256++ and SplitMix64 written from their published definitions in plain arithmetic, and
/// FNV-1a from its offset basis and prime in decimal.
class Published {
 public:
  Published(std::uint64_t seed, const std::string& name) {
    std::uint64_t hash = 14695981039346656037u;
    for (const unsigned char c : name) {
      hash ^= c;
      hash *= 1099511628211u;
    }
    mix_ = seed;
    mix_ = split_mix() ^ hash;
    derived = split_mix();
    mix_ = derived;
    for (auto& word : s_) {
      word = split_mix();
    }
  }
  std::uint64_t next() {
    const std::uint64_t sum = s_[0] + s_[3];
    const std::uint64_t out = rotate(sum, 23) + s_[0];
    const std::uint64_t s0 = s_[0], s1 = s_[1], s2 = s_[2] ^ s0, s3 = s_[3] ^ s1;
    s_[0] = s0 ^ s3;
    s_[1] = s1 ^ s2;
    s_[2] = s2 ^ (s1 * 131072u);
    s_[3] = rotate(s3, 45);
    return out;
  }
  std::uint64_t derived;

 private:
  static std::uint64_t rotate(std::uint64_t x, int k) {
    for (int i = 0; i < k; ++i) {
      x = 2 * x + x / 9223372036854775808u;  // the top bit comes in below
    }
    return x;
  }
  std::uint64_t split_mix() {
    mix_ += 11400714819323198485u;  // 2^64 / golden ratio
    std::uint64_t z = mix_;
    z = (z ^ (z / (1u << 30))) * 13787848793156543929u;
    z = (z ^ (z / (1u << 27))) * 10723151780598845931u;
    return z ^ (z / (1u << 31));
  }
  std::uint64_t mix_;
  std::uint64_t s_[4];
};

std::vector<double> drawn(int count, const std::function<double()>& draw) {
  std::vector<double> values(count);
  std::generate(values.begin(), values.end(), draw);
  return values;
}

/// P(D >= d) of the Kolmogorov-Smirnov statistic for a large sample.
double ks_probability(std::vector<double> values, const std::function<double(double)>& cdf) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double d = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double p = cdf(values[i]);
    d = std::max({d, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
  }
  double probability = 0.0;
  for (int k = 1; k < 100; ++k) {
    probability += (k % 2 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * n * d * d);
  }
  return probability;
}

double moment(const std::vector<double>& values, int order) {
  double sum = 0.0;
  for (const double v : values) {
    sum += std::pow(v, order);
  }
  return sum / static_cast<double>(values.size());
}

TEST(RandomStreamTest, FollowsThePublishedGenerator) {
  for (const std::uint64_t seed : {0ull, 1ull, 42ull, 0xffffffffffffffffull}) {
    for (const char* name : {"", "a", "trajectory", "block 24", "\xc3\xa9"}) {
      Published published(seed, name);
      RandomStream stream(seed, name);
      EXPECT_EQ(derived_seed(seed, name), published.derived);
      for (int i = 0; i < 1000; ++i) {
        ASSERT_EQ(stream.bits(), published.next()) << seed << " '" << name << "' " << i;
      }
    }
  }
}

TEST(RandomStreamTest, SameSeedAndNameGiveTheSameNumbersInEveryThread) {
  const auto draw = [] {
    RandomStream stream(7, "subject");
    return drawn(1000, [&] { return stream.normal() + stream.uniform(); });
  };
  std::vector<double> other;
  std::thread thread([&] { other = draw(); });
  thread.join();
  EXPECT_EQ(draw(), other);
}

TEST(RandomStreamTest, StreamsOfOtherNamesAndSeedsShareNoNumber) {
  std::set<std::uint64_t> seen;
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (int name = 0; name < 20; ++name) {
      RandomStream stream(seed, "block " + std::to_string(name));
      for (int i = 0; i < 50; ++i, ++count) {
        seen.insert(stream.bits());
      }
    }
  }
  EXPECT_EQ(seen.size(), count);
}

TEST(RandomStreamTest, NeighbouringStreamsAreNotCorrelated) {
  constexpr int kCount = 20000;
  const auto correlation = [](RandomStream a, RandomStream b) {
    double sum = 0.0;
    for (int i = 0; i < kCount; ++i) {
      sum += 12.0 * (a.uniform() - 0.5) * (b.uniform() - 0.5);
    }
    return sum / kCount;
  };
  // The correlation has standard deviation 1/sqrt(n): five of them, over a hundred pairs.
  const double bound = 5.0 / std::sqrt(kCount);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    EXPECT_LT(std::abs(correlation({seed, "a"}, {seed + 1, "a"})), bound) << seed;
    EXPECT_LT(std::abs(correlation({seed, "a"}, {seed, "b"})), bound) << seed;
  }
}

TEST(RandomStreamTest, UniformNumbersAreUniform) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    RandomStream stream(seed, "uniform");
    const auto values = drawn(100000, [&] { return stream.uniform(); });
    EXPECT_GE(*std::min_element(values.begin(), values.end()), 0.0);
    EXPECT_LT(*std::max_element(values.begin(), values.end()), 1.0);
    // Mean 1/2 with variance 1/12n, second moment 1/3 with variance 4/45n: five deviations.
    EXPECT_NEAR(moment(values, 1), 0.5, 5.0 * std::sqrt(1.0 / 12.0 / 1e5));
    EXPECT_NEAR(moment(values, 2), 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / 1e5));
    EXPECT_GT(ks_probability(values, [](double x) { return x; }), 1e-4);
  }
}

TEST(RandomStreamTest, UniformNumbersFillTheirInterval) {
  RandomStream stream(5, "interval");
  const auto values = drawn(10000, [&] { return stream.uniform(-3.0, 5.0); });
  EXPECT_GE(*std::min_element(values.begin(), values.end()), -3.0);
  EXPECT_LT(*std::max_element(values.begin(), values.end()), 5.0);
  EXPECT_GT(ks_probability(values, [](double x) { return (x + 3.0) / 8.0; }), 1e-4);
  EXPECT_EQ(stream.uniform(2.0, 2.0), 2.0);
}

TEST(RandomStreamTest, UniformNumbersStayBelowTheUpperEndWhenRounded) {
  RandomStream stream(5, "narrow");
  const double low = 1.0;
  const double high = std::nextafter(low, 2.0);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(stream.uniform(low, high), low) << "nothing else is in [low, high)";
  }
}

TEST(RandomStreamTest, NormalNumbersAreNormal) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    RandomStream stream(seed, "normal");
    const auto values = drawn(100000, [&] { return stream.normal(); });
    // Moments 0, 1, 0, 3 with variances 1/n, 2/n, 15/n, 96/n: five deviations.
    EXPECT_NEAR(moment(values, 1), 0.0, 5.0 * std::sqrt(1.0 / 1e5));
    EXPECT_NEAR(moment(values, 2), 1.0, 5.0 * std::sqrt(2.0 / 1e5));
    EXPECT_NEAR(moment(values, 3), 0.0, 5.0 * std::sqrt(15.0 / 1e5));
    EXPECT_NEAR(moment(values, 4), 3.0, 5.0 * std::sqrt(96.0 / 1e5));
    EXPECT_GT(ks_probability(values, gsl_cdf_ugaussian_P), 1e-4);
  }
}

TEST(RandomStreamTest, BelowIsUnbiased) {
  RandomStream stream(9, "below");
  for (const std::uint64_t bound : {2u, 3u, 7u, 64u, 100u}) {
    constexpr double kEach = 2000.0;
    std::vector<double> counts(bound, 0.0);
    for (double i = 0.0; i < kEach * static_cast<double>(bound); ++i) {
      const auto value = stream.below(bound);
      ASSERT_LT(value, bound);
      ++counts[value];
    }
    double chi2 = 0.0;
    for (const double count : counts) {
      chi2 += (count - kEach) * (count - kEach) / kEach;
    }
    EXPECT_GT(gsl_cdf_chisq_Q(chi2, static_cast<double>(bound - 1)), 1e-4) << bound;
  }
  EXPECT_EQ(stream.below(1), 0u);
}

TEST(RandomStreamTest, BelowIsUnbiasedWhereTheBoundDoesNotDivideTheRange) {
  // Taking the remainder of 64 bits would fall into the lower third half the time.
  const std::uint64_t bound = std::uint64_t{3} << 62;
  RandomStream stream(9, "wide");
  int low = 0;
  constexpr int kCount = 30000;
  for (int i = 0; i < kCount; ++i) {
    low += stream.below(bound) < bound / 3;
  }
  EXPECT_NEAR(low, kCount / 3.0, 5.0 * std::sqrt(kCount * 2.0 / 9.0));
}

TEST(RandomStreamTest, DrawingDoesNotAllocate) {
  RandomStream stream(1, "allocation");
  const test::AllocationGuard guard;
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i) {
    sum += stream.uniform(0.0, 2.0) + stream.normal() + static_cast<double>(stream.below(10));
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace haptrial
