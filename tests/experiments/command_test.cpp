// The command as its users meet it: what it prints, its exit status, and what it leaves behind.

#include "tests/experiments/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/record/read/session_reader.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;
using testing::Not;

class CommandTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }
  std::string shipped() const { return "'" + test::shipped_definition().string() + "'"; }
  CommandResult brief_study(const std::string& name, const std::string& more = "") const {
    return run_command("haptrial dry-run " + shipped() + " --trials 3 --out " + path(name) + " " +
                       more);
  }
  /// Exit status 2, one sentence on standard error, nothing on standard output, nothing left.
  void expect_bad_input(const std::string& line, const std::string& sentence) const {
    const std::size_t before = entries();
    const CommandResult result = run_command(line);
    EXPECT_EQ(result.status, 2) << line << "\n" << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << line;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.output, "") << line;
    EXPECT_EQ(entries(), before) << line;
  }
  std::size_t entries() const {
    const fs::recursive_directory_iterator all(folder_.path());
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
  test::TemporaryFolder folder_;
};

TEST_F(CommandTest, HelpShowsAnExampleOfEverySubcommand) {
  for (const char* name : {"examples", "new", "doctor", "dry-run", "run", "analyze", "export",
                           "info", "validate", "devices", "device-test"}) {
    const CommandResult help = run_command(std::string("haptrial ") + name + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.output, HasSubstr(std::string("Example:\n  haptrial ") + name));
  }
  EXPECT_THAT(run_command("haptrial --version").output,
              testing::AllOf(HasSubstr("haptrial 0."), HasSubstr("\nEigen 3."),
                             HasSubstr("HDF5 1."), HasSubstr("GSL 2."), HasSubstr("SUNDIALS ")));
}

TEST_F(CommandTest, StudyFromDefinitionToReport) {
  const CommandResult dry = brief_study("study", "--subjects 3");
  ASSERT_EQ(dry.status, 0) << dry.errors;
  EXPECT_THAT(dry.output, HasSubstr("3 sessions"));
  EXPECT_EQ(dry.errors, "") << "no progress line where there is no terminal";
  const CommandResult info = run_command("haptrial info " + path("study/S02.h5"));
  EXPECT_EQ(info.status, 0) << info.output;
  EXPECT_THAT(info.output, HasSubstr("0 gaps"));
  EXPECT_THAT(info.output, HasSubstr("S02 (simulated)"));
  const CommandResult analysis = run_command("haptrial analyze " + path("study"));
  ASSERT_EQ(analysis.status, 0) << analysis.errors;
  for (const char* name : {"scores.csv", "statistics.json", "report.html"}) {
    EXPECT_GT(fs::file_size(folder_ / "study" / name), 100u) << name;
  }
  const std::string scores = test::read_text(folder_ / "study" / "scores.csv");
  EXPECT_EQ(std::count(scores.begin(), scores.end(), '\n'), 1 + 3 * 3);
}

TEST_F(CommandTest, SameSeedSameBytesWhateverTheJobs) {
  std::map<std::string, std::string> scores;
  for (const auto& [name, options] : std::map<std::string, std::string>{
           {"one", "--jobs 1"}, {"two", "--jobs 2"}, {"other", "--jobs 2 --seed 5"}}) {
    ASSERT_EQ(brief_study(name, "--subjects 4 " + options).status, 0);
    ASSERT_EQ(run_command("haptrial analyze " + path(name)).status, 0);
    scores[name] = test::read_text(folder_ / name / "scores.csv");
  }
  EXPECT_EQ(scores["one"], scores["two"]);
  EXPECT_NE(scores["one"], scores["other"]);
}

TEST_F(CommandTest, FramesAreWritten) {
  const CommandResult dry = brief_study("study", "--subjects 1 --frames 2");
  ASSERT_EQ(dry.status, 0) << dry.errors;
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "study" / "frames")) {
    pictures += entry.path().extension() == ".png" ? 1 : 0;
  }
  EXPECT_EQ(pictures, 3 * 2 * 2) << "trials x passes x frames";
}

