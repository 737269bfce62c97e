// haptrial mesh, as it is called from a shell.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class MeshCommandTest : public ::testing::Test {
 protected:
  test::CommandResult run(const std::string& line) {
    return test::run_command("cd '" + folder_.path().string() + "'\n" + line);
  }
  std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      ++count;
    }
    return count;
  }
  test::TemporaryFolder folder_;
};

TEST_F(MeshCommandTest, InfoSaysWhatAMeshIs) {
  const auto result = run("haptrial mesh make gear gear.ply && haptrial mesh info gear.ply");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("496 vertices, 992 triangles, 1488 edges"),
                                   HasSubstr("closed, manifold, faces look outwards"),
                                   HasSubstr("1 component, genus 1"), HasSubstr("by winding")));
}

TEST_F(MeshCommandTest, RepairJoinsAndOrients) {
  test::write_text(folder_ / "two.obj",
                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1e-7 0 0\nv 5 5 5\n"
                   "f 1 2 3\nf 5 2 4\nf 1 4 3\nf 2 3 4\nf 1 1 2\n");
  const auto result = run("haptrial mesh repair two.obj two.ply --weld 1e-6");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("welded      1 vertices"), HasSubstr("removed     1 degenerate"),
                    HasSubstr("closed, manifold, faces look outwards")));
  EXPECT_EQ(files(), 2u);
}

TEST_F(MeshCommandTest, VoxelsAndTetrahedraAreCountedAndDrawn) {
  const auto result =
      run("haptrial mesh make torus t.obj\n"
          "haptrial mesh voxelize t.obj t.nrrd --resolution 30 --picture v.png --up z\n"
          "haptrial mesh tetrahedralize t.obj t.vtu --resolution 30 --over --picture t.png\n"
          "haptrial mesh tetrahedralize t.obj t.node --resolution 20 --inside flood");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("grid        30 x 30 x 9 voxels"),
                                   HasSubstr("grid        32 x 32 x 11 voxels"),
                                   HasSubstr("voxels by flood"), HasSubstr("at the surface")));
  EXPECT_EQ(files(), 7u);
}

TEST_F(MeshCommandTest, BadInputGetsASentenceAndLeavesNothing) {
  test::write_text(folder_ / "bad.obj", "v 0 0 0\nf 1 2 3\n");
  test::write_text(folder_ / "open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::vector<std::pair<const char*, const char*>> cases{
      {"haptrial mesh info bad.obj",
       "haptrial: bad.obj:2: a face has the corner 3; allowed: 1 to 1"},
      {"haptrial mesh info none.obj", "haptrial: none.obj: no such file; choose a mesh file"},
      {"haptrial mesh info open.txt", "haptrial: open.txt: ends in '.txt'; allowed: .obj"},
      {"haptrial mesh repair open.obj open.obj", "haptrial: open.obj: exists already"},
      {"haptrial mesh repair open.obj new.ply --weld -1", "haptrial: --weld is -1; allowed"},
      {"haptrial mesh voxelize open.obj new.vti", "haptrial: new.vti: ends in '.vti'; allowed"},
      {"haptrial mesh voxelize open.obj a.nrrd --inside parity", "haptrial: the mesh is open"},
      {"haptrial mesh voxelize open.obj a.nrrd --inside best", "haptrial: --inside is 'best'"},
      {"haptrial mesh voxelize open.obj a.nrrd --resolution 0", "haptrial: the resolution is 0"},
      {"haptrial mesh voxelize open.obj a.nrrd --max-memory 1e-9", "haptrial: open.obj may take"},
      {"haptrial mesh voxelize open.obj a.nrrd --up w", "haptrial: --up is 'w'; allowed: x, y, z"},
      {"haptrial mesh info open.obj --scale 0", "haptrial: --scale is 0; allowed"},
      {"haptrial mesh make cube a.ply", "haptrial: the shape is 'cube'; allowed: sphere"},
      {"haptrial mesh tetrahedralize open.obj new.stl", "haptrial: new.stl: ends in '.stl'"}};
  for (const auto& [line, sentence] : cases) {
    const auto result = run(line);
    EXPECT_EQ(result.status, 2) << line << "\n" << result.output;
    EXPECT_THAT(result.errors, StartsWith(sentence)) << line;
  }
  EXPECT_EQ(files(), 2u);
}

TEST_F(MeshCommandTest, MemoryIsRefusedBeforeItIsTaken) {
  const auto result =
      run("haptrial mesh make sphere s.ply && haptrial mesh voxelize s.ply s.nrrd --resolution "
          "2000 --max-memory 1");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("voxels may take 8"));
  EXPECT_THAT(result.errors, HasSubstr("--max-memory allows 1 GB"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(MeshCommandTest, AnInterruptLeavesNothingHalfWritten) {
  const auto result =
      run("haptrial mesh make gear g.ply\n"
          "\"$HAPTRIAL\" mesh tetrahedralize g.ply g.node --resolution 300 > /dev/null &\n"
          "child=$!\n"
          "while kill -0 $child && [ ! -e g.node.partial-1 ]; do sleep 0.05; done\n"
          "[ -e g.node.partial-1 ] || echo never began\n"
          "kill -INT $child; wait $child; echo status $?; ls");
  EXPECT_EQ(result.output, "wrote       g.ply: 992 triangles\nstatus 1\ng.ply\n");
  EXPECT_THAT(result.errors, HasSubstr("the work was cancelled"));
}

}  // namespace
}  // namespace haptrial
