// haptrial mesh distance, as it is called from a shell.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class MeshDistanceCommandTest : public ::testing::Test {
 protected:
  test::CommandResult run(const std::string& line) {
    return test::run_command("cd '" + folder_.path().string() + "'\n" + line);
  }
  bool exists(const char* name) const { return std::filesystem::exists(folder_ / name); }
  test::TemporaryFolder folder_;
};

// A sphere of 0.05 m: the deepest voxel is at its centre; read by h5py, not by our code.
TEST_F(MeshDistanceCommandTest, WritesDistancesThatOthersRead) {
  const auto result =
      run("haptrial mesh make sphere ball.ply\n"
          "haptrial mesh distance ball.ply ball.h5 --resolution 21 --everywhere --margin 2 "
          "--points near.h5 --picture slice.png\n"
          "/usr/bin/python3 - <<'END'\n"
          "import h5py, numpy as np\n"
          "d = h5py.File('ball.h5')['volume']; p = h5py.File('near.h5')['volume']\n"
          "s, o = d.attrs['spacing_m'], d.attrs['origin_m']\n"
          "k, j, i = np.indices(d.shape)\n"
          "x = np.stack([i, j, k], -1) * s + o\n"
          "r = np.linalg.norm(x, axis=-1)\n"
          "assert d.shape == (25, 25, 25), d.shape\n"
          "assert np.abs(d[:] - (r - 0.05)).max() < 3e-5\n"
          "assert np.abs(np.linalg.norm(p[:].reshape(x.shape), axis=-1) - 0.05).max() < 3e-5\n"
          "print('all as it should be')\n"
          "END");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("of 15625 voxels; deepest 0.04"), HasSubstr("all as it should be")));
  EXPECT_TRUE(exists("slice.png"));
}

TEST_F(MeshDistanceCommandTest, LeavesTheOutsideAloneUnlessAsked) {
  const auto result =
      run("haptrial mesh make gear gear.ply\n"
          "haptrial mesh distance gear.ply gear.nrrd --resolution 30");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("farthest outside 0 m"));
  EXPECT_TRUE(exists("gear.nrrd"));
}

TEST_F(MeshDistanceCommandTest, SaysThatNothingIsInside) {
  const auto result =
      run("haptrial mesh make sphere both.obj\n"
          "awk '/^f/ { print \"f\", $2, $4, $3 }' both.obj > other.obj; cat other.obj >> both.obj\n"
          "haptrial mesh distance both.obj both.nrrd --resolution 10 --everywhere");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("WARNING: no voxel is inside"));
  EXPECT_THAT(result.output, HasSubstr("deepest 0 m"));
}

TEST_F(MeshDistanceCommandTest, RefusesBeforeItWrites) {
  run("haptrial mesh make gear gear.ply; touch there.nrrd");
  const auto expect_refused = [&](const std::string& arguments, const std::string& sentence) {
    SCOPED_TRACE(arguments);
    const auto result = run("haptrial mesh distance gear.ply " + arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.errors, HasSubstr(sentence));
  };
  expect_refused("there.nrrd", "exists already");
  expect_refused("out.xyz", "out.xyz");
  expect_refused("out.nrrd --points there.nrrd", "exists already");
  expect_refused("out.nrrd --resolution 400 --everywhere --max-memory 0.1", "memory");
  expect_refused("out.nrrd --resolution 0", "resolution");
  expect_refused("out.nrrd --margin -1", "margin");
  expect_refused("out.nrrd --up w", "--up");
  EXPECT_FALSE(exists("out.nrrd"));
}

}  // namespace
}  // namespace haptrial
