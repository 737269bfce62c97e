// The libraries as another project takes them: installed, found, linked, run.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>

#include "tests/experiments/command.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

/// The project installed into a folder of the test's own, once.
class InstallTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kThreadSanitizer || test::kAddressSanitizer) {
      GTEST_SKIP() << "the other project is built without the sanitizer of this one";
    }
  }
  /// Builds a project of docs/worked outside the source tree, into the folder build.
  test::CommandResult build(const std::string& name) const {
    std::string line = "set -e; cd '";
    line += root_;
    line += "'\ncmake --install '" HAPTRIAL_BINARY_DIR
            "' --prefix installed\n"
            "cmake -S '" HAPTRIAL_SOURCE_DIR "/docs/worked/";
    line += name;
    line += "' -B build -G Ninja -DCMAKE_PREFIX_PATH=\"$PWD/installed\"\ncmake --build build\n";
    return test::run_command(line);
  }
  test::TemporaryFolder folder_;
  std::string root_{folder_.path().string()};
};

/// A protocol of one's own: the whole runner as a library, with nothing of the source tree.
TEST_F(InstallTest, AProgramWithAProtocolOfItsOwnRunsStudies) {
  const test::CommandResult built = build("protocol");
  ASSERT_EQ(built.status, 0) << built.output << built.errors;
  const std::string program = root_ + "/build/springs ";
  const std::string definition = " " HAPTRIAL_SOURCE_DIR "/docs/worked/protocol/springs.toml ";
  const std::string sessions = root_ + "/sessions";
  test::CommandResult ran = test::run_command(program + "dry-run" + definition +
                                              "--subjects 2 --trials 8 --out " + sessions);
  ASSERT_EQ(ran.status, 0) << ran.errors;
  ran = test::run_command(program + "analyze " + sessions);
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("S01: threshold "), std::string::npos) << ran.output;
  EXPECT_NE(ran.output.find("S02: threshold "), std::string::npos) << ran.output;
  ran = test::run_command(program + "info " + sessions + "/S01.h5");
  EXPECT_EQ(ran.status, 0) << ran.output << ran.errors;
  ran = test::run_command("haptrial analyze " + sessions);
  EXPECT_EQ(ran.status, 2) << "the command has no such protocol";
  EXPECT_NE(ran.errors.find("/S01.h5: this program cannot read its definition, and may lack kinds "
                            "of the program that recorded it"),
            std::string::npos)
      << ran.errors;
  EXPECT_NE(ran.errors.find("experiment.protocol is 'springs'; allowed: force_training"),
            std::string::npos)
      << ran.errors;
  ran = test::run_command(program + "keys springs");
  EXPECT_NE(ran.output.find("at most 1000 | Stiffness of the spring that others are compared with"),
            std::string::npos)
      << ran.output << ran.errors;
  ran = test::run_command(program + "validate " HAPTRIAL_SOURCE_DIR
                                    "/experiments/force_training.toml");
  EXPECT_EQ(ran.status, 0) << "it has the others' as well: " << ran.errors;
}

