#include "analysis/contact/evaluation/evaluate_rendering.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/contact/demo_study/simulated_probe.h"
#include "analysis/contact/truth/true_contact.h"
#include "core/base/random.h"
#include "core/contact/renderer_kinds.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/support/message_of.h"

namespace haptrial::evaluation {
namespace {

using contact::RendererKind;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kRadius = 0.05, kStiffness = 800.0, kFriction = 0.3;

/// A recording of the exact contact with a sphere: the probe is where the proxy is, in the body's
/// frame.
ContactRecording rubbed_sphere(double friction) {
  std::vector<Vector3d> tool;
  for (int i = 0; i < 6000; ++i) {
    const double t = i * 0.001;
    const double out = kRadius + 0.001 - (0.003 + 0.0008 * std::sin(7.3 * t)) * std::min(1.0, t);
    tool.emplace_back(
        out * Vector3d(0.4 * std::sin(2.1 * t), 1.0, 0.3 * std::sin(1.3 * t + 0.4)).normalized());
  }
  const auto truth = true_contacts(TrueSphere{kRadius}, tool, kStiffness, friction);
  ContactRecording recording;
  for (std::size_t i = 0; i < tool.size(); ++i) {
    recording.pose.time.push_back(0.001 * static_cast<double>(i));
    recording.pose.position.push_back(truth[i].proxy);
    recording.pose.orientation.push_back(Eigen::Quaterniond::Identity());
    recording.force.force.push_back(truth[i].force);
  }
  recording.force.time = recording.pose.time;
  return recording;
}

const contact::FeltBody& sphere() {
  static const contact::FeltBody body(geometry::make_sphere(kRadius, 60));
  return body;
}

EvaluationOptions known_frame() {
  EvaluationOptions options;
  options.prepare.registered = true;
  options.prepare.lag = 0.0;
  options.prepare.stiffness = kStiffness;
  return options;
}

const EvaluatedRendering& rendering(const Evaluation& e, RendererKind kind, bool friction) {
  for (const EvaluatedRendering& r : e.renderings) {
    if (r.kind == kind && (r.friction > 0.0) == friction) {
      return r;
    }
  }
  throw std::invalid_argument("no such rendering");
}

geometry::Mesh flat_ellipsoid() {
  geometry::Mesh mesh = geometry::make_sphere(0.03, 40);
  for (Vector3d& vertex : mesh.vertices) {
    vertex.z() *= 2.0 / 3.0;
  }
  return mesh;
}

/// A probe that goes round the axis of an ellipsoid at an even speed, with a friction of 0.2 and
/// without a lag, after half a second in the air.
ContactRecording round_an_axis(std::uint64_t seed) {
  RandomStream random(seed, "places");
  const auto place = [](double t) {
    const double up = 0.6 + 0.8 * std::pow(std::sin(0.9 * t), 2);
    return Vector3d(0.03 * std::sin(up) * std::cos(2.0 * t),
                    0.03 * std::sin(up) * std::sin(2.0 * t), 0.02 * std::cos(up));
  };
  ContactRecording recording;
  for (int i = 0; i < 3000; ++i) {
    const double t = i / 500.0;
    const bool air = t < 0.5;
    const Vector3d p = place(t);
    const Vector3d normal = Vector3d(p.x() / 9.0, p.y() / 9.0, p.z() / 4.0).normalized();
    const Vector3d way = (place(t + 1e-5) - place(t - 1e-5)).normalized();
    const Vector3d noise(random.normal(), random.normal(), random.normal());
    recording.pose.time.push_back(t);
    recording.pose.position.push_back(p + (air ? 0.015 : 0.0) * normal + 2e-5 * noise);
    recording.pose.orientation.push_back(Eigen::Quaterniond::Identity());
    recording.force.force.push_back((air ? 0.0 : 2.0 + std::sin(3.0 * t)) * (normal - 0.2 * way));
  }
  recording.force.time = recording.pose.time;
  return recording;
}

TEST(EvaluateRenderingTest, ALagThatLooksLikeFrictionWidensItsInterval) {
  const contact::FeltBody body(flat_ellipsoid());
  EvaluationOptions options = known_frame();
  options.renderers = {RendererKind::kPenalty};
  options.prepare.lag.reset();
  constexpr int kSeeds = 5;
  int lags_held = 0, frictions_held = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Evaluation e = evaluate_rendering(round_an_axis(seed), body, options);
    const LagFit& lag = *e.contact.lag;
    const Interval& friction = *e.identified->dynamic_friction;
    EXPECT_EQ(lag.doubt, "");
    EXPECT_NEAR(lag.lag, 0.0, 0.003);
    EXPECT_NEAR(friction.value, 0.2, 0.005);
    lags_held += lag.low <= 0.0 && lag.high >= 0.0 ? 1 : 0;
    frictions_held += friction.holds(0.2) ? 1 : 0;
    EXPECT_THAT(e.identified->confounded,
                testing::Contains(HasSubstr("Dynamic friction looks like a lag on this path")));
  }
  EXPECT_EQ(lags_held, kSeeds);
  EXPECT_EQ(frictions_held, kSeeds);
}

/// A probe that rubs a sphere to and fro, whose force clock is 30 ms late.
ContactRecording rubbed_late(std::uint64_t seed) {
  RandomStream random(seed, "places");
  const auto normal = [](double t) {
    return Vector3d(0.7 * std::sin(2.1 * t), 1.0, 0.6 * std::sin(3.1 * t + 1.0)).normalized();
  };
  ContactRecording recording;
  for (int i = 0; i < 6000; ++i) {
    const double t = i / 500.0;
    const Vector3d n = normal(t);
    const Vector3d way = (normal(t + 1e-4) - normal(t - 1e-4)).normalized();
    if (i % 5 == 0) {
      const Vector3d noise(random.normal(), random.normal(), random.normal());
      recording.pose.time.push_back(t);
      recording.pose.position.push_back(kRadius * n + 1e-4 * noise);
      recording.pose.orientation.push_back(Eigen::Quaterniond::Identity());
    }
    recording.force.time.push_back(t + 0.03);
    recording.force.force.push_back((1.5 + 0.5 * std::sin(5.0 * t)) * (n - 0.25 * way));
  }
  return recording;
}

TEST(EvaluateRenderingTest, TheIntervalOfFrictionHasWhatTheLagLeavesOpen) {
  EvaluationOptions options = known_frame();
  options.renderers = {RendererKind::kPenalty};
  options.prepare.lag.reset();
  constexpr int kSeeds = 8;
  int held = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Evaluation e = evaluate_rendering(rubbed_late(seed), sphere(), options);
    const LagFit& lag = *e.contact.lag;
    const Interval& friction = *e.identified->dynamic_friction;
    EXPECT_EQ(lag.doubt, "");
    held += friction.holds(0.25) ? 1 : 0;
    // The normal turns by 1.3 rad/s in the mean.
    EXPECT_GT(friction.high - friction.low, 1.1 * (lag.high - lag.low));
    EXPECT_LT(friction.high - friction.low, 2.0 * (lag.high - lag.low));
    EXPECT_THAT(e.identified->confounded, testing::Not(testing::Contains(HasSubstr("a lag"))));
  }
  EXPECT_GE(held, kSeeds - 2) << "by the noise alone none of them does";
}