/// OSMesa brings LLVM, which takes longer to load than most commands run: a command that draws
/// nothing does without them. That pictures are drawn is FramesAreWritten's.
TEST_F(CommandTest, WhatDrawsIsLoadedOnlyToDraw) {
  const CommandResult linked = run_command("ldd \"$HAPTRIAL\"");
  EXPECT_THAT(linked.output, HasSubstr("libhdf5"));
  EXPECT_THAT(linked.output, Not(HasSubstr("libOSMesa")));
  EXPECT_THAT(linked.output, Not(HasSubstr("libLLVM")));
}

TEST_F(CommandTest, ValidateAndDevices) {
  const CommandResult valid = run_command("haptrial validate " + shipped());
  EXPECT_EQ(valid.status, 0);
  EXPECT_THAT(valid.output, HasSubstr("12 participants, 72 trials in 24 blocks of 3"));
  EXPECT_THAT(valid.output, HasSubstr(" minutes per participant, breaks and pages not counted\n"));
  EXPECT_THAT(
      run_command("haptrial devices").output,
      testing::AllOf(HasSubstr("virtual"), HasSubstr("\nrdt              force-torque sensors")));
}

/// The level of the standard of another study would give Weber fractions that mean nothing.
TEST_F(CommandTest, ValidateWarnsOfAReferenceFarFromTheLevels) {
  const auto said_of = [this](const std::string& reference) {
    const std::string study = (folder_ / "study.toml").string();
    fs::copy_file(HAPTRIAL_SOURCE_DIR "/experiments/force_discrimination.toml", study,
                  fs::copy_options::overwrite_existing);
    EXPECT_EQ(run_command("haptrial set " + study + " analysis.reference " + reference).status, 0);
    const CommandResult said = run_command("haptrial validate " + study);
    EXPECT_EQ(said.status, 0) << said.errors;
    return said.output + said.errors;
  };
  EXPECT_THAT(said_of("300.0"), HasSubstr("analysis.reference (300) lies outside of the levels"));
  EXPECT_THAT(said_of("2.0"), testing::Not(HasSubstr("lies outside")));
}

TEST_F(CommandTest, SetSaysThatADefinitionIsNotValidAnyMore) {
  const std::string study = (folder_ / "study.toml").string();
  fs::copy_file(HAPTRIAL_SOURCE_DIR "/experiments/force_discrimination.toml", study);
  const CommandResult odd = run_command("haptrial set " + study + " procedure.stepp 2");
  EXPECT_EQ(odd.status, 0) << "a change in several steps may pass through it";
  EXPECT_THAT(odd.errors, testing::AllOf(HasSubstr("procedure.stepp is not a known key"),
                                         HasSubstr("is written, and is not valid any more")));
  const CommandResult mended = run_command("haptrial set " + study + " procedure.stepp --remove");
  EXPECT_EQ(mended.errors, "");
}

TEST_F(CommandTest, SetLeavesToALabFileWhatStandsThere) {
  const std::string study = (folder_ / "study.toml").string();
  const std::string lab = (folder_ / "lab.toml").string();
  fs::copy_file(HAPTRIAL_SOURCE_DIR "/experiments/force_discrimination.toml", study);
  std::ofstream(study, std::ios::app) << "\n[lab]\nuse = \"lab.toml\"\n";
  std::ofstream(lab) << "[screen]\nmonitor = 0\n";
  const CommandResult refused = run_command("haptrial set " + study + " screen.monitor 1");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("change it there: haptrial set " + lab));
  EXPECT_EQ(run_command("haptrial set " + lab + " screen.monitor 1").errors, "");
  EXPECT_EQ(run_command("haptrial set " + study + " pedal.port '\"/dev/ttyUSB0\"'").status, 0)
      << "a table that the lab file lacks may stand in the definition";
}

