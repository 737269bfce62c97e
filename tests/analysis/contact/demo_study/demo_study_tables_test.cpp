#include "analysis/contact/demo_study/demo_study_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "analysis/contact/demo_study/demo_study_figures.h"
#include "analysis/contact/demo_study/demo_study_report.h"
#include "core/base/file_text.h"
#include "core/geometry/bvh/bvh.h"
#include "core/geometry/volume/mesh_check.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

/// The normal of the gradient is that of a fine mesh.
TEST(DemoStudyTest, NormalsAreThoseOfItsMesh) {
  const geometry::Mesh mesh = radial_mesh(duck_radius, 60);
  double worst = 0.0;
  for (const geometry::Triangle& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const Vector3d normal = (b - a).cross(c - a).normalized();
    worst = std::max(worst, (radial_normal(duck_radius, (a + b + c).normalized()) - normal).norm());
  }
  EXPECT_LT(worst, 0.05) << "edges of 1 mm on curvatures of up to 100 per metre";
}

TEST(DemoStudyTest, ScanAndCoarserMeshesAreClosed) {
  const geometry::Mesh scan = scanned_mesh(duck_radius, {.frequency = 40});
  const geometry::Bvh bvh(scan);
  const RadialBody scanned = radius_of(bvh);
  for (const int frequency : {3, 7, 21}) {
    const geometry::Mesh mesh = radial_mesh(scanned, frequency);
    EXPECT_EQ(mesh.triangles.size(), 20u * frequency * frequency);
    EXPECT_TRUE(geometry::check_mesh(mesh).closed) << frequency;
    for (const Vector3d& v : mesh.vertices) {
      ASSERT_LT(std::sqrt(bvh.closest(v).distance_squared), 1e-9) << "corners lie on the scan";
    }
  }
  double squares = 0.0;
  for (const Vector3d& v : scan.vertices) {
    const double off = v.norm() - duck_radius(v.normalized());
    squares += off * off / static_cast<double>(scan.vertices.size());
  }
  EXPECT_LT(std::sqrt(squares), 0.0004) << "smoothing leaves less than half of 1 mm";
  EXPECT_GT(std::sqrt(squares), 0.00005);
}

/// The trends of the source's tables, on a small scan.
TEST(DemoStudyTest, TablesHaveTheSourcesTrends) {
  DemoStudyOptions options;
  options.frequency = 60;  // 72,000 triangles
  options.seconds = 12.0;
  const DemoStudyTables t = make_demo_study_tables(options);
  ASSERT_EQ(t.table4.size(), 3u);
  EXPECT_GT(t.table4[0].normal_error, t.table4[1].normal_error) << "finer voxels err less";
  EXPECT_LT(t.table4[2].normal_error, t.table4[1].normal_error) << "the proxy errs least";
  EXPECT_LT(t.friction.with, 0.6 * t.friction.without);
  EXPECT_NEAR(t.friction.friction, options.friction, 0.05);
  ASSERT_EQ(t.table6.size(), 8u);
  EXPECT_GT(t.table6[0].normal_error, 4.0 * t.table6.back().normal_error);
  EXPECT_LT(t.shaded[2].normal_error, t.table6[2].normal_error) << "shading helps a coarse mesh";
}

/// A probe that is led 30 mm over a plate and pressed 2 mm into it.
DemoStudyTables stroked_plate() {
  DemoStudyTables t;
  t.contact.rate = 1000.0;
  t.contact.stiffness = 300.0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d on(1e-4 * i, 0.0, 0.0);
    t.contact.touching.push_back(true);
    t.contact.out.push_back(on);
    t.contact.in.emplace_back(on - Vector3d(0.0, 0.002, 0.0));
    t.contact.normal.push_back(Vector3d::UnitY());
  }
  t.scan = {{0.0, 0.0, 0.0}, {0.03, 0.0, 0.0}, {0.03, 0.01, 0.0}, {0.0, 0.01, 0.002}};
  return t;
}

TEST(DemoStudyTest, TheInTrajectoryIsDrawnBelowTheOutTrajectory) {
  const analysis::Figure figure = trajectory_figure(stroked_plate());
  ASSERT_EQ(figure.series.size(), 3u);
  const analysis::Series &joined = figure.series[0], &out = figure.series[1],
                         &in = figure.series[2];
  ASSERT_EQ(out.x.size(), 200u) << "the middle of 300 samples";
  EXPECT_NEAR(out.x.back() - out.x.front(), 19.9, 1e-9) << "mm";
  for (std::size_t i = 0; i < out.x.size(); ++i) {
    ASSERT_NEAR(out.y[i] - in.y[i], 2.0, 1e-9);
    ASSERT_NEAR(out.x[i], in.x[i], 1e-9);
  }
  EXPECT_EQ(joined.x.size(), 20u);
  EXPECT_EQ(path_figure(stroked_plate()).series.size(), 2u);
}

TEST(DemoStudyTest, IsWrittenWithTheSourcesNumbers) {
  DemoStudyTables t = stroked_plate();
  t.contact.registration = Registration{};
  t.contact.load = LoadFit{};
  t.table4.assign(3, {"proxy", 140'000, 0.0, 0.12, 0.01, 1e-6, 0.0, 0.0});
  t.table5.assign(2, t.table4[0]);
  t.table6.assign(8, t.table4[0]);
  for (std::size_t i = 0; i < 8; ++i) {
    t.table6[i].triangles = 200 << i;
  }
  t.shaded = t.table6;
  const test::TemporaryFolder folder;
  write_demo_study(t, {}, folder / "out");
  EXPECT_THAT(file_text(folder / "out/table-5.csv"), HasSubstr("0.067"));
  EXPECT_THAT(file_text(folder / "out/table-6.csv"), HasSubstr("0.085"));
  EXPECT_THAT(file_text(folder / "out/report.html"), HasSubstr("SIMULATED RECORDING"));
  EXPECT_THAT(demo_study_lines(t, {}).front(), "SIMULATED RECORDING");
}

}  // namespace
}  // namespace haptrial::evaluation