/// A program with a kind of its own of everything, with nothing of the source tree.
TEST_F(InstallTest, AProgramWithKindsOfItsOwnUsesThem) {
  const test::CommandResult built = build("own");
  ASSERT_EQ(built.status, 0) << built.output << built.errors;
  const std::string folder = root_ + "/build/";
  test::CommandResult ran = test::run_command(folder + "own devices");
  EXPECT_NE(ran.output.find("circle           ready"), std::string::npos) << ran.output;
  ran = test::run_command(folder + "own device-test circle:0.5");
  EXPECT_EQ(ran.status, 2) << ran.output;
  EXPECT_NE(ran.errors.find("a radius up to 0.07"), std::string::npos) << ran.errors;

  const std::string valley = "cd '" + root_ + "' && " + folder + "own ";
  ran = test::run_command("cd '" + root_ +
                          "' && cp " HAPTRIAL_SOURCE_DIR
                          "/experiments/first_experiment.toml valley.toml && printf "
                          "'\n[fields.valley]\ntype = \"valley\"\nstrength = 2\nwidth = 0.02\n'"
                          " >> valley.toml");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  ran = test::run_command(valley + "dry-run valley.toml --subjects 1 --trials 2 --out sessions");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  ran = test::run_command(valley + "analyze sessions");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  const std::string keys = test::run_command(folder + "own keys trials").output;
  for (const char* line :
       {"| `strength` | number or text | N | needed | ",
        "Distance at which a valley has its strength (type: valley) |",
        "Radius of a ring's tube (type: ring)",
        "later ones are divided by the number of trials (kind: robbins_monro) |"}) {
    EXPECT_NE(keys.find(line), std::string::npos) << line;
  }
  for (const char* line : {"analyze sessions", "replay sessions/S01.h5 --frames nowhere"}) {
    ran = test::run_command("cd '" + root_ + "' && haptrial " + line);
    EXPECT_EQ(ran.status, 2) << line;
    EXPECT_NE(ran.errors.find("sessions/S01.h5: this program cannot read its definition, and may "
                              "lack kinds of the program that recorded it: valley.toml:"),
              std::string::npos)
        << ran.errors;
    EXPECT_NE(ran.errors.find("fields.valley.type is 'valley'; allowed: "), std::string::npos)
        << ran.errors;
    EXPECT_EQ(ran.errors.find('\n'), ran.errors.size() - 1) << ran.errors;
  }

  const std::string ring = "cd '" + root_ + "' && " + folder + "own ";
  ran = test::run_command(
      "cd '" + root_ +
      "' && cp " HAPTRIAL_SOURCE_DIR
      "/experiments/first_experiment.toml ring.toml && sed -i 's/fields = .*/fields = [\"pull\", "
      "\"ring\", \"block\"]/' ring.toml && printf '"
      "\n[fields.ring]\ntype = \"ring\"\ncentre = [0, 0, 0]\nradius = 0.03\ntube = 0.01\n"
      "stiffness = 100\ndamping = 0\n[objects.block]\nshape = \"box\"\nsize = [0.02, 0.02, 0.02]\n"
      "renderer = \"lossy\"\nstiffness = 100\ndamping = 0\n' >> ring.toml");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  ran = test::run_command(ring + "dry-run ring.toml --subjects 1 --trials 2 --out rings");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  ran = test::run_command(ring + "analyze rings");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  ran = test::run_command("cd '" + root_ + "' && haptrial validate ring.toml");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.errors.find("fields.ring.type is 'ring'"), std::string::npos) << ran.errors;

  ran = test::run_command("cd '" + root_ +
                          "' && haptrial run valley.toml --subject S01 --out sessions --resume");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.errors.find("fields.valley.type is 'valley'; allowed: "), std::string::npos)
      << ran.errors;

  ran = test::run_command("cd '" + root_ +
                          "' && haptrial dry-run " HAPTRIAL_SOURCE_DIR
                          "/experiments/first_experiment.toml --subjects 1 --trials 2 --out first");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  ran = test::run_command(folder + "own analyze " + root_ + "/first");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("2 own scores: "), std::string::npos) << ran.output;
  const test::CommandResult table = test::run_command("cat " + root_ + "/first/own_scores.csv");
  EXPECT_NE(table.output.find("S01,1,1,2,"), std::string::npos) << table.output;
  EXPECT_NE(table.output.find(",way,0."), std::string::npos) << table.output;
  EXPECT_NE(ran.output.find("Mean way of the hand in a pass: 0."), std::string::npos) << ran.output;
  const test::CommandResult report = test::run_command("cat " + root_ + "/first/report.md");
  EXPECT_NE(report.output.find("## Way of the hand (simulated)"), std::string::npos);
}

TEST_F(InstallTest, AnotherProjectFindsLinksAndRunsTheLibraries) {
  const test::CommandResult built = build("geometry");
  ASSERT_EQ(built.status, 0) << built.output << built.errors;
  EXPECT_EQ(built.output.find(HAPTRIAL_SOURCE_DIR "/core"), std::string::npos)
      << "nothing is taken from the source tree";

  std::string line;
  line = root_;
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

  line = root_;
  line += "/installed/bin/haptrial --version";
  const test::CommandResult command = test::run_command(line);
  EXPECT_EQ(command.status, 0) << command.errors;
  EXPECT_TRUE(
      std::filesystem::exists(folder_ / "installed/include/haptrial/core/geometry/bvh/bvh.h"));

  line = "LC_ALL=C readelf --sections --wide '";
  line += root_;
  line += "/installed/bin/haptrial'";
  const test::CommandResult sections = test::run_command(line);
  EXPECT_NE(sections.output.find(" .dynsym "), std::string::npos) << sections.errors;
  EXPECT_EQ(sections.output.find(" .symtab "), std::string::npos) << "the command is not stripped";
  EXPECT_EQ(sections.output.find(" .debug_"), std::string::npos) << "the command is not stripped";
}

