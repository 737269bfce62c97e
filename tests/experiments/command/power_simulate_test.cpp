// haptrial power simulate, merge, status and plan as their users meet them: what they print, their
// exit status, and what they leave behind.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::read_text;
using test::run_command;
using test::write_text;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kWatch = "watch = \"planned: visuohaptic < visual, paired t\"\n";
constexpr const char* kParts = R"([power.responses]
mean = 2.0
participant = 0.2
interaction = 0.3
block = 0.3
trial = 0.5
[power.responses.effects]
visuohaptic = 0.0
)";
constexpr const char* kVary = R"([[power.vary]]
key = "design.participants"
values = [3]
[[power.vary]]
key = "power.responses.effects.visuohaptic"
values = [-0.5]
none = 0.0
)";

class PowerSimulateTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }

  /// A question about the shipped study; two cells.
  std::string question(const std::string& name, const std::string& rest) const {
    write_text(folder_ / name,
               "[power]\ndefinition = \"" + test::shipped_definition().string() + "\"\n" + rest);
    return path(name);
  }
  std::string quick(const std::string& name = "power.toml", int replications = 4,
                    int block = 1) const {
    return question(name, std::string(kWatch) + "replications = " + std::to_string(replications) +
                              "\nnull_replications = " + std::to_string(replications) +
                              "\nblock = " + std::to_string(block) + "\n" + kParts + kVary);
  }
  CommandResult power(const std::string& arguments) const {
    return run_command("haptrial power " + arguments);
  }
  void simulate_quick(const std::string& out) const {
    const CommandResult done = power("simulate " + quick() + " --out " + path(out));
    ASSERT_EQ(done.status, 0) << done.errors;
  }
  /// Exit status 2, one sentence on standard error, nothing on standard output, nothing left.
  void expect_bad_input(const std::string& arguments, const std::string& sentence) const {
    const std::vector<std::string> before = entries();
    const CommandResult result = power(arguments);
    EXPECT_EQ(result.status, 2) << arguments << "\n" << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << arguments;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_EQ(entries(), before) << arguments;
  }
  std::vector<std::string> entries() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      all.push_back(entry.path().string());
    }
    std::sort(all.begin(), all.end());
    return all;
  }
  test::TemporaryFolder folder_;
};

TEST_F(PowerSimulateTest, FromAQuestionToAReport) {
  const CommandResult done = power("simulate " + quick() + " --jobs 2 --out " + path("out"));
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_EQ(done.errors, "");
  EXPECT_THAT(done.output, HasSubstr("8 of 8 parts were made in "));
  EXPECT_THAT(done.output, HasSubstr("SIMULATED: Without an effect the test "));
  for (const char* file : {"report.html", "report.md", "power.csv", "power.json", "power.svg"}) {
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
  }
  const std::string json = read_text(folder_ / "out/power.json");
  EXPECT_THAT(power("status " + path("out")).output, HasSubstr("8 of 8 parts (100.0 %)\n"));
  fs::remove(folder_ / "out/power.json");
  EXPECT_EQ(power("merge " + path("out")).status, 0);
  EXPECT_EQ(read_text(folder_ / "out/power.json"), json);
  // The same command again: nothing to make.
  EXPECT_THAT(power("simulate " + quick() + " --out " + path("out")).output,
              HasSubstr("0 of 8 parts were made"));
}

TEST_F(PowerSimulateTest, SharesGoOnWhereOthersStopped) {
  const std::string question = quick();
  const CommandResult first = power("simulate " + question + " --part 1/2 --out " + path("out"));
  ASSERT_EQ(first.status, 0) << first.errors;
  EXPECT_THAT(first.output, HasSubstr("4 parts are missing; next: haptrial power status "));
  EXPECT_THAT(power("status " + path("out")).output, HasSubstr("4 of 8 parts (50.0 %)\n"));
  expect_bad_input("merge " + path("out"), "4 of 8 parts are missing; simulate again");
  const CommandResult late =
      power("simulate " + question + " --part 2/2 --minutes 0 --out " + path("out"));
  EXPECT_EQ(late.status, 0) << late.errors;
  EXPECT_THAT(late.output, HasSubstr("4 parts are missing"));
  EXPECT_EQ(power("simulate " + question + " --part 2/2 --out " + path("out")).status, 0);
  EXPECT_EQ(power("merge " + path("out")).status, 0);
  ASSERT_EQ(power("simulate " + question + " --out " + path("whole")).status, 0);
  EXPECT_EQ(read_text(folder_ / "out/power.json"), read_text(folder_ / "whole/power.json"));
}

TEST_F(PowerSimulateTest, HelpsShowExamplesAndThePage) {
  for (const char* name : {"simulate", "merge", "status", "plan"}) {
    const std::string help = power(std::string(name) + " --help").output;
    EXPECT_THAT(help, HasSubstr("\nExample:\n  haptrial power " + std::string(name))) << name;
    EXPECT_THAT(help, HasSubstr("guide-power.md")) << name;
  }
}