TEST_F(CommandTest, BashCompletesSubcommandsAndOptions) {
  const std::string source = "source '" HAPTRIAL_SOURCE_DIR "/experiments/completion.bash'\n";
  const CommandResult names =
      run_command(source + "COMP_WORDS=(haptrial d) COMP_CWORD=1; _haptrial; echo ${COMPREPLY[@]}");
  EXPECT_EQ(names.output, "doctor dry-run devices device-test deform\n");
  const CommandResult options = run_command(
      source + "COMP_WORDS=(haptrial dry-run --se) COMP_CWORD=2; _haptrial; echo ${COMPREPLY[@]}");
  EXPECT_EQ(options.output, "--seed --session --set --setup\n");
  const CommandResult nested = run_command(
      source + "COMP_WORDS=(haptrial rate i) COMP_CWORD=2; _haptrial; echo ${COMPREPLY[@]}");
  EXPECT_EQ(nested.output, "import\n");
  const CommandResult deform = run_command(
      source + "COMP_WORDS=(haptrial deform s) COMP_CWORD=2; _haptrial; echo ${COMPREPLY[@]}");
  EXPECT_EQ(deform.output, "simulate skin\n");
  const CommandResult nested_options = run_command(
      source +
      "COMP_WORDS=(haptrial rate import --st) COMP_CWORD=3; _haptrial; echo ${COMPREPLY[@]}");
  EXPECT_EQ(nested_options.output, "--study\n");
}

/// The names below "Subcommands:" in a help.
std::vector<std::string> subcommands_of(const std::string& line) {
  std::istringstream help(run_command(line + " --help").output);
  std::vector<std::string> names;
  bool listed = false;
  for (std::string row; std::getline(help, row);) {
    if (listed && row.starts_with("  ") && row[2] != ' ') {
      names.push_back(row.substr(2, row.find(' ', 2) - 2));
    }
    listed = listed ? !row.empty() : row == "Subcommands:";
  }
  return names;
}

TEST_F(CommandTest, EverySubcommandShowsAnExampleOfItself) {
  std::vector<std::string> lines;
  for (const std::string& name : subcommands_of("haptrial")) {
    lines.push_back("haptrial " + name);
    for (const std::string& sub : subcommands_of("haptrial " + name)) {
      lines.push_back("haptrial " + name + " " + sub);
    }
  }
  EXPECT_GT(lines.size(), 25u);
  for (const std::string& line : lines) {
    const std::string help = run_command(line + " --help").output;
    EXPECT_THAT(help, HasSubstr("\nExample:\n  " + line)) << line;
  }
}

