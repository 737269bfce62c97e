#include "analysis/quality/tracking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;

// A smooth path of a few sinusoids below 0.5 Hz, as trajectories are.
double path_z(double t) {
  return 0.02 * std::sin(2.1 * t + 0.3) + 0.012 * std::sin(0.9 * t + 1.0) +
         0.006 * std::sin(2.9 * t);
}

Eigen::Vector3d path(double t) { return {0.006 * t, 0.0, path_z(t)}; }

IdealPath ideal_path(double seconds) {
  std::vector<record::StimulusRow> rows;
  for (int i = 0; i * 0.01 <= seconds + 0.005; ++i) {
    rows.push_back({1, i * 0.01, path(i * 0.01), 0.0});
  }
  return IdealPath(rows);
}

struct Recording {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> positions;
};

Recording delayed(double lag, double seconds, double rate) {
  Recording r;
  for (int k = 0; k < static_cast<int>(seconds * rate); ++k) {
    r.times.push_back(k / rate);
    r.positions.push_back(path(r.times.back() - lag));
  }
  return r;
}

TEST(Lag, IsFoundWithinAFractionOfASample) {
  const IdealPath ideal = ideal_path(13.0);
  for (const double lag : {0.0371, 0.0, -0.0123, 0.18, 0.0005}) {
    const Recording r = delayed(lag, 13.0, 1000.0);
    const auto found = track_pass(r.times, r.positions, ideal, 1000.0).lag;
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, lag, 2e-4);
  }
}

TEST(Lag, IsFoundUnderNoise) {
  RandomStream random(5, "tracking noise");
  Recording r = delayed(0.0371, 13.0, 1000.0);
  for (auto& p : r.positions) {
    p.z() += 0.001 * random.normal();
  }
  const auto found = track_pass(r.times, r.positions, ideal_path(13.0), 1000.0).lag;
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 0.0371, 1e-3);
}

TEST(Lag, SaysWhyItIsNotDefined) {
  std::vector<double> rising(1000), flat(1000, 0.1), moving(1000);
  for (std::size_t k = 0; k < rising.size(); ++k) {
    moving[k] = path_z(static_cast<double>(k) / 100.0);
    rising[k] = path_z(static_cast<double>(k) / 100.0 - 0.6);
  }
  EXPECT_THAT(lag_behind(flat, moving, 100.0).because(), HasSubstr("does not vary"));
  EXPECT_THAT(lag_behind(rising, moving, 100.0).because(), HasSubstr("edge"));
  EXPECT_THROW(lag_behind(flat, std::vector<double>(3), 100.0), std::invalid_argument);
  EXPECT_FALSE(lag_behind({}, {}, 100.0));
}

TEST(TrackPass, MeasuresAConstantOffsetExactly) {
  Recording r = delayed(0.0, 5.0, 100.0);
  for (auto& p : r.positions) {
    p += Eigen::Vector3d{0.003, 0.012, 0.004};
  }
  const auto pass = track_pass(r.times, r.positions, ideal_path(5.0), 100.0);
  const auto summary = summarize_tracking("P01", std::vector{pass, pass});
  EXPECT_NEAR(*summary.rms_error, 0.013, 1e-12);           // sqrt(3² + 12² + 4²)
  EXPECT_NEAR(*summary.rms_error_in_plane, 0.005, 1e-12);  // sqrt(3² + 4²)
  EXPECT_EQ(*summary.lag_deviation, 0.0);
  EXPECT_EQ(summary.passes, 2u);
}

TEST(TrackingSummary, WithoutPassesIsNotDefined) {
  const auto summary = summarize_tracking("P01", {});
  EXPECT_FALSE(summary.lag);
  EXPECT_FALSE(summary.rms_error);
}

TEST(IdealPath, IsLinearBetweenRowsAndHeldOutside) {
  const IdealPath ideal({{1, 0.0, {0, 0, 1}, 0.0}, {1, 2.0, {4, 0, 3}, 0.0}});
  EXPECT_EQ(ideal.position(0.5), Eigen::Vector3d(1, 0, 1.5));
  EXPECT_EQ(ideal.position(-1.0), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(ideal.position(9.0), Eigen::Vector3d(4, 0, 3));
  EXPECT_THROW(IdealPath({}), std::invalid_argument);
  EXPECT_THROW(IdealPath({{1, 1.0}, {1, 1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