/// Ten poses a second of a slow probe tell a lag, but too few normals.
TEST(EvaluateRenderingTest, AnIntervalOfFrictionWithoutTheLagSaysSo) {
  EvaluationOptions options = known_frame();
  options.renderers = {RendererKind::kPenalty};
  options.prepare.lag.reset();
  const auto has_remark = testing::Contains(HasSubstr("does not allow for an error of the lag"));
  ContactRecording recording = rubbed_late(1);
  EXPECT_THAT(evaluate_rendering(recording, sphere(), options).contact.remarks,
              testing::Not(has_remark));
  PoseStream few;
  for (std::size_t i = 0; i < recording.pose.size(); i += 13) {
    few.time.push_back(recording.pose.time[i]);
    few.position.push_back(recording.pose.position[i]);
    few.orientation.push_back(recording.pose.orientation[i]);
  }
  recording.pose = few;
  const Evaluation e = evaluate_rendering(recording, sphere(), options);
  EXPECT_THAT(e.contact.remarks, has_remark) << e.contact.lag->doubt << recording.pose.size();
}

TEST(EvaluateRenderingTest, OnACircleLagAndFrictionAreNotToldApart) {
  EvaluationOptions options = known_frame();
  options.renderers = {RendererKind::kProxy};
  options.prepare.lag.reset();
  ContactRecording circle = round_an_axis(1);
  RandomStream random(4, "circle");
  for (std::size_t i = 0; i < circle.pose.time.size(); ++i) {
    const double turn = 2.0 * circle.pose.time[i];
    const Vector3d normal(0.8 * std::cos(turn), 0.8 * std::sin(turn), 0.6);
    const Vector3d way(-std::sin(turn), std::cos(turn), 0.0);
    const Vector3d noise(random.normal(), random.normal(), random.normal());
    circle.pose.position[i] = kRadius * normal + 2e-5 * noise;
    circle.force.force[i] = (2.0 + std::sin(3.0 * circle.pose.time[i])) * (normal - 0.2 * way);
  }
  const Evaluation e = evaluate_rendering(circle, sphere(), options);
  EXPECT_TRUE(!e.contact.lag->doubt.empty() ||
              (e.contact.lag->low <= 0.0 && e.contact.lag->high >= 0.0))
      << e.contact.lag->lag;
  EXPECT_TRUE(e.identified->dynamic_friction->holds(0.2)) << e.identified->dynamic_friction->value;
  EXPECT_THAT(e.identified->confounded,
              testing::Contains(HasSubstr("Dynamic friction looks like a lag on this path")));
}

