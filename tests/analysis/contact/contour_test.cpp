#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "analysis/contact/evaluation/evaluate_rendering.h"
#include "analysis/contact/evaluation/in_trajectory.h"
#include "analysis/contact/evaluation/registration.h"
#include "analysis/contact/recording/stream_lag.h"
#include "core/contact/renderer_kinds.h"
#include "tests/analysis/contact/contour_data.h"

namespace haptrial::evaluation {
namespace {

class ContourTest : public testing::TestWithParam<char> {};

/// Even samples of a recording fix the pose; the odd ones, which took no part, must lie as close.
TEST_P(ContourTest, ThePathLiesOnTheBody) {
  const auto file = test::contour_file(GetParam());
  const auto mesh = test::contour_body();
  if (!file || !mesh) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds haptic/contour";
  }
  const contact::ContactSurface surface(*mesh);
  const contact::SignedDistance distance(*mesh, surface);
  std::vector<Eigen::Vector3d> fitted, tested;
  const auto path = test::contour_path(test::read_contour(*file).pose, GetParam());
  for (std::size_t i = 0; i < path.size(); ++i) {
    (i % 2 == 0 ? fitted : tested).push_back(path[i]);
  }
  const Registration found = register_path(distance, fitted);
  auto rest = surface_residuals(distance, found.body_from_world, tested, 0.0);
  for (double& r : rest) {
    r = std::abs(r);
  }
  std::sort(rest.begin(), rest.end());
  const double median = rest[rest.size() / 2];
  RecordProperty("fitted_median_um", static_cast<int>(1e6 * found.median));
  RecordProperty("tested_median_um", static_cast<int>(1e6 * median));
  RecordProperty("tested_p95_um", static_cast<int>(1e6 * rest[rest.size() * 95 / 100]));
  EXPECT_LT(median, 0.0005) << "poses are good to half a millimetre";
  EXPECT_FALSE(found.unfixed.empty()) << "a path along one edge leaves movements free";
}

TEST_P(ContourTest, TheLagIsFound) {
  const auto file = test::contour_file(GetParam());
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds haptic/contour";
  }
  const ContactRecording recording = test::read_contour(*file);
  const ForceStream force =
      contact_forces(recording, test::contour_tool(GetParam()).mount, test::contour_load());
  const LagFit fit = estimate_lag(recording.pose, force, {0.2, 0.005, 0.5});
  RecordProperty("lag_us", static_cast<int>(1e6 * fit.lag));
  RecordProperty("half_width_us", static_cast<int>(0.5e6 * (fit.high - fit.low)));
  RecordProperty("doubt", fit.doubt);
  // One clock stamped both streams, so that a lag is that of the sensors alone: less than the 33 ms
  // from pose to pose.
  if (fit.doubt.empty()) {
    EXPECT_LT(std::abs(fit.lag), 0.033);
    EXPECT_LT(fit.low, 0.0);
    EXPECT_GT(fit.high, 0.0);
  }
}

/// The tool rolls on bearings: the friction that is found must be none, within its interval.
TEST_P(ContourTest, ARollingToolHasNoFriction) {
  const auto file = test::contour_file(GetParam());
  auto mesh = test::contour_body();
  if (!file || !mesh) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds haptic/contour";
  }
  const contact::FeltBody body(*std::move(mesh));
  EvaluationOptions options;
  options.renderers = {contact::RendererKind::kPenalty};
  options.prepare = test::contour_options(GetParam());
  const Evaluation e = evaluate_rendering(test::read_contour(*file), body, options);
  ASSERT_TRUE(e.identified && e.identified->dynamic_friction);
  const Interval friction = *e.identified->dynamic_friction;
  RecordProperty("friction_low_1000", static_cast<int>(1e3 * friction.low));
  RecordProperty("friction_high_1000", static_cast<int>(1e3 * friction.high));
  RecordProperty("stiffness_low", static_cast<int>(e.identified->stiffness.low));
  RecordProperty("force_error_mN", static_cast<int>(1e3 * e.renderings[0].force.root_mean_square));
  RecordProperty("mean_force_mN", static_cast<int>(1e3 * e.renderings[0].force.mean_force));
  for (const std::string& remark : e.remarks) {
    RecordProperty("remark", remark);
  }
  EXPECT_TRUE(friction.holds(0.0)) << friction.low << " to " << friction.high;
  EXPECT_LT(friction.high, 0.2) << "an interval that tells it from a sliding tool's";
  EXPECT_GT(e.identified->stiffness.low, 2000.0) << "the body is rigid";
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "";
}

/// Writes results/contact_evaluation/contour.csv where asked: what is found, no data.
TEST(ContourTableTest, IsWrittenWhereAsked) {
  if (std::getenv("HAPTRIAL_WRITE_RESULTS") == nullptr) {
    GTEST_SKIP() << "HAPTRIAL_WRITE_RESULTS=1 writes results/contact_evaluation/contour.csv";
  }
  auto mesh = test::contour_body();
  if (!mesh) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds haptic/contour";
  }
  const contact::FeltBody body(*std::move(mesh));
  EvaluationOptions options;
  options.renderers = {contact::RendererKind::kPenalty, contact::RendererKind::kProxy};
  std::string table =
      "recording,seconds,mean_force_N,distance_median_mm,lag_ms,lag_low_ms,lag_high_ms,"
      "dynamic_friction_low,dynamic_friction_high,stiffness_low_N_per_m,stiffness_high_N_per_m,"
      "renderer,friction,error_N,place_error_mm,not_felt\n";
  for (const char set_up : {'a', 'b', 'c', 'd', 'e', 'f'}) {
    options.prepare = test::contour_options(set_up);
    const Evaluation e =
        evaluate_rendering(test::read_contour(*test::contour_file(set_up)), body, options);
    ASSERT_TRUE(e.identified && e.identified->dynamic_friction && e.contact.registration);
    const bool lag = e.contact.lag && e.contact.lag->doubt.empty();
    const std::string found = lag ? fmt::format("{:.2f},{:.2f},{:.2f}", 1e3 * e.contact.lag->lag,
                                                1e3 * e.contact.lag->low, 1e3 * e.contact.lag->high)
                                  : ",,";
    const Interval friction = *e.identified->dynamic_friction;
    for (const EvaluatedRendering& r : e.renderings) {
      table += fmt::format(
          "{},{:.2f},{:.2f},{:.3f},{},{:.3f},{:.3f},{},{},{},{:.4f},{:.2f},{:.3f},{:.3f}\n", set_up,
          e.contact.time.back() - e.contact.time.front(), r.force.mean_force,
          1e3 * e.contact.registration->median, found, friction.low, friction.high,
          number(e.identified->stiffness.low), number(e.identified->stiffness.high),
          contact::name_of(r.kind), r.friction, r.force.root_mean_square,
          1e3 * r.position.root_mean_square,
          static_cast<double>(r.rendered.lost) /
              (e.contact.contact_share * static_cast<double>(e.contact.touching.size())));
    }
  }
  std::ofstream(HAPTRIAL_SOURCE_DIR "/results/contact_evaluation/contour.csv") << table;
}

INSTANTIATE_TEST_SUITE_P(SetUps, ContourTest, testing::Values('a', 'b', 'c', 'd', 'e', 'f'),
                         [](const auto& set_up) { return std::string(1, set_up.param); });

}  // namespace
}  // namespace haptrial::evaluation
