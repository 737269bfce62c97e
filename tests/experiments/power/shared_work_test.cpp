// Processes that share a folder of parts: locks, ranks, and what mpirun starts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <thread>

#include "core/base/child_process.h"
#include "experiments/study/shared_work.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::shared_work_test {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;

TEST(UnitLocks, AUnitIsOfOneProcessUntilItIsReleased) {
  const test::TemporaryFolder folder;
  const UnitLocks mine(folder / "lock"), others(folder / "lock");
  EXPECT_TRUE(mine.take(3));
  EXPECT_FALSE(others.take(3));
  EXPECT_TRUE(others.take(4));
  mine.release(3);
  EXPECT_TRUE(others.take(3));
  {
    const TakenUnit taken(mine, 7);
    EXPECT_TRUE(taken);
    EXPECT_FALSE(others.take(7));
  }
  EXPECT_TRUE(others.take(7));
}

TEST(UnitLocks, AProcessThatDiesGivesItsUnitsBack) {
  const test::TemporaryFolder folder;
  const UnitLocks mine(folder / "lock");
  ChildProcess child([&] {
    const UnitLocks its(folder / "lock");
    its.take(1);
    test::write_text(folder / "taken", "");
    ::pause();
  });
  while (!fs::exists(folder / "taken")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_FALSE(mine.take(1));
  child.kill();
  child.wait();
  EXPECT_TRUE(mine.take(1));
}

TEST(UnitLocks, WithoutAFileEveryUnitIsFree) {
  const UnitLocks locks("/proc/no/such/lock");
  EXPECT_TRUE(locks.take(0));
  EXPECT_TRUE(locks.take(0));
}

TEST(LaunchRank, IsWhatTheStarterSays) {
  std::map<std::string, std::string> variables;
  const auto rank = [&] {
    return launch_rank([&](const char* name) -> const char* {
      const auto found = variables.find(name);
      return found == variables.end() ? nullptr : found->second.c_str();
    });
  };
  EXPECT_FALSE(rank());
  variables = {{"SLURM_PROCID", "0"}};  // a batch script without srun
  EXPECT_FALSE(rank());
  variables = {{"SLURM_PROCID", "2"}, {"SLURM_STEP_NUM_TASKS", "3"}};
  ASSERT_TRUE(rank());
  EXPECT_EQ(rank()->rank, 2);
  EXPECT_EQ(rank()->size, 3);
  variables["OMPI_COMM_WORLD_RANK"] = "1";
  variables["OMPI_COMM_WORLD_SIZE"] = "8";
  EXPECT_EQ(rank()->size, 8);
  for (const char* bad : {"8", "-1", "1x", ""}) {
    variables = {{"PMI_RANK", bad}, {"PMI_SIZE", "8"}};
    EXPECT_FALSE(rank()) << bad;
  }
}

class MpirunTest : public testing::Test {
 protected:
  void SetUp() override {
    test::write_text(folder_ / "power.toml",
                     "[power]\ndefinition = \"" + test::shipped_definition().string() + R"("
watch = "planned: visuohaptic < visual, paired t"
replications = 40
null_replications = 40
block = 4
[power.responses]
mean = 2.0
participant = 0.2
interaction = 0.3
block = 0.3
trial = 0.5
[power.responses.effects]
visuohaptic = 0.0
[[power.vary]]
key = "design.participants"
values = [3, 4]
[[power.vary]]
key = "power.responses.effects.visuohaptic"
values = [-0.5]
none = 0.0
)");
    ASSERT_EQ(run_command(simulate("alone")).status, 0);
  }
  std::string simulate(const std::string& out) const {
    return "\"$HAPTRIAL\" power simulate '" + (folder_ / "power.toml").string() + "' --out '" +
           (folder_ / out).string() + "'";
  }
  static std::string mpirun(int ranks) {
    return "mpirun --allow-run-as-root --oversubscribe -n " + std::to_string(ranks) + " ";
  }
  std::string result_of(const std::string& out) const {
    return test::read_text(folder_ / out / "power.json") +
           test::read_text(folder_ / out / "report.html");
  }
  test::TemporaryFolder folder_;
};

TEST_F(MpirunTest, RanksShareTheUnitsAndOneReports) {
  for (const int ranks : {2, 4}) {
    const std::string out = "ranks-" + std::to_string(ranks);
    const CommandResult done = run_command(mpirun(ranks) + simulate(out));
    ASSERT_EQ(done.status, 0) << done.errors;
    EXPECT_EQ(result_of(out), result_of("alone"));
    EXPECT_THAT(done.output, testing::ContainsRegex("[0-9]+ of 40 parts were made"));
    EXPECT_EQ(done.output.find("parts were made"), done.output.rfind("parts were made"));
  }
}

TEST_F(MpirunTest, ADeadRankCostsItsUnitsOnly) {
  // Rank 1 kills itself as soon as there are three parts; the others go on.
  const std::string script =
      "#!/bin/bash\nif [ \"$OMPI_COMM_WORLD_RANK\" = 1 ]; then\n"
      "(while [ $(ls \"$1/parts\" 2>&1 | wc -l) -lt 3 ]; do :; done; "
      "touch \"$1/killed\"; kill -9 $$) &\nfi\nexec haptrial power simulate '" +
      (folder_ / "power.toml").string() + "' --out \"$1\"\n";
  test::write_text(folder_ / "rank", script);
  const std::string out = "'" + (folder_ / "killed").string() + "'";
  const CommandResult killed = run_command(
      "cd '" + folder_.path().string() +
      "'; mkdir bin; ln -s \"$HAPTRIAL\" bin/haptrial; PATH=$PWD/bin:$PATH; " + mpirun(3) +
      "--mca orte_abort_on_non_zero_status 0 --enable-recovery bash rank " + out);
  EXPECT_NE(killed.output.find("parts were made"), std::string::npos)
      << killed.output << killed.errors;
  EXPECT_TRUE(fs::exists(folder_ / "killed/killed"));
  EXPECT_EQ(result_of("killed"), result_of("alone"));
}

}  // namespace
}  // namespace haptrial::experiments::shared_work_test