TEST_F(CommandTest, PicturesThatADryRunDoesNotDrawAreSaidToBeNone) {
  const CommandResult some = brief_study("some", "--subjects 1 --frames 1");
  EXPECT_THAT(some.output, HasSubstr("pictures: " + (folder_ / "some/frames").string()));
  const CommandResult none =
      run_command("haptrial dry-run '" HAPTRIAL_SOURCE_DIR "/experiments/wall_detection.toml' " +
                  ("--subjects 1 --trials 2 --frames 1 --out " + path("none")));
  EXPECT_EQ(none.status, 0) << none.errors;
  EXPECT_THAT(none.output, HasSubstr("pictures: none"));
  EXPECT_THAT(none.output, HasSubstr("haptrial replay"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none/frames"));
}

TEST_F(CommandTest, BadArguments) {
  expect_bad_input("haptrial", "subcommand");
  expect_bad_input("haptrial bone",
                   "haptrial bone needs a subcommand; allowed: import, atlas, info");
  expect_bad_input("haptrial bone pictur x", "'pictur' is not a subcommand of haptrial bone");
  expect_bad_input("haptrial dryrun x.toml", "dryrun");
  expect_bad_input("haptrial dry-run", "DEFINITION");
  expect_bad_input("haptrial dry-run " + shipped() + " --subjects 0 --out " + path("o"),
                   "--subjects is 0; allowed: a whole number from 1");
  expect_bad_input("haptrial dry-run " + shipped() + " --subjects many --out " + path("o"), "many");
  expect_bad_input("haptrial dry-run " + shipped() + " --jobs 1000 --out " + path("o"),
                   "--jobs is 1000; allowed: a whole number from 1 to 256");
  expect_bad_input("haptrial dry-run " + shipped() + " --seed -1 --out " + path("o"),
                   "--seed is '-1'; allowed: a whole number from 0 to");
  expect_bad_input(
      "haptrial dry-run " + shipped() + " --seed 99999999999999999999 --out " + path("o"),
      "--seed is '99999999999999999999'; allowed");
  expect_bad_input("haptrial dry-run " + shipped() + " --trials 73 --out " + path("o"),
                   "--trials is 73");
  expect_bad_input("haptrial run " + shipped() + " --subject ../../evil1 --out " + path("o"),
                   "--subject is '../../evil1'; allowed");
  expect_bad_input("haptrial run " + shipped() + " --subject Anna --out " + path("o"),
                   "add --participant NUMBER");
  expect_bad_input("haptrial run " + shipped() + " --subject P1 --device omega --out " + path("o"),
                   "--device is 'omega'; allowed: virtual");
}

TEST_F(CommandTest, BadDefinitions) {
  test::write_text(folder_ / "empty.toml", "");
  expect_bad_input("haptrial dry-run " + path("empty.toml") + " --out " + path("o"),
                   "the definition is empty");
  expect_bad_input("haptrial validate " + path("."), "is a directory");
  expect_bad_input("haptrial validate " + path("absent.toml"), "no such file");
  expect_bad_input(
      "haptrial run " + shipped() + " --subject P1 --device replay: --out " + path("o"),
      "--device replay: names no file; write replay:FILE");
  test::write_text(folder_ / "gains.toml", test::shipped_with("stiffness", "stiffness = nan"));
  expect_bad_input("haptrial dry-run " + path("gains.toml") + " --out " + path("o"),
                   "hand.stiffness is nan");
}

TEST_F(CommandTest, BadSessionFiles) {
  expect_bad_input("haptrial info " + path("absent.h5"), "absent.h5");
  expect_bad_input("haptrial info " + path("."), folder_.path().string());
  expect_bad_input("haptrial analyze " + path("."), "holds no session file");
  expect_bad_input("haptrial analyze " + path("absent"), "no such folder");
  fs::create_directory(folder_ / "unfinished");
  test::write_text(folder_ / "unfinished" / "Z1.h5.partial", "");
  expect_bad_input("haptrial analyze " + path("unfinished"),
                   "holds only unfinished sessions: Z1.h5.partial; resume them");
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  expect_bad_input("haptrial validate " + path("study/S01.h5"),
                   "S01.h5: is a session file; give a definition (.toml)");
  expect_bad_input("haptrial rate simulate " + path("study"),
                   "S01.h5: is not a drilling session; choose a folder");
  EXPECT_THAT(run_command("haptrial info " + path("study/S01.h5")).output,
              HasSubstr("0 overruns, 0 lost records"));
  const std::string whole = test::read_text(folder_ / "study" / "S01.h5");
  fs::create_directory(folder_ / "cut");
  test::write_text(folder_ / "cut" / "S01.h5", whole.substr(0, whole.size() / 2));
  expect_bad_input("haptrial info " + path("cut/S01.h5"), "S01.h5");
  expect_bad_input("haptrial analyze " + path("cut"), "S01.h5");
}

TEST_F(CommandTest, NothingIsOverwritten) {
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  const std::string before = test::read_text(folder_ / "study" / "S01.h5");
  expect_bad_input("haptrial dry-run " + shipped() + " --subjects 1 --out " + path("study"),
                   "study: exists already; choose a new folder");
  EXPECT_EQ(test::read_text(folder_ / "study" / "S01.h5"), before);
}

TEST_F(CommandTest, OfTwoRunsIntoOneFolderOneIsRefused) {
  for (int attempt = 0; attempt < 5; ++attempt) {
    const std::string out = path("tw" + std::to_string(attempt));
    const std::string dry =
        "\"$HAPTRIAL\" dry-run " + shipped() + " --subjects 1 --trials 3 --out " + out;
    const CommandResult both =
        run_command(dry + " & a=$!; " + dry + " & b=$!; wait $a; x=$?; wait $b; echo $((x + $?))");
    EXPECT_THAT(both.output, HasSubstr("\n2\n")) << both.output << both.errors;
    EXPECT_TRUE(fs::exists(folder_ / ("tw" + std::to_string(attempt)) / "S01.h5"));
  }
}

TEST_F(CommandTest, OneIsCountedInTheSingular) {
  EXPECT_THAT(brief_study("study", "--subjects 1").output, testing::StartsWith("1 session, "));
}

TEST_F(CommandTest, AnIncompleteStudySaysSo) {
  ASSERT_EQ(brief_study("study", "--subjects 2").status, 0);
  fs::rename(folder_ / "study" / "S02.h5", folder_ / "study" / "S02.h5.partial");
  const CommandResult analysis = run_command("haptrial analyze " + path("study"));
  EXPECT_EQ(analysis.status, 0) << analysis.errors;
  const std::string report = test::read_text(folder_ / "study" / "report.html");
  for (const char* remark :
       {"1 of 12 planned participants has a session in this folder.", "S02.h5.partial"}) {
    EXPECT_THAT(analysis.output, HasSubstr(remark));
    EXPECT_THAT(report, HasSubstr(remark));
  }
}

TEST_F(CommandTest, AnInterruptedSessionKeepsItsPass) {
  test::LiveCommand session("run " + shipped() + " --subject P01 --out " + path("o"));
  ASSERT_TRUE(session.reaches([&] {
    try {
      const record::SessionReader reader(folder_ / "o/P01.h5.partial");
      const std::uint64_t rows = reader.sample_count();
      return rows > 0 && reader.samples(rows - 1, 1)[0].pass == 0;
    } catch (const std::exception&) {  // not there yet
      return false;
    }
  })) << session.errors();
  session.signal(SIGINT);
  const CommandResult result = session.wait();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("P01.h5.partial"));
  const CommandResult info = run_command("haptrial info " + path("o/P01.h5.partial"));
  EXPECT_EQ(info.status, 1) << "it can be resumed, so it is not complete";
  EXPECT_THAT(info.output, HasSubstr("passes      1, 1 aborted"));
  EXPECT_THAT(info.output, HasSubstr("interrupted"));
}

TEST_F(CommandTest, StandardOutputThatIsFullIsAFailure) {
  const CommandResult result = run_command("haptrial validate " + shipped() + " >/dev/full");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("standard output cannot be written"));
}

