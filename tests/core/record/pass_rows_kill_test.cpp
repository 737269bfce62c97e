// Passes as fast as they can be written, killed at random instants: a pass in the file has its rows
// in the other tables.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <vector>

#include "core/base/random.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/marker_row.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::pass_rows_kill_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

constexpr int kKills = 60;
constexpr int kMarkers = 8;  // of a pass
constexpr useconds_t kLatest = 60'000;

[[noreturn]] void write_passes(const fs::path& file) {
  SessionInfo info = test::example_info();
  info.clock = "real";
  SessionWriter writer(file, info, {&table_of<MarkerRow>()});
  for (int pass = 0;; ++pass) {
    std::vector<MarkerRow> markers(kMarkers);
    for (MarkerRow& marker : markers) {
      marker.pass = pass;
      marker.name = "ready";
    }
    writer.add(Rows(std::span<const MarkerRow>(markers)));
    writer.add_pass({pass + 1, "haptic", Phase::kTest, 1, 1, 7, 0, 0, {}});
    writer.sync_soon();
  }
}

TEST(PassRowsKillTest, APassThatIsThereHasItsRows) {
  const TemporaryFolder folder;
  RandomStream random(1, "kills");
  std::size_t most = 0;
  // Kills go on until there was a whole chunk of passes, too; later and later on a slow machine.
  for (int kill_number = 0; kill_number < kKills || most <= 64; ++kill_number) {
    const fs::path file = folder / fmt::format("{:02}.h5", kill_number);
    const pid_t child = fork();
    if (child == 0) {
      write_passes(file);
    }
    const double latest = static_cast<double>(kLatest) * (1 + kill_number / kKills);
    usleep(static_cast<useconds_t>(random.uniform(0.1, 1.0) * latest));
    ::kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the session failed by itself";
    const fs::path partial = file.string() + ".partial";
    if (!fs::exists(partial)) {
      continue;
    }
    const SessionReader reader(partial);
    const std::size_t passes = reader.passes().size();
    const auto markers = reader.rows<MarkerRow>();
    EXPECT_GE(markers.size(), kMarkers * passes) << "kill " << kill_number;
    most = std::max(most, passes);
    fs::remove(partial);
  }
}

}  // namespace
}  // namespace haptrial::record::pass_rows_kill_test