/// The Debian package of the command, unpacked beside the system: what it has runs, it says what it
/// needs, and lintian finds nothing but the missing address of the project.
TEST_F(InstallTest, APackageHoldsTheCommandWithManualAndDefinitions) {
  std::string line = "set -e; cd '";
  line += root_;
  line += "'\n" HAPTRIAL_SOURCE_DIR "/cmake/man-page.sh " HAPTRIAL_BINARY_DIR
          "/haptrial " HAPTRIAL_BINARY_DIR "/haptrial.1.gz\n";
  line += "cpack --config '" HAPTRIAL_BINARY_DIR
          "/CPackConfig.cmake' -B made -D CPACK_COMPONENTS_ALL=command\n"
          "lintian --allow-root --fail-on error,warning --suppress-tags "
          "bogus-mail-host,bogus-mail-host-in-debian-changelog made/haptrial_*.deb >&2\n"
          "dpkg-deb -x made/haptrial_*.deb unpacked\n"
          "dpkg-deb -f made/haptrial_*.deb Depends\n";
  const test::CommandResult made = test::run_command(line);
  ASSERT_EQ(made.status, 0) << made.output << made.errors;
  for (const char* needed : {"libhdf5", "libgsl", "libosmesa6", "gnuplot-nox"}) {
    EXPECT_NE(made.output.find(needed), std::string::npos) << needed << " in " << made.output;
  }
  const auto unpacked = folder_ / "unpacked/usr";
  EXPECT_TRUE(std::filesystem::exists(unpacked / "share/man/man1/haptrial.1.gz"));
  EXPECT_TRUE(std::filesystem::exists(unpacked / "share/doc/haptrial/docs/keys.md"));
  EXPECT_TRUE(std::filesystem::exists(unpacked / "share/bash-completion/completions/haptrial"));
  const std::string definition =
      (unpacked / "share/doc/haptrial/experiments/first_experiment.toml").string();
  const std::string command = (unpacked / "bin/haptrial").string();
  const test::CommandResult ran = test::run_command(command + " validate " + definition);
  EXPECT_EQ(ran.status, 0) << ran.errors;
}

/// All packages in a Debian that has nothing else: installed, used in each way, removed.
TEST_F(InstallTest, ABareMachineInstallsUsesAndRemovesThePackages) {
  if (std::getenv("HAPTRIAL_BARE_MACHINE") == nullptr) {
    GTEST_SKIP() << "it takes minutes and Debian's archive; set HAPTRIAL_BARE_MACHINE=1, as root, "
                    "with debootstrap installed";
  }
  const test::CommandResult run = test::run_command(
      "set -e; cd '" + root_ +
      "'\ncpack --config " HAPTRIAL_BINARY_DIR "/CPackConfig.cmake -B made >/dev/null\n" +
      HAPTRIAL_SOURCE_DIR "/tests/experiments/bare_machine.sh made machine\n");
  EXPECT_EQ(run.status, 0) << run.errors;
  std::printf("%s", run.output.c_str());
}

/// The bundle of a tarball, moved, and started with nothing of the environment: every library comes
/// from the bundle but those of the C library, and what needs many of them runs.
TEST_F(InstallTest, ABundleRunsFromAnyFolderWithItsOwnLibraries) {
  const test::CommandResult made = test::run_command(
      HAPTRIAL_SOURCE_DIR "/cmake/bundle.sh " HAPTRIAL_BINARY_DIR " '" + root_ + "/made-here'");
  ASSERT_EQ(made.status, 0) << made.output << made.errors;
  const std::filesystem::path bundle = folder_ / "moved-there";
  std::filesystem::rename(folder_ / "made-here", bundle);

  const std::string command = "'" + (bundle / "bin/haptrial").string() + "'";
  const test::CommandResult loaded = test::run_command("env -i /usr/bin/ldd " + command);
  ASSERT_EQ(loaded.status, 0) << loaded.errors;
  std::istringstream lines(loaded.output);
  int own = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_EQ(line.find("not found"), std::string::npos) << line;
    if (line.find("moved-there/") != std::string::npos) {
      ++own;
      continue;
    }
    static const std::regex machine(
        "\\s(linux-vdso|/lib64/ld-linux|lib(c|m|mvec|dl|rt|pthread|resolv|util|anl)\\.so).*");
    EXPECT_TRUE(std::regex_match(line, machine)) << "taken from the machine: " << line;
  }
  EXPECT_GT(own, 20) << loaded.output;
  EXPECT_FALSE(std::filesystem::is_empty(bundle / "share/doc/haptrial/licenses"));

  const std::string ear = "'" + root_ + "/ear.nrrd'";
  for (const std::string& options :
       {std::string("--version"), std::string("examples"),
        "new '" + root_ + "/study.toml' --from stiffness_discrimination",
        "dry-run '" + root_ + "/study.toml' --subjects 1 --out '" + root_ + "/rehearsed'",
        "bone make temporal " + ear + " --seed 1",
        "bone picture " + ear + " '" + root_ + "/ear.png'"}) {
    const test::CommandResult ran = test::run_command("env -i " + command + " " + options);
    EXPECT_EQ(ran.status, 0) << options << ": " << ran.errors;
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "ear.png"));
}

TEST_F(InstallTest, TheManualHasEverySubcommand) {
  const std::string page = root_ + "/haptrial.1.gz";
  const test::CommandResult written = test::run_command(
      HAPTRIAL_SOURCE_DIR "/cmake/man-page.sh " HAPTRIAL_BINARY_DIR "/haptrial '" + page + "'");
  ASSERT_EQ(written.status, 0) << written.errors;
  const test::CommandResult text = test::run_command("gzip -dc '" + page + "'");
  for (const char* heading : {"haptrial dry-run", "haptrial doctor", "haptrial bone import"}) {
    EXPECT_NE(text.output.find(".SH \"" + std::string(heading) + "\""), std::string::npos)
        << heading;
  }
}

}  // namespace
}  // namespace haptrial