TEST_F(CommandTest, AFileInPlaceOfTheFolder) {
  test::write_text(folder_ / "file", "mine");
  expect_bad_input("haptrial dry-run " + shipped() + " --out " + path("file"), "file: exists");
  expect_bad_input("haptrial dry-run " + shipped() + " --out " + path("file/below"),
                   "the folder cannot be created");
  EXPECT_EQ(test::read_text(folder_ / "file"), "mine");
}

TEST_F(CommandTest, MixedStudiesAreRefused) {
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  test::write_text(folder_ / "other.toml", test::shipped_with("range_z", "range_z = 0.05"));
  ASSERT_EQ(run_command("haptrial dry-run " + path("other.toml") +
                        " --subjects 2 --trials 3 --out " + path("other"))
                .status,
            0);
  fs::rename(folder_ / "other" / "S02.h5", folder_ / "study" / "S02.h5");
  expect_bad_input("haptrial analyze " + path("study"),
                   "S02.h5: was recorded with another definition than " +
                       (folder_ / "study/S01.h5").string() +
                       ": trajectory.range_z was 0.06, is 0.05;");
}

TEST_F(CommandTest, NoTrialsAreNotAllTrials) {
  for (const char* number : {"0", "73", "-1"}) {
    expect_bad_input(
        "haptrial dry-run " + shipped() + " --out " + path("none") + " --trials " + number,
        "--trials is " + std::string(number) + "; allowed: a whole number from 1 to 72");
    expect_bad_input(
        "haptrial run " + shipped() + " --subject S01 --out " + path("none") + " --trials " +
            number,
        "--trials is " + std::string(number) + "; allowed: a whole number from 1 to 72");
  }
}