/// All that a frictionless renderer misses is friction: mu F_n on every sample of slip.
TEST(EvaluateRenderingTest, FrictionIsWhatAFrictionlessRenderingMisses) {
  const Evaluation e = evaluate_rendering(rubbed_sphere(kFriction), sphere(), known_frame());
  double squares = 0.0;
  for (std::size_t i = 0; i < e.contact.force.size(); ++i) {
    const double normal = e.contact.force[i].dot(e.contact.normal[i]);
    squares += (e.contact.force[i] - normal * e.contact.normal[i]).squaredNorm();
  }
  const double missed = std::sqrt(squares / static_cast<double>(e.contact.force.size()));
  ASSERT_TRUE(e.friction);
  EXPECT_NEAR(e.friction->friction, kFriction, 0.1 * kFriction) << "less: it lags at turns";
  for (const RendererKind kind : contact::kRendererKinds) {
    const EvaluatedRendering& r = rendering(e, kind, false);
    EXPECT_NEAR(r.force.root_mean_square, missed, 0.02 * missed) << contact::name_of(kind);
    const BandError& b = r.bands;
    EXPECT_NEAR(b.slow * b.slow + b.middle * b.middle + b.fast * b.fast, b.total * b.total,
                1e-9 * b.total * b.total);
  }
  EXPECT_LT(rendering(e, RendererKind::kProxy, true).force.root_mean_square, 0.3 * missed);
  EXPECT_LT(rendering(e, RendererKind::kRuspini, true).force.root_mean_square, 0.3 * missed);
}

