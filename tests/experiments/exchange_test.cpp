// Out to other programs and in from elsewhere, through the command.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;
using testing::Not;

class ExchangeTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const {
    const std::string quote = "'";
    return quote + (folder_ / name).string() + quote;
  }

  void make_study(const std::string& more) {
    const CommandResult dry =
        run_command("haptrial dry-run '" + test::shipped_definition().string() + "' --out " +
                    path("study") + " " + more);
    ASSERT_EQ(dry.status, 0) << dry.errors;
  }

  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  test::TemporaryFolder folder_;
};

TEST_F(ExchangeTest, TheShippedStudyComesBackFromItsCurves) {
  make_study("--subjects 4 --trials 18");
  const CommandResult out = run_command("haptrial export --curves " + path("curves") + " " +
                                        path("study") + " && haptrial analyze " + path("study"));
  ASSERT_EQ(out.status, 0) << out.errors;
  EXPECT_THAT(out.output, HasSubstr("72 scored trials of 4 participants"));
  const std::string taken = "haptrial analyze --curves " + path("curves") + " --conditions " +
                            path("curves/conditions.csv") + " --out ";
  const CommandResult in =
      run_command(taken + path("report") + " && " + taken + path("again") + " --definition '" +
                  test::shipped_definition().string() + "'");
  ASSERT_EQ(in.status, 0) << in.errors;
  EXPECT_THAT(in.output, Not(HasSubstr("WARNING")));
  // Curves know nothing of the quality of a recording, which the columns after the tenth tell.
  const auto scores = [&](const char* folder) {
    return run_command("cut -d, -f-10 " + path(folder) + "/scores.csv").output;
  };
  EXPECT_THAT(scores("study"), HasSubstr("rms_unaligned\nS01,1,"));
  EXPECT_EQ(scores("again"), scores("study"));
  EXPECT_EQ(scores("report"), scores("study"));
  const auto ours = nlohmann::json::parse(test::read_text(folder_ / "again/statistics.json"));
  const auto theirs = nlohmann::json::parse(test::read_text(folder_ / "study/statistics.json"));
  for (const char* part :
       {"conditions", "participants_as_unit", "published", "repeated_measures"}) {
    EXPECT_EQ(ours[part], theirs[part]) << part;
  }
  const std::string report = test::read_text(folder_ / "report/report.html");
  EXPECT_THAT(report, HasSubstr("SIMULATED PARTICIPANTS"));
  EXPECT_THAT(report, Not(HasSubstr("Timing of the servo loop")));
}

TEST_F(ExchangeTest, DataSetsSayWhatWasAskedAndAnswered) {
  test::write_text(folder_ / "study.toml",
                   test::read_text(HAPTRIAL_SOURCE_DIR "/experiments/first_experiment.toml") +
                       "[pages]\nafter = [\"load\"]\n[pages.load]\nkind = \"nasa_tlx\"\n");
  const CommandResult done =
      run_command("haptrial dry-run " + path("study.toml") + " --subjects 2 --trials 8 --out " +
                  path("study") + " && haptrial export " + path("study") + " --bids " +
                  path("bids") + " && haptrial export --psych-ds " + path("psych") + " " +
                  path("study") + " && haptrial analyze " + path("study"));
  ASSERT_EQ(done.status, 0) << done.errors;
  const CommandResult read = run_command(
      "/usr/bin/python3 -c \"import pandas, sys\n"
      "e = pandas.read_csv(sys.argv[1], sep='\\t', na_values='n/a').dropna(subset=['pass'])\n"
      "t = pandas.read_csv(sys.argv[2])[:len(e)].reset_index()\n"
      "e = e.reset_index()\n"
      "print(len(e), (e.level == t.level).all(), (e.answer == t['answer.text']).all(),\n"
      "      (e.response_time - t['answer.rt']).abs().max() < 1e-9, set(e.track) == set(t.track))\n"
      "p = pandas.read_csv(sys.argv[3], sep='\\t')\n"
      "print(list(p.participant_id), p.shape[1] > 8, p.notna().all(axis=None))\" " +
      path("bids/sub-S01/beh/sub-S01_task-firstexperiment_events.tsv") + " " +
      path("study/trials.csv") + " " + path("bids/phenotype/load.tsv"));
  EXPECT_EQ(read.output, "8 True True True True\n['sub-S01', 'sub-S02'] True True\n")
      << read.errors;
  const CommandResult rules = run_command(
      "/usr/bin/python3 '" HAPTRIAL_SOURCE_DIR "/tests/analysis/exchange/read_psych_ds.py' " +
      path("psych") + " " + path("study/S01.h5") + " " + path("study/S02.h5"));
  EXPECT_EQ(rules.output, "equal\n") << rules.errors;
}