TEST_F(CommandTest, TextsAndCommentsMayChangeWithinAStudyAndTheReportSaysSo) {
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  std::string text = test::shipped_text();
  const std::string pause = "Time for a rest";
  text.replace(text.find(pause), pause.size(), "Time, for a rest");
  test::write_text(folder_ / "other.toml", text + "\n# a comment\n");
  ASSERT_EQ(run_command("haptrial dry-run " + path("other.toml") +
                        " --subjects 2 --trials 3 --out " + path("other"))
                .status,
            0);
  fs::rename(folder_ / "other" / "S02.h5", folder_ / "study" / "S02.h5");
  const CommandResult result = run_command("haptrial analyze " + path("study"));
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(
      result.output,
      HasSubstr("S02.h5 was recorded with a changed definition: texts.rest was \"Time for a rest"));
  EXPECT_THAT(test::read_text(folder_ / "study/report.md"), HasSubstr("texts.rest"));
  const CommandResult exported =
      run_command("haptrial export --bids " + path("bids") + " " + path("study"));
  EXPECT_EQ(exported.status, 0) << exported.errors;
  EXPECT_EQ(test::read_text(folder_ / "bids/code/forcetraining.toml"), test::shipped_text());
  EXPECT_EQ(test::read_text(folder_ / "bids/code/forcetraining-2.toml"), text + "\n# a comment\n");
}

TEST_F(CommandTest, SessionsOfAnotherGainAreRefusedAndNamed) {
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  test::write_text(folder_ / "other.toml", test::shipped_with("base_max", "base_max = 9.0"));
  ASSERT_EQ(run_command("haptrial dry-run " + path("other.toml") +
                        " --subjects 2 --trials 3 --out " + path("other"))
                .status,
            0);
  fs::rename(folder_ / "other" / "S02.h5", folder_ / "study" / "S02.h5");
  const std::string sentence = "force_pattern.base_max was 10, is 9";
  expect_bad_input("haptrial analyze " + path("study"), sentence);
  expect_bad_input("haptrial export --bids " + path("bids") + " " + path("study"), sentence);
}

TEST_F(CommandTest, AFullDiskGetsASentenceAndLeavesNothing) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "the sanitizer keeps files of its own, which the limit breaks";
  }
  // A limit on the size of files does what a full disk does, and needs no privilege.
  const CommandResult result = run_command("trap '' XFSZ; ulimit -f 300; haptrial dry-run " +
                                           shipped() + " --subjects 2 --out " + path("full"));
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_THAT(result.errors, HasSubstr("haptrial: "));
  EXPECT_FALSE(fs::exists(folder_ / "full")) << "nothing half-written";
}

TEST_F(CommandTest, ASecretOrARosterThatWasNotWrittenLeavesNoFile) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "the sanitizer keeps files of its own, which the limit breaks";
  }
  // Sentences go through a pipe, since no file takes a byte.
  const auto on_full_disk = [](const std::string& line) {
    return run_command("{ (trap '' XFSZ; ulimit -f 0; haptrial " + line +
                       "; echo status $?) 2>&1; } | cat");
  };
  EXPECT_THAT(on_full_disk("secret " + path("secret")).output,
              AllOf(HasSubstr("the secret cannot be written"), HasSubstr("status 1")));
  EXPECT_FALSE(fs::exists(folder_ / "secret"));
  EXPECT_THAT(
      on_full_disk("roster " + shipped() + " " + path("none") + " --json " + path("r.json")).output,
      AllOf(HasSubstr("r.json"), HasSubstr("status 1")));
  EXPECT_FALSE(fs::exists(folder_ / "r.json"));
  EXPECT_EQ(run_command("haptrial secret " + path("secret")).status, 0) << "the next try";
}