TEST_F(PowerSimulateTest, BashCompletesSubcommandsAndOptions) {
  const std::string source = "source '" HAPTRIAL_SOURCE_DIR "/experiments/completion.bash'\n";
  EXPECT_EQ(run_command(source + "COMP_WORDS=(haptrial power s) COMP_CWORD=2; _haptrial; "
                                 "echo ${COMPREPLY[@]}")
                .output,
            "simulate status\n");
  EXPECT_EQ(run_command(source + "COMP_WORDS=(haptrial power simulate --m) COMP_CWORD=3; "
                                 "_haptrial; echo ${COMPREPLY[@]}")
                .output,
            "--minutes\n");
}

TEST_F(PowerSimulateTest, TheBatchScriptNamesTheQuestionAsItIs) {
  const std::string question = quick("it's mine.toml");
  const CommandResult plan = run_command("cd " + path("") +
                                         "; haptrial power plan \"it's mine.toml\""
                                         " --out \"her folder\" --tasks 3 --script plan.sbatch");
  ASSERT_EQ(plan.status, 0) << plan.errors;
  EXPECT_THAT(plan.output, HasSubstr("8 parts of about "));
  EXPECT_THAT(read_text(folder_ / "plan.sbatch"), HasSubstr("#SBATCH --array=1-3\n"));
  // The signal goes to the script itself, which the program has become by exec.
  EXPECT_THAT(read_text(folder_ / "plan.sbatch"), HasSubstr("#SBATCH --signal=B:TERM@60\n"));
  // The command that Slurm runs, three times: the last task makes what was missing.
  const CommandResult tasks =
      run_command("cd " + path("") +
                  "; mkdir bin; ln -s \"$HAPTRIAL\" bin/haptrial; PATH=$PWD/bin:$PATH; "
                  "for i in 1 2 3; do SLURM_ARRAY_TASK_ID=$i bash plan.sbatch || exit; done; "
                  "\"$HAPTRIAL\" power merge 'her folder'");
  EXPECT_EQ(tasks.status, 0) << tasks.errors;
  EXPECT_TRUE(fs::exists(folder_ / "her folder/report.html"));
}

TEST_F(PowerSimulateTest, MistakesGetASentence) {
  const std::string out = " --out " + path("out");
  const auto bad = [&](const std::string& rest, const std::string& sentence) {
    expect_bad_input("simulate " + question("power.toml", rest) + out, sentence);
  };
  question("power.toml", "");
  bad(std::string("watch = \"sign test\"\n") + kParts + kVary,
      "power.toml: power.watch is \"sign test\", which a first study could not make; made, and "
      "allowed: \"condition: ");
  std::string huge;
  for (const char* name : {"mean", "participant", "trial"}) {
    huge += "[[power.vary]]\nkey = \"power.responses." + std::string(name) + "\"\nvalues = [";
    for (int i = 0; i < 1000; ++i) {
      huge += std::to_string(i) + ", ";
    }
    huge += "]\n";
  }
  bad(std::string(kWatch) + kParts + huge, "power.vary has 1e+09 cells; allowed: at most 10000");
  bad(std::string(kWatch) + kParts + kVary +
          "[[power.vary]]\nkey = \"power.responses.participant\"\nvalues = [0.0]\n"
          "[[power.vary]]\nkey = \"power.responses.interaction\"\nvalues = [0.0]\n",
      "do not differ from each other");
  bad(std::string("watch = 3\n") + kParts + kVary, "power.toml:3: power.watch is 3");
  bad(std::string(kWatch) + "[[power.vary]]\nkey = \"design.participants\"\nvalues = [3]\n",
      "power.toml: power.responses is missing; give mean, participant, ");
}

TEST_F(PowerSimulateTest, AMistakeInTheResponsesNamesItsOwnFileAndLine) {
  const std::string out = " --out " + path("out");
  question("power.toml", "");
  std::string parts = kParts;
  parts.replace(parts.find("trial = 0.5"), 11, "trial = -0.5");
  expect_bad_input("simulate " + question("power.toml", kWatch + parts + kVary) + out,
                   "power.toml:9: power.responses.trial is -0.5");
  parts = kParts;
  parts.replace(parts.find("block = 0.3\n"), 12, "");
  expect_bad_input("simulate " + question("power.toml", kWatch + parts + kVary) + out,
                   "power.toml:4: power.responses.block is missing");
  write_text(folder_ / "met.toml",
             "[power]\ndefinition = \"" HAPTRIAL_SOURCE_DIR
             "/experiments/stiffness_discrimination.toml\"\nwatch = \"drift over the trials\"\n"
             "\n[power.responses]\nmet = \"$stifness\"\n[[power.vary]]\n"
             "key = \"design.participants\"\nvalues = [3]\n");
  expect_bad_input("simulate " + path("met.toml") + out, "met.toml:6: power.responses.met is");
}