TEST(EvaluateRenderingTest, WithoutFrictionTheRenderingIsRight) {
  const Evaluation e = evaluate_rendering(rubbed_sphere(0.0), sphere(), known_frame());
  const EvaluatedRendering& proxy = rendering(e, RendererKind::kProxy, false);
  EXPECT_LT(proxy.force.root_mean_square, 0.02 * proxy.force.mean_force)
      << "facets of 72,000 triangles turn normals by less than a hundredth";
  EXPECT_LT(proxy.position.worst, 1e-4);
  EXPECT_TRUE(proxy.position.places.empty());
  ASSERT_TRUE(e.friction);
  EXPECT_LT(e.friction->friction, 0.01);
  ASSERT_TRUE(e.identified && e.identified->dynamic_friction);
  EXPECT_TRUE(e.identified->dynamic_friction->holds(0.0));
}

/// The other recording's force clock is late; the evaluated one's is not.
TEST(EvaluateRenderingTest, AnotherRecordingIsPreparedAsIfGivenAlone) {
  constexpr double kLate = 0.04;
  ContactRecording late = rubbed_sphere(kFriction);
  for (double& t : late.force.time) {
    t += kLate;
  }
  EvaluationOptions options = known_frame();
  options.renderers = {RendererKind::kProxy};
  EvaluationOptions of_late = options;
  of_late.prepare.lag = kLate;
  Evaluation e = evaluate_rendering(rubbed_sphere(kFriction), sphere(), options);
  const Evaluation alone = evaluate_rendering(late, sphere(), of_late);
  add_cross_fit(e, "first", {{"late", late, of_late.prepare}}, sphere(), options);
  EXPECT_EQ(e.cross->fit.own[1].friction, alone.friction->friction);
  EXPECT_NEAR(e.cross->fit.error[1][1], alone.friction->with, 1e-12);
  EXPECT_NEAR(e.cross->fit.error[0][1], e.cross->fit.error[0][0], 0.01);
  ContactRecording apart = late;
  for (double& t : apart.force.time) {
    t += 1000.0;
  }
  EXPECT_THAT(test::message_of<std::invalid_argument>([&] {
                add_cross_fit(e, "first", {{"apart", apart, of_late.prepare}}, sphere(), options);
              }),
              testing::StartsWith("apart: "));
}

TEST(EvaluateRenderingTest, CostsAreMeasured) {
  EvaluationOptions options = known_frame();
  options.friction = 0.2;
  options.renderers = {RendererKind::kVoxel, RendererKind::kProxy};
  options.resolution = 64;
  const Evaluation coarse = evaluate_rendering(rubbed_sphere(0.0), sphere(), options);
  options.resolution = 128;
  const Evaluation fine = evaluate_rendering(rubbed_sphere(0.0), sphere(), options);
  EXPECT_FALSE(coarse.friction) << "it was given";
  const double memory = rendering(coarse, RendererKind::kVoxel, false).rendered.memory;
  const double more = rendering(fine, RendererKind::kVoxel, false).rendered.memory;
  if (memory > 0.0) {  // sanitizers have a heap of their own
    // Two cells more on every side, a triangle's number of 4 bytes in each.
    EXPECT_NEAR(more - memory, 4.0 * (std::pow(132.0, 3.0) - std::pow(68.0, 3.0)), 0.1 * more);
  }
  const EvaluatedRendering& proxy = rendering(fine, RendererKind::kProxy, true);
  EXPECT_EQ(proxy.friction, 0.2);
  EXPECT_GT(proxy.ticks.median, 0.0);
  EXPECT_LE(proxy.ticks.median, proxy.ticks.p999);
  EXPECT_LE(proxy.ticks.p999, proxy.ticks.worst);
  EXPECT_GT(rendering(fine, RendererKind::kVoxel, false).rendered.preparation,
            proxy.rendered.preparation);
}