TEST_F(CommandTest, AReadOnlyFolderGetsASentence) {
  // For root the permission bits say nothing; /proc refuses everybody.
  expect_bad_input("haptrial dry-run " + shipped() + " --out /proc/study", "/proc/study");
}

TEST_F(CommandTest, AnInterruptStopsAtOnceAndLeavesNothing) {
  const CommandResult result = run_command(
      "\"$HAPTRIAL\" dry-run " + shipped() + " --jobs 1 --out " + path("cut") + " & until ls " +
      path("cut") + "/*.partial > /dev/null 2>&1; do sleep 0.05; done; kill -INT $!; wait $!");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors,
              HasSubstr("interrupted; no session is kept. With --parts FOLDER finished ones are"));
  EXPECT_FALSE(fs::exists(folder_ / "cut"));
}

TEST_F(CommandTest, AnInterruptedReplayLeavesNoPictures) {
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  const CommandResult result =
      run_command("\"$HAPTRIAL\" replay " + path("study/S01.h5") + " --trial 1 --frames " +
                  path("seen") + " --fps 240 & until ls " + path("seen") +
                  "/*.png > /dev/null 2>&1; do sleep 0.02; done; kill -INT $!; wait $!");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("interrupted; nothing was written"));
  EXPECT_FALSE(fs::exists(folder_ / "seen"));
}

TEST_F(CommandTest, ASubjectWhoHasASessionIsNamedWithWhatToDo) {
  const std::string run = "haptrial run " + shipped() + " --subject P01 --out " + path("sessions");
  fs::create_directory(folder_ / "sessions");
  test::write_text(folder_ / "sessions" / "P01.h5", "a session");
  expect_bad_input(run, "P01 already has a session here; choose another --subject or --out");
  fs::rename(folder_ / "sessions" / "P01.h5", folder_ / "sessions" / "P01.h5.partial");
  expect_bad_input(run, "P01 has an unfinished session here; add --resume, or choose another ");
}

TEST_F(CommandTest, ASubjectWhoDiffersInCapitalsAloneIsRefused) {
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  expect_bad_input(
      "haptrial run " + shipped() + " --device virtual --subject s01 --out " + path("study"),
      "--subject is 's01', and ");
}

TEST_F(CommandTest, NothingToResumeIsRefusedWithWhatIsUnfinished) {
  const std::string run = "haptrial run " + shipped() + " --subject q12 --resume --out ";
  expect_bad_input(run + path("typo"),
                   "nothing to resume: q12.h5.partial is not there; there is "
                   "no such folder; choose another --subject or --out");
  fs::create_directory(folder_ / "sessions");
  expect_bad_input(run + path("sessions"), "no session in this folder is unfinished;");
  for (const char* name : {"q9.h5.partial", "q11.h5.partial", "q10.h5"}) {
    test::write_text(folder_ / "sessions" / name, "a session");
  }
  expect_bad_input(run + path("sessions"),
                   "nothing to resume: q12.h5.partial is not there; unfinished in this folder: "
                   "q11.h5.partial, q9.h5.partial; choose another --subject or --out, or leave out "
                   "--resume");
  test::write_text(folder_ / "sessions" / "q12.h5", "a session");
  expect_bad_input(run + path("sessions"), "q12.h5: the session is complete");
}

TEST_F(CommandTest, ARecordingIsReplayedAsWhatItWas) {
  ASSERT_EQ(brief_study("study", "--subjects 1").status, 0);
  const std::string run = "haptrial run " + shipped() + " --out " + path("again") + " --device " +
                          "replay:" + path("study/S01.h5");
  expect_bad_input(run + " --subject S02",
                   "was recorded with subject S01; replay it with "
                   "--subject S01");
  expect_bad_input(run + " --subject S01 --seed 2",
                   "was recorded with seed 1; replay it with "
                   "--seed 1");
  expect_bad_input(run + " --subject S01 --resume", "--resume is given with --device replay:FILE");
  test::write_text(folder_ / "other.toml", test::shipped_with("base_max", "base_max = 9.0"));
  expect_bad_input("haptrial run " + path("other.toml") + " --subject S01 --out " + path("again") +
                       " --device replay:" + path("study/S01.h5"),
                   "was recorded with another definition: force_pattern.base_max was 10, is 9");
}