TEST_F(PowerSimulateTest, BadArgumentsGetASentence) {
  const std::string simulate = "simulate " + quick() + " --out " + path("out");
  for (const char* part : {"3/2", "0/2", "1", "1/", "/2", "1/2/3", "1/-2", "a/b"}) {
    expect_bad_input(simulate + " --part " + part, "--part is '" + std::string(part) + "'");
  }
  expect_bad_input(simulate + " --jobs 0", "--jobs is 0");
  expect_bad_input(simulate + " --minutes -1", "--minutes is -1");
  expect_bad_input("simulate " + path("none.toml"), "none.toml");
  expect_bad_input("simulate " + ("'" + test::shipped_definition().string() + "'"),
                   "has no table [power]");
  expect_bad_input("plan " + quick() + " --out " + path("out") + " --tasks 0", "--tasks is 0");
  expect_bad_input("plan " + quick() + " --out " + path("out") + " --hours 0", "--hours is 0");
  expect_bad_input("status " + path("power.toml"), "is no folder of a simulation of power");
  expect_bad_input("merge " + path(""), "is no folder of a simulation of power");
}

TEST_F(PowerSimulateTest, PartsOfAnotherDefinitionOrVersionAreRefused) {
  simulate_quick("out");
  const std::string other = quick("other.toml", 5);
  expect_bad_input("simulate " + other + " --out " + path("out"),
                   "holds parts of another definition; choose a new folder");
  ASSERT_EQ(power("simulate " + other + " --out " + path("other")).status, 0);
  fs::copy_file(folder_ / "other/parts/r-00001-0000002.part",
                folder_ / "out/parts/r-00001-0000002.part", fs::copy_options::overwrite_existing);
  expect_bad_input("merge " + path("out"), "r-00001-0000002.part: has question");
  write_text(folder_ / "out/parts/r-00001-0000002.part", "torn");
  expect_bad_input("merge " + path("out"), "r-00001-0000002.part: is damaged");
  write_text(folder_ / "out/program", "haptrial 0.0.9 (0123456789ab)\n");
  for (const std::string& command : {"merge " + path("out"), "status " + path("out"),
                                     "simulate " + quick() + " --out " + path("out")}) {
    expect_bad_input(command, "was simulated by haptrial 0.0.9 (0123456789ab), and this is ");
  }
}

TEST_F(PowerSimulateTest, AFolderWithoutPermissionGetsASentence) {
  // For root the permission bits say nothing; /proc refuses everybody.
  expect_bad_input("simulate " + quick() + " --out /proc/power", "/proc/power: cannot be made");
  expect_bad_input("plan " + quick() + " --out /proc/power", "/proc/power.sbatch");
  fs::create_directory(folder_ / "full");
  write_text(folder_ / "full/diary.txt", "mine");
  expect_bad_input("simulate " + quick() + " --out " + path("full"), "holds something else");
  expect_bad_input("simulate " + quick() + " --out " + path("power.toml"), "holds something else");
}

TEST_F(PowerSimulateTest, AFullDiskGetsASentenceAndLosesNothing) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "the sanitizer keeps files of its own, which the limit breaks";
  }
  // Room for the question (7 kB), and not for a part of 100 replications.
  const std::string question = quick("power.toml", 100, 100);
  const std::string simulate = "haptrial power simulate " + question + " --jobs 1 --out ";
  const CommandResult full = run_command("trap '' XFSZ; ulimit -f 12; " + simulate + path("out"));
  EXPECT_EQ(full.status, 1) << full.output;
  EXPECT_THAT(full.errors, HasSubstr(".part: could not be written whole"));
  EXPECT_EQ(std::count(full.errors.begin(), full.errors.end(), '\n'), 1) << full.errors;
  EXPECT_TRUE(fs::is_empty(folder_ / "out/parts")) << "nothing half-written";
  EXPECT_FALSE(fs::exists(folder_ / "out/report.html"));
  const CommandResult again = run_command(simulate + path("out"));
  EXPECT_EQ(again.status, 0) << again.errors;
  EXPECT_THAT(again.output, HasSubstr("2 of 2 parts were made"));
  // A disk that is full from the beginning.
  const CommandResult none = run_command("trap '' XFSZ; ulimit -f 1; " + simulate + path("none"));
  EXPECT_EQ(none.status, 1) << none.output;
  EXPECT_EQ(std::count(none.errors.begin(), none.errors.end(), '\n'), 1) << none.errors;
  EXPECT_FALSE(fs::exists(folder_ / "none/question.toml"));
}

TEST_F(PowerSimulateTest, AnInterruptKeepsWhatIsDone) {
  const std::string question = quick("power.toml", 2000, 20);
  const CommandResult cut =
      run_command("\"$HAPTRIAL\" power simulate " + question + " --jobs 1 --out " + path("out") +
                  " & until ls " + path("out/parts") +
                  "/*.part > /dev/null 2>&1; do sleep 0.05; done; kill -INT $!; wait $!");
  EXPECT_EQ(cut.status, 1) << cut.output;
  EXPECT_THAT(cut.errors, HasSubstr("parts are missing, and the same command goes on"));
  for (const auto& entry : fs::directory_iterator(folder_ / "out/parts")) {
    EXPECT_EQ(entry.path().extension(), ".part");
  }
}

}  // namespace
}  // namespace haptrial
