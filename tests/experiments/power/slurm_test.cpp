// The batch script of `haptrial power plan`, as an array of a Slurm of the test's own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>

#include "core/base/child_process.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/free_port.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::experiments::slurm_test {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;

constexpr int kTasks = 4;

class SlurmTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"slurmctld", "slurmd", "sbatch"}) {
      const std::string found = std::string("PATH=$PATH:/usr/sbin; command -v ") + program;
      ASSERT_EQ(run_command(found).status, 0) << program << " is not installed";
    }
    for (const char* each : {"state", "spool", "bin"}) {
      fs::create_directory(folder_ / each);
    }
    ASSERT_EQ(
        run_command("ln -s \"$HAPTRIAL\" '" + (folder_ / "bin/haptrial").string() + "'").status, 0);
    write_settings();
    start();
    test::wait_until([&] { return slurm("sinfo -h -o %T").output == "idle\n"; });
    write_question();
  }

  void TearDown() override {
    if (controller_) {
      slurm("scancel --user=$(id -un)");
      test::wait_until([&] { return in_queue() == 0; });
      node_.reset();
      controller_.reset();
    }
  }

  /// A shell line in the test's folder, for the test's own Slurm.
  CommandResult slurm(const std::string& line) const {
    const std::string at = folder_.path().string();
    return run_command("cd '" + at + "'; export SLURM_CONF='" + at + "/slurm.conf' PATH='" + at +
                       "/bin':$PATH; " + line);
  }

  int in_queue() const {
    const std::string jobs = slurm("squeue --noheader --array --format=%i").output;
    return static_cast<int>(std::count(jobs.begin(), jobs.end(), '\n'));
  }
  /// @returns the number of the array
  std::string submit() const {
    const CommandResult sent = slurm("sbatch --parsable --open-mode=append power.sbatch");
    EXPECT_EQ(sent.status, 0) << sent.errors;
    return sent.output.substr(0, sent.output.find('\n'));
  }
  long parts() const {
    const fs::path folder = folder_ / "array/parts";
    return fs::exists(folder)
               ? std::distance(fs::directory_iterator(folder), fs::directory_iterator())
               : 0;
  }
  std::string result_of(const std::string& out) const {
    return test::read_text(folder_ / out / "power.json") +
           test::read_text(folder_ / out / "report.html");
  }

  test::TemporaryFolder folder_;

 private:
  void write_settings() const {
    const std::string at = folder_.path().string();
    const std::string settings = R"(ClusterName=test
SlurmctldHost=HOST(127.0.0.1)
SlurmUser=USER
SlurmdUser=USER
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SlurmdParameters=config_overrides
KillWait=2
PartitionName=all Nodes=ALL Default=YES State=UP
NodeName=HOST NodeAddr=127.0.0.1 CPUs=4 RealMemory=8192 State=UNKNOWN
)";
    test::write_text(folder_ / "slurm.conf",
                     settings + "SlurmctldPort=" + std::to_string(test::free_port()) +
                         "\nSlurmdPort=" + std::to_string(test::free_port()) +
                         "\nStateSaveLocation=" + at + "/state\nSlurmdSpoolDir=" + at +
                         "/spool\nSlurmctldPidFile=" + at + "/controller.pid\nSlurmdPidFile=" + at +
                         "/node.pid\n");
    run_command("sed -i \"s/HOST/$(hostname -s)/; s/USER/$(id -un)/\" '" + at + "/slurm.conf'");
  }
  void start() {
    const auto daemon = [&](const std::string& name, const std::string& log) {
      return std::make_unique<ChildProcess>(
          Program{{"bash", "-c",
                   "export SLURM_CONF=$PWD/slurm.conf PATH=$PATH:/usr/sbin; exec " + name +
                       " -D > " + log + " 2>&1"},
                  folder_.path()});
    };
    controller_ = daemon("slurmctld", "controller");
    node_ = daemon("slurmd", "node");
  }
  void write_question() const {
    test::write_text(folder_ / "power.toml",
                     "[power]\ndefinition = \"" + test::shipped_definition().string() + R"("
watch = "planned: visuohaptic < visual, paired t"
replications = 600
null_replications = 600
block = 5
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
values = [12]
[[power.vary]]
key = "power.responses.effects.visuohaptic"
values = [-0.5]
none = 0.0
)");
  }

  std::unique_ptr<ChildProcess> controller_, node_;
};

TEST_F(SlurmTest, AnArrayThatIsKilledAndRequeuedGivesTheBytesOfOneThread) {
  ASSERT_EQ(slurm("haptrial power simulate power.toml --out alone --jobs 1").status, 0);
  const CommandResult plan = slurm("haptrial power plan power.toml --out array --tasks " +
                                   std::to_string(kTasks) + " --script power.sbatch");
  ASSERT_EQ(plan.status, 0) << plan.errors;
  const std::string first = submit();
  test::wait_until([&] { return parts() > 20; });
  const CommandResult requeued = slurm("scontrol requeue " + first + "_2");
  EXPECT_EQ(requeued.status, 0) << requeued.errors;
  slurm("scancel --batch --signal=KILL " + first + "_3");
  slurm("scancel --batch --signal=TERM " + first + "_4");  // as --signal before the limit
  EXPECT_LT(parts(), 240) << "nothing was left to be broken off";
  const auto over = [&] {  // a requeued task would wait two minutes
    slurm("scontrol update JobId=" + first + "_2 StartTime=now 2>/dev/null");
    return in_queue() == 0;
  };
  test::wait_until(over);
  const std::string jobs = slurm("scontrol show job " + first).output;
  EXPECT_THAT(jobs, testing::HasSubstr("Restarts=1"));
  const CommandResult early = slurm("haptrial power merge array");
  EXPECT_EQ(early.status, 2);
  EXPECT_THAT(early.errors, testing::HasSubstr("parts are missing"));

  const std::string second = submit();
  test::wait_until([&] { return in_queue() == 0; });
  EXPECT_THAT(slurm("scontrol show job " + second).output,
              testing::Not(testing::HasSubstr("JobState=FAILED")));
  const CommandResult merged = slurm("haptrial power merge array");
  ASSERT_EQ(merged.status, 0) << merged.errors << slurm("cat slurm-*.out").output;
  EXPECT_EQ(result_of("array"), result_of("alone"));
}

}  // namespace
}  // namespace haptrial::experiments::slurm_test