TEST_F(CommandTest, OptionsWithoutEffectAreRefused) {
  const std::string run = "haptrial run " + shipped() + " --subject P01 --out " + path("out") + " ";
  expect_bad_input(run + "--port 0", "--port is given without --console");
  expect_bad_input(run + "--remote", "--remote is given without --console");
  expect_bad_input(run + "--address 127.0.0.1", "--address is given without --console");
  for (const char* device : {"virtual", "mouse --window", "replay:x.h5"}) {
    expect_bad_input(run + "--library libdhd.so --device " + device, "--library is given with ");
  }
  expect_bad_input("haptrial device-test virtual --library libdhd.so", "--library is given with ");
  expect_bad_input(run + "--lsl --lsl-optional", "--lsl and --lsl-optional are both given");
  const std::string in = "cd '" + folder_.path().string() + "' && haptrial ";
  expect_bad_input(in + "dry-run " + shipped() + " --out ''", "--out is empty");
  expect_bad_input(in + "dry-run " + shipped() + " --out=", "--out is empty");
  expect_bad_input(in + "run " + shipped() + " --subject P01 --out ''", "--out is empty");
}

/// A pipe that nobody writes to, and an endless device, in place of each kind of file.
TEST_F(CommandTest, FilesThatNeverEndAreRefused) {
  ASSERT_EQ(mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ / "zero.obj");
  fs::create_symlink("/dev/zero", folder_ / "zero.nii");
  const std::string trials =
      test::read_text(HAPTRIAL_SOURCE_DIR "/experiments/stiffness_discrimination.toml");
  for (const std::string file : {"pipe.obj", "zero.obj"}) {
    const std::string sentence = file + ": is not a regular file";
    test::write_text(folder_ / "script.toml",
                     trials + "\n[level_script]\nfile = \"" + file + "\"\n");
    test::write_text(
        folder_ / "mesh.toml",
        trials + "\n[objects.thing]\nstiffness = 500.0\ndamping = 1.0\nmesh = \"" + file + "\"\n");
    expect_bad_input("haptrial validate " + path("script.toml"), sentence);
    EXPECT_THAT(run_command("haptrial validate " + path("mesh.toml")).errors, HasSubstr(sentence));
    expect_bad_input("haptrial statistics " + path(file) + " --value value", sentence);
    expect_bad_input("haptrial align " + path(file) + " " + path(file) + " --out " + path("a"),
                     sentence);
    expect_bad_input("haptrial validate " + path(file), sentence);
    expect_bad_input("haptrial device-test force-dimension --library " + path(file), sentence);
  }
  expect_bad_input("haptrial bone import " + path("zero.nii") + " " + path("bone.nrrd"),
                   "zero.nii: is not a regular file");
}

TEST_F(CommandTest, EmptyWordsDoNotStandForDefaults) {
  const std::string run = "haptrial run " + shipped() + " --out " + path("out");
  expect_bad_input(run + " --subject \"$UNSET\"", "--subject is empty; write a value after it");
  expect_bad_input(run + " --subject=", "--subject is empty");
  for (const char* option : {"--device", "--library", "--learn-from", "--tutor", "--notes"}) {
    expect_bad_input(run + " --subject P01 " + option + " ''", std::string(option) + " is empty");
  }
  expect_bad_input("haptrial analyze ''", "an empty word follows haptrial analyze");
  expect_bad_input("haptrial dry-run " + shipped() + " --language '' --out " + path("out"),
                   "--language is empty");
}

}  // namespace
}  // namespace haptrial