/// Everything at once: a probe with a load on its sensor rubs a duck that lies anywhere, with a lag
/// between its clocks, the source's noise, and friction.
TEST(EvaluateRenderingTest, TheWholeChainFindsWhatWasPutIn) {
  const contact::FeltBody body(radial_mesh(duck_radius, 40));
  SimulatedProbe probe;
  probe.lag = 0.04;
  probe.friction = 0.25;
  probe.world_from_body = Eigen::Translation3d(0.3, -0.2, 0.8) *
                          Eigen::AngleAxisd(2.0, Vector3d(1.0, 2.0, -0.5).normalized());
  EvaluationOptions options;
  options.renderers = {RendererKind::kProxy};
  options.prepare.free = {{0.0, probe.free_seconds - 0.5}};
  const Evaluation e = evaluate_rendering(simulate_probe(duck_radius, probe), body, options);
  ASSERT_TRUE(e.contact.load && e.contact.lag && e.contact.registration && e.friction);
  RecordProperty("lag_us", static_cast<int>(1e6 * e.contact.lag_used));
  EXPECT_NEAR(e.contact.lag_used, probe.lag, 0.008);
  EXPECT_LT((e.contact.load->load.weight - probe.load.weight).norm(), 0.02);
  EXPECT_LT(e.contact.registration->median, 2.0 * probe.pose_noise);
  const Eigen::Isometry3d off = e.contact.registration->body_from_world * probe.world_from_body;
  EXPECT_LT(off.translation().norm(), 5e-4);
  EXPECT_NEAR(e.friction->friction, probe.friction, 0.05);
  EXPECT_LT(e.friction->with, 0.5 * e.friction->without);
  ASSERT_TRUE(e.identified && e.identified->dynamic_friction);
  EXPECT_NEAR(e.identified->dynamic_friction->value, probe.friction, 0.01)
      << "the interval is that of the noise; the registration is off by more";
  EXPECT_TRUE(std::isinf(e.identified->stiffness.high)) << "the body is rigid";
  EXPECT_EQ(e.renderings[0].rendered.operations.ticks, e.contact.in.size());
}

TEST(EvaluateRenderingTest, ForcesOnTheBodyAreDoubted) {
  ContactRecording recording = rubbed_sphere(0.0);
  for (Vector3d& f : recording.force.force) {
    f = -f;
  }
  EvaluationOptions options = known_frame();
  options.renderers = {RendererKind::kPenalty};
  EXPECT_THAT(test::message_of<std::invalid_argument>(
                  [&] { evaluate_rendering(recording, sphere(), options); }),
              HasSubstr("do the forces act on the body (--on-body)"));
  ContactRecording mixed = rubbed_sphere(0.0);
  std::copy_n(recording.force.force.begin(), 3000, mixed.force.force.begin());
  EXPECT_THAT(evaluate_rendering(mixed, sphere(), options).remarks,
              testing::Contains(HasSubstr("pull into the body")));
  options.prepare.force_on_body = true;
  const Evaluation turned = evaluate_rendering(recording, sphere(), options);
  EXPECT_LT(turned.renderings[0].force.root_mean_square,
            0.02 * turned.renderings[0].force.mean_force);
}

/// A plate of 200 x 20 x 200 mm whose file says m: the path lies in its middle, 10 m below a face.
TEST(EvaluateRenderingTest, AMeshInAnotherUnitRoundThePathIsRefused) {
  const contact::FeltBody plate(geometry::make_box({200.0, 20.0, 200.0}));
  EXPECT_THAT(test::message_of<std::invalid_argument>(
                  [&] { evaluate_rendering(rubbed_sphere(0.0), plate, known_frame()); }),
              HasSubstr("--units must be the unit of the mesh"));
}

TEST(EvaluateRenderingTest, RefusesBadOptions) {
  EvaluationOptions options = known_frame();
  options.renderers.clear();
  EXPECT_THROW(evaluate_rendering(rubbed_sphere(0.0), sphere(), options), std::invalid_argument);
  options = known_frame();
  options.prepare.rate = 1.0;
  EXPECT_THROW(evaluate_rendering(rubbed_sphere(0.0), sphere(), options), std::invalid_argument);
  options = known_frame();
  options.resolution = 1;
  EXPECT_THROW(evaluate_rendering(rubbed_sphere(0.0), sphere(), options), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::evaluation