TEST_F(ExchangeTest, OneTableWithFactorsAndNamesOfItsOwn) {
  std::ofstream table(folder_ / "table.csv");
  table << "Participant,No,training,age,t,wanted,pressed\n";
  for (int person = 1; person <= 4; ++person) {
    for (int trial = 1; trial <= 4; ++trial) {
      for (int k = 0; k < 200; ++k) {
        const double target = 5.0 + 3.0 * std::sin(0.03 * k + trial);
        table << person << ',' << trial << ',' << (trial % 2 == 0 ? "haptic" : "visual") << ','
              << (person % 2 == 0 ? "old" : "young") << ',' << 10.0 * k << ',' << target << ','
              << target + 0.1 * person + 0.05 * trial << '\n';
      }
    }
  }
  table.close();
  const CommandResult done = run_command(
      "haptrial analyze --table " + path("table.csv") + " --out " + path("report") +
      " --column subject=Participant --column trial=No --column time=t "
      "--column target_force=wanted --column applied_force=pressed --factor training --factor age");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("WARNING: implausible times in 16 of 16 trials (1, trial 1: "
                                     "1990 s with 0.1000 rows a second;"));
  EXPECT_THAT(test::read_text(folder_ / "report/scores.csv"),
              HasSubstr("repetition,condition,training,age,score"));
  EXPECT_THAT(test::read_text(folder_ / "report/scores.csv"),
              HasSubstr("\n1,1,1,1,\"visual, young\",visual,young,"));
  EXPECT_THAT(test::read_text(folder_ / "report/report.md"), HasSubstr("implausible times"));
}

TEST_F(ExchangeTest, EveryFormOfExportWritesANewFolder) {
  make_study("--subjects 2 --trials 3");
  for (const char* form : {"--bids", "--bids --motion 100", "--psych-ds", "--xdf", "--csv",
                           "--csv --samples", "--curves"}) {
    const std::string option = std::string(form).substr(0, std::string(form).find(' '));
    const std::string more = std::string(form).substr(option.size());
    const std::string line = "haptrial export " + option + " " + path("out") + more + " " +
                             path("study/S01.h5") + " " + path("study/S02.h5");
    const CommandResult done = run_command(line);
    EXPECT_EQ(done.status, 0) << done.errors;
    EXPECT_EQ(done.errors, "");
    const CommandResult again = run_command(line);
    EXPECT_EQ(again.status, 2);
    EXPECT_THAT(again.errors, HasSubstr("is not empty; choose a new or an empty folder"));
    fs::remove_all(folder_ / "out");
  }
}

TEST_F(ExchangeTest, DrillingsAreExportedButHaveNoCurves) {
  const fs::path definition = test::write_small_drilling(folder_.path(), 1.0);
  const CommandResult dry = run_command("haptrial dry-run '" + definition.string() +
                                        "' --subjects 1 --out " + path("study"));
  ASSERT_EQ(dry.status, 0) << dry.errors;
  const CommandResult curves =
      run_command("haptrial export --curves " + path("curves") + " " + path("study"));
  EXPECT_EQ(curves.status, 2);
  EXPECT_THAT(curves.errors, HasSubstr("S01.h5: is a session of bone_drilling, which has no target "
                                       "force; --curves exports sessions whose passes have one"));
  EXPECT_EQ(std::count(curves.errors.begin(), curves.errors.end(), '\n'), 1) << curves.errors;
  EXPECT_FALSE(fs::exists(folder_ / "curves"));
  const CommandResult others =
      run_command("set -e; haptrial export --bids " + path("bids") + " " + path("study") +
                  "; haptrial export --csv " + path("csv") + " --samples " + path("study"));
  ASSERT_EQ(others.status, 0) << others.errors;
  for (const auto& entry : fs::directory_iterator(folder_ / "bids")) {
    if (entry.path().filename().string().ends_with("_events.json")) {
      const auto events = nlohmann::json::parse(test::read_text(entry.path()));
      EXPECT_EQ(events["phase"]["Levels"]["drilling"], "bone is drilled");
    }
  }
  EXPECT_THAT(test::read_text(folder_ / "bids/README"), Not(HasSubstr("training pass")));
  const auto tables = nlohmann::json::parse(test::read_text(folder_ / "csv/dictionary.json"));
  const auto& phase = tables["files"]["trials.csv"]["columns"]["phase"];
  EXPECT_EQ(phase["levels"]["drilling"], "bone is drilled");
}

