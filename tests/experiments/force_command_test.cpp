// build/haptrial_forces: the force studies without the other protocols.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::force_command_test {
namespace {

using test::run_command;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

const std::string kForces = "'" HAPTRIAL_BINARY_DIR "/haptrial_forces'";
const std::string kDefinitions = HAPTRIAL_SOURCE_DIR "/experiments/";

// But for the hours at which sessions began. Scores follow from all samples.
TEST(ForceCommandTest, RecordsAndScoresAsTheWholeCommandDoes) {
  const test::TemporaryFolder folder;
  const std::string at = folder.path().string();
  const auto made = run_command(
      "for program in " + kForces + " \"$HAPTRIAL\"; do\n  out='" + at +
      "'/$(basename $program)\n  $program dry-run " + kDefinitions +
      "force_training.toml --subjects 2 --out $out && $program analyze $out && haptrial export "
      "$out --csv $out/tables || exit 1\ndone\ndiff -r --exclude sessions.csv " +
      at + "/haptrial/tables " + at + "/haptrial_forces/tables && diff " + at +
      "/haptrial/scores.csv " + at + "/haptrial_forces/scores.csv && wc -l <" + at +
      "/haptrial/scores.csv");
  EXPECT_EQ(made.status, 0) << made.output << made.errors;
  EXPECT_THAT(made.output, ContainsRegex("\n[0-9][0-9]+\n$"));  // there was something to compare
}

// Neither scans nor bodies nor their libraries are linked to what a force study needs.
TEST(ForceCommandTest, HasNothingOfTheOtherProtocols) {
  const std::string libraries = "readelf --dynamic ";
  const std::string others = "gdcm|teem|nifti|meshoptimizer|cholmod|nlopt|muparser";
  EXPECT_THAT(run_command(libraries + "\"$HAPTRIAL\"").output, ContainsRegex(others));
  EXPECT_THAT(run_command(libraries + kForces).output, Not(ContainsRegex(others)));
  EXPECT_THAT(run_command(libraries + kForces).output, HasSubstr("hdf5"));
  const std::string named = "haptrial::(bone|deformable|contact|geometry)::|meshopt_";
  const std::string symbols = " | grep -Ec '" + named + "'";
  EXPECT_THAT(run_command("nm --demangle \"$HAPTRIAL\"" + symbols).output,
              ContainsRegex("^[0-9][0-9][0-9]+\n$"));
  EXPECT_EQ(run_command("nm --demangle " + kForces + symbols).output, "0\n");
}

TEST(ForceCommandTest, SaysWhichProtocolsItHas) {
  const auto refused = run_command(kForces + " validate " + kDefinitions + "wall_detection.toml");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors,
              HasSubstr("experiment.protocol is 'trials'; allowed: force_training"));
  EXPECT_THAT(run_command(kForces + " keys").errors,
              HasSubstr("'keys' is not a subcommand of haptrial_forces; allowed: dry-run"));
}

}  // namespace
}  // namespace haptrial::force_command_test
