// Memory of a static solution, against the memory that the process was given.

#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "core/deformable/elements/static_solver.h"
#include "tests/support/sanitizer.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double all = 0;
  double resident = 0;
  file >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double most_resident_bytes() {
  std::ifstream file("/proc/self/status");
  std::string word;
  while (file >> word && word != "VmHWM:") {
  }
  double kilobytes = 0;
  file >> kilobytes;
  return 1024 * kilobytes;
}

class StaticMemoryTest : public testing::TestWithParam<LinearSolver> {};

TEST_P(StaticMemoryTest, IsWhatTheProcessGrowsByOrSomewhatMore) {
  if (test::kAddressSanitizer || test::kThreadSanitizer) {
    GTEST_SKIP() << "a sanitizer takes memory of its own";
  }
  const geometry::TetMesh mesh = test::solid_block({15, 15, 15}, 0.01);
  LoadCase load{"push", {}, {{static_cast<std::int32_t>(mesh.vertices.size()) - 1, {1, 0, 0}}}};
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertices[v].z() < 1e-9) {
      load.holds.push_back({static_cast<std::int32_t>(v), Eigen::Vector3d::Zero()});
    }
  }
  const double said = static_memory(mesh.vertices.size(), mesh.tetrahedra.size(), GetParam());
  const auto solve = [&] {
    const ElasticBody body(mesh, Elasticity{{{1e5, 0.3, 1000}}, {}, Law::kLinear});
    solve_static(body, load, {.solver = GetParam()});
  };
  solve();  // the pages of the program's own code come in, which are not the solution's
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak starts anew
  const double before = resident_bytes();
  solve();
  const double taken = most_resident_bytes() - before;
  EXPECT_LT(taken, said);
  EXPECT_GT(taken, 0.4 * said);
}

INSTANTIATE_TEST_SUITE_P(Solvers, StaticMemoryTest,
                         testing::Values(LinearSolver::kConjugateGradients,
                                         LinearSolver::kCholesky),
                         [](const auto& which) {
                           return which.param == LinearSolver::kCholesky ? "Cholesky" : "Gradients";
                         });

}  // namespace
}  // namespace haptrial::deformable