TEST_F(ExchangeTest, AnImportLeavesTheReportOfSessionsAlone) {
  make_study("--subjects 1 --trials 3");
  fs::create_directory(folder_ / "begun");
  test::write_text(folder_ / "begun" / "S01.h5.partial", "a session");
  test::write_text(folder_ / "study" / "report.html", "of the sessions");
  for (const std::string& out : {path("study"), path("begun")}) {
    for (const char* source : {"--table x", "--curves x --conditions y"}) {
      const CommandResult refused =
          run_command("haptrial analyze " + std::string(source) + " --out " + out);
      EXPECT_EQ(refused.status, 2);
      EXPECT_THAT(refused.errors, HasSubstr("--out holds session files; choose another folder"));
    }
  }
  EXPECT_EQ(test::read_text(folder_ / "study" / "report.html"), "of the sessions");
}

TEST_F(ExchangeTest, BadArgumentsGetASentence) {
  make_study("--subjects 1 --trials 1");
  const std::map<std::string, std::string> sentences{
      {"export " + path("study"),
       "give exactly one of --bids, --psych-ds, --xdf, --csv and --curves"},
      {"export --bids a --csv b " + path("study"),
       "give exactly one of --bids, --psych-ds, --xdf, --csv and --curves"},
      {"export --csv x --author A " + path("study"), "--author is given without --bids"},
      {"export --curves x --name A " + path("study"), "--name is given without --bids"},
      {"export --csv x --motion 100 " + path("study"), "--motion is given without --bids"},
      {"export --bids x --motion 2000 " + path("study"), "allowed: up to the loop's 1000 Hz"},
      {"export --bids x --samples " + path("study"), "--samples is given without --csv"},
      {"export --csv '' --bids x " + path("study"), "--csv is empty"},
      {"export --bids " + path("out") + " " + path("absent.h5"), "no such file"},
      {"analyze", "give exactly one of DIR, --curves and --table"},
      {"analyze --curves x " + path("study"), "give exactly one of DIR, --curves and --table"},
      {"analyze --curves x --table y", "give exactly one of DIR, --curves and --table"},
      {"analyze --curves x --out z", "--conditions is missing; --curves needs it"},
      {"analyze --curves x --conditions y", "--out is missing; --curves needs it"},
      {"analyze --table x", "--out is missing; --table needs it"},
      {"analyze --table x --out z", "x: no such file"},
      {"analyze --table x --out z --conditions y", "--conditions is given without --curves"},
      {"analyze --table x --out z --pilots", "--pilots is given without a folder of sessions"},
      {"analyze --column a=b " + path("study"), "--column is given without --curves or --table"},
      {"analyze --factor a " + path("study"), "--factor is given without --curves or --table"},
      {"analyze --curves x --conditions y --out z", "y"},
      {"analyze " + path("study") + " --out z", "--out is given without --curves"}};
  for (const auto& [line, sentence] : sentences) {
    const CommandResult result = run_command("haptrial " + line);
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << line;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ExchangeTest, AnInterruptLeavesNothing) {
  make_study("--subjects 2 --trials 36");
  // Once the hidden folder is there and samples are being written, the program is told to stop. An
  // export that was faster is made again.
  CommandResult result;
  do {
    result = run_command(
        "cd " + path("") +
        "\nrm -rf out\n\"$HAPTRIAL\" export --bids out study --jobs 1 &\npid=$!\n" +
        "while kill -0 $pid && ! ls -d .out.partial-*/sub-*/beh; do sleep 0.01; done >/dev/null "
        "2>&1\nkill -INT $pid\nwait $pid\n");
  } while (result.status == 0);
  EXPECT_EQ(result.status, 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("interrupted; nothing was exported"));
  EXPECT_EQ(entries(), 1u);
}

/// The lines "name value" of a worked script as numbers.
std::map<std::string, double> numbers(const std::string& output) {
  std::map<std::string, double> result;
  std::istringstream text(output);
  for (std::string line; std::getline(text, line);) {
    while (!line.empty() && line.back() == ' ') {
      line.pop_back();
    }
    const auto space = line.rfind(' ');
    result[line.substr(0, space)] = std::stod(line.substr(space + 1));
  }
  return result;
}

/// The same numbers as the report has them.
std::map<std::string, double> reported() {
  const fs::path results = fs::path(HAPTRIAL_SOURCE_DIR) / "results" / "force_training";
  const auto json = nlohmann::json::parse(test::read_text(results / "statistics.json"));
  std::map<std::string, double> result;
  for (const auto& condition : json["conditions"]) {
    result["mean " + condition["condition"].get<std::string>()] = condition["mean"];
  }
  result["anova_F"] = json["published"]["one_way_anova"]["f"];
  result["anova_p"] = json["published"]["one_way_anova"]["p"];
  for (const auto& comparison : json["published"]["comparisons"]) {
    std::string name = comparison["test"];
    name.erase(name.find(" < ") + 2, 1).erase(name.find(" <"), 1);
    result["t " + name] = comparison["student"]["t"];
    result["p " + name] = comparison["student"]["p"];
  }
  const auto& repeated = json["repeated_measures"]["anova"];
  result["repeated_F"] = repeated["f"];
  result["repeated_p"] = repeated["p"];
  result["repeated_epsilon"] = repeated["greenhouse_geisser_epsilon"];
  result["repeated_p_corrected"] = repeated["p_corrected"];
  return result;
}

void expect_the_reports_numbers(const std::string& program, const std::string& script) {
  const fs::path source = HAPTRIAL_SOURCE_DIR;
  const CommandResult run =
      run_command(program + " '" + (source / "docs" / "worked" / script).string() + "' '" +
                  (source / "results" / "force_training" / "scores.csv").string() + "'");
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto theirs = numbers(run.output);
  const auto ours = reported();
  ASSERT_EQ(ours.size(), 13u);
  ASSERT_EQ(theirs.size(), ours.size()) << run.output;
  for (const auto& [name, value] : ours) {
    ASSERT_TRUE(theirs.contains(name)) << name << "\n" << run.output;
    EXPECT_NEAR(theirs.at(name), value, 1e-10 * std::abs(value)) << name;
  }
}

TEST(WorkedScriptTest, PandasGivesTheNumbersOfTheReport) {
  expect_the_reports_numbers("/usr/bin/python3", "analysis.py");
}

TEST(WorkedScriptTest, RGivesTheNumbersOfTheReport) {
  expect_the_reports_numbers("Rscript", "analysis.R");
}

/// R finds the thresholds from the tidy tables, by a search of its own.
TEST_F(ExchangeTest, RFindsTheThresholdsOfTheReport) {
  const fs::path source = HAPTRIAL_SOURCE_DIR;
  const CommandResult run = run_command(
      "set -e; haptrial dry-run '" +
      (source / "experiments/stiffness_discrimination.toml").string() + "' --subjects 2 --out " +
      path("study") + " >&2; haptrial analyze " + path("study") + " >&2; haptrial export --csv " +
      path("tables") + " " + path("study") + " >&2; Rscript '" +
      (source / "docs/worked/thresholds.R").string() + "' " + path("tables/levels.csv"));
  ASSERT_EQ(run.status, 0) << run.errors;
  std::istringstream theirs(run.output);
  const std::string estimates = test::read_text(folder_ / "study/estimates.csv");
  int compared = 0;
  for (std::string who, word; theirs >> who >> word; ++compared) {
    double threshold = 0.0;
    theirs >> threshold;
    std::getline(theirs, word);
    const std::string row = who + ",,likelihood,threshold,";
    const std::size_t at = estimates.find(row);
    ASSERT_NE(at, std::string::npos) << row << "\n" << estimates;
    EXPECT_NEAR(threshold, std::stod(estimates.substr(at + row.size())), 0.01) << who;
  }
  EXPECT_EQ(compared, 2) << run.output;
}

}  // namespace
}  // namespace haptrial
