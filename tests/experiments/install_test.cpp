// The libraries as another project takes them: installed, found, linked, run.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <numbers>

#include "tests/experiments/command.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

TEST(InstallTest, AnotherProjectFindsLinksAndRunsTheLibraries) {
  if (test::kThreadSanitizer || test::kAddressSanitizer) {
    GTEST_SKIP() << "the other project is built without the sanitizer of this one";
  }
  const test::TemporaryFolder folder;
  const std::string root = folder.path().string();
  std::string line = "set -e; cd '";
  line += root;
  line += "'\ncmake --install '" HAPTRIAL_BINARY_DIR
          "' --prefix installed\n"
          "cmake -S '" HAPTRIAL_SOURCE_DIR
          "/docs/worked/geometry' -B build -G Ninja -DCMAKE_PREFIX_PATH=\"$PWD/installed\"\n"
          "cmake --build build\n";
  const test::CommandResult built = test::run_command(line);
  ASSERT_EQ(built.status, 0) << built.output << built.errors;
  EXPECT_EQ(built.output.find(HAPTRIAL_SOURCE_DIR "/core"), std::string::npos)
      << "nothing is taken from the source tree";

  line = root;
  line += "/build/near";
  const test::CommandResult ran = test::run_command(line);
  ASSERT_EQ(ran.status, 0) << ran.errors;
  double distance = 0.0;
  double along = 0.0;
  double length = 0.0;
  ASSERT_EQ(
      std::sscanf(ran.output.c_str(), "distance %lf m, inside: no\nalong the curve %lf m of %lf m",
                  &distance, &along, &length),
      3)
      << ran.output;
  const double around = 2.0 * std::numbers::pi * 0.05;
  EXPECT_NEAR(distance, 0.02, 5e-5) << "the sphere is made of triangles";
  EXPECT_NEAR(length, around, 1e-6);
  EXPECT_NEAR(along, 0.75 * around, 1e-6);

  line = root;
  line += "/installed/bin/haptrial --version";
  const test::CommandResult command = test::run_command(line);
  EXPECT_EQ(command.status, 0) << command.errors;
  EXPECT_TRUE(std::filesystem::exists(folder / "installed/include/haptrial/core/geometry/bvh.h"));

  line = "LC_ALL=C readelf --sections --wide '";
  line += root;
  line += "/installed/bin/haptrial'";
  const test::CommandResult sections = test::run_command(line);
  EXPECT_NE(sections.output.find(" .dynsym "), std::string::npos) << sections.errors;
  EXPECT_EQ(sections.output.find(" .symtab "), std::string::npos) << "the command is not stripped";
  EXPECT_EQ(sections.output.find(" .debug_"), std::string::npos) << "the command is not stripped";
}

}  // namespace
}  // namespace haptrial
