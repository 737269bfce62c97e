// haptrial align and compare: curves of any origin, good and bad.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "analysis/files/csv.h"
#include "analysis/force_training/score/score.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::align_command_test {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kRate = 100.0;

/// A peak at `instant`, over 4 s.
std::vector<double> peak(double instant) {
  std::vector<double> values;
  for (int k = 0; k <= 400; ++k) {
    values.push_back(6.0 * std::exp(-std::pow((k / kRate - instant) / 0.4, 2)));
  }
  return values;
}

std::string table(const std::vector<double>& values, const std::string& header = "time,force\n",
                  char separator = ',') {
  std::string text = header;
  for (std::size_t k = 0; k < values.size(); ++k) {
    text += fmt::format("{}{}{}\n", static_cast<double>(k) / kRate, separator, values[k]);
  }
  return text;
}

class AlignCommandTest : public testing::Test {
 protected:
  AlignCommandTest() {
    write("target.csv", table(peak(1.5)));
    write("applied.csv", table(peak(2.0)));
  }

  void write(const std::string& name, const std::string& text) const {
    test::write_text(folder_ / name, text);
  }

  CommandResult run(const std::string& arguments) const {
    return run_command("cd '" + folder_.path().string() + "'; haptrial align " + arguments);
  }

  /// The number on the line of standard output that starts with `name`.
  double number(const std::string& arguments, const std::string& name = "score ") const {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.errors;
    const auto at = result.output.find(name);
    return at == std::string::npos ? std::nan("")
                                   : std::stod(result.output.substr(at + name.size()));
  }

  void expect_bad(const std::string& arguments, const std::string& sentence) const {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments << "\n" << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << arguments;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << arguments;
  }

  void expect_bad_file(const std::string& text, const std::string& sentence) const {
    write("bad.csv", text);
    expect_bad("target.csv bad.csv --out out", sentence);
    expect_bad("bad.csv applied.csv --out out", sentence);
  }

  test::TemporaryFolder folder_;
};

TEST_F(AlignCommandTest, ScoresAsTheLibraryDoes) {
  const analysis::ScoreParameters parameters;
  const analysis::RecallScore score =
      analysis::score_recall({kRate, peak(1.5)}, {kRate, peak(2.0)}, parameters);
  const CommandResult result = run("target.csv applied.csv");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output.substr(0, result.output.find("path ")),
            fmt::format("score           {:.6g}\nalignment_cost  {:.6g}\nrms_force       {:.6g}\n"
                        "rms_slope       {:.6g}\nrms_unaligned   {:.6g}\n",
                        score.score, score.alignment_cost, score.rms_force, score.rms_slope,
                        score.rms_unaligned));
  EXPECT_THAT(result.output, HasSubstr("pairs over 4 s\n"));
  EXPECT_LT(score.rms_force, 0.5 * score.rms_unaligned) << "the case shows nothing";
}

TEST_F(AlignCommandTest, ACurveAgainstItselfScoresZeroInEveryForm) {
  for (const char* form : {"", "--pattern symmetric1", "--pattern symmetric2 --power 1.5",
                           "--pattern asymmetric --open-begin --open-end --window 0.5",
                           "--pattern symmetricP1 --window 0", "--power 2 --open-end"}) {
    EXPECT_EQ(number(std::string("target.csv target.csv --filter 0 ") + form), 0.0) << form;
  }
}

TEST_F(AlignCommandTest, EveryWayToWriteACurveReadsTheSame) {
  const double plain = number("target.csv applied.csv");
  std::string semicolons = table(peak(2.0), "time;force\n", ';');
  write("semicolon.csv", semicolons);
  std::replace(semicolons.begin(), semicolons.end(), '.', ',');
  write("comma.csv", semicolons);
  write("tab.csv", table(peak(2.0), "time\tforce\n", '\t'));
  write("nameless.csv", table(peak(2.0), ""));
  std::string windows;
  for (const char c : table(peak(2.0), "\xef\xbb\xbf\"time\", \"force\"\n")) {
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  }
  write("windows.csv", windows);
  for (const char* file :
       {"semicolon.csv", "comma.csv", "tab.csv", "nameless.csv", "windows.csv"}) {
    EXPECT_EQ(number(std::string("target.csv ") + file), plain) << file;
  }
  EXPECT_EQ(number("target.csv - < applied.csv"), plain);
  EXPECT_EQ(number("- applied.csv < target.csv"), plain);
  EXPECT_EQ(number("target.csv applied.csv --rate 100"), plain) << "the times are passed over";
}

TEST_F(AlignCommandTest, MillisecondsGetTheWarningOfAnImport) {
  std::string text = "time,force\n";
  const auto values = peak(2.0);
  for (std::size_t k = 0; k < values.size(); ++k) {
    text += fmt::format("{},{}\n", 10 * k, values[k]);
  }
  write("milliseconds.csv", text);
  const CommandResult odd = run("milliseconds.csv milliseconds.csv");
  EXPECT_EQ(odd.status, 0);
  EXPECT_THAT(odd.errors,
              StartsWith("WARNING: implausible times (target: 4000 s with 0.1000 rows a second"));
  EXPECT_THAT(odd.errors, HasSubstr("are these milliseconds?"));
  EXPECT_THAT(run("target.csv milliseconds.csv").errors, HasSubstr("applied: 4000 s"));
  EXPECT_EQ(run("target.csv applied.csv").errors, "");
}

TEST_F(AlignCommandTest, ColumnsAreChosenByName) {
  const double plain = number("target.csv applied.csv");
  std::string both = "t,wanted,got,note\n";
  const auto target = peak(1.5), applied = peak(2.0);
  for (std::size_t k = 0; k < target.size(); ++k) {
    both +=
        fmt::format("{},{},{},\"a, b\"\n", static_cast<double>(k) / kRate, target[k], applied[k]);
  }
  write("both.csv", both);
  EXPECT_EQ(number("both.csv both.csv --time t --value wanted --applied-value got"), plain);
  EXPECT_EQ(number("both.csv both.csv --rate 100 --value wanted --applied-value got"), plain);
  expect_bad("both.csv both.csv --value wanted", "both.csv: no column is named 'time'; name ");
  expect_bad("both.csv both.csv --time t",
             "both.csv: 3 columns could hold the values; name one of them ");
  expect_bad("both.csv both.csv --time t --value force",
             "both.csv: there is no column 'force'; allowed: t, wanted, got, note");
  expect_bad("both.csv both.csv --time t --value note",
             "both.csv:2: note is 'a, b'; allowed: a fin");
}

TEST_F(AlignCommandTest, OptionsDoWhatTheySay) {
  const std::string both = "target.csv applied.csv ";
  const double cost = number(both, "alignment_cost ");
  EXPECT_GT(number(both + "--penalty 2", "alignment_cost "), cost);
  EXPECT_LT(number(both + "--slope-weight 0", "alignment_cost "), cost);
  EXPECT_GT(number(both + "--window 0.1", "alignment_cost "), cost);
  EXPECT_EQ(number(both + "--window 4", "alignment_cost "), cost);
  EXPECT_EQ(number(both + "--pattern symmetric1", "alignment_cost "),
            number(both + "--penalty 0", "alignment_cost "));
  EXPECT_NE(number(both + "--power 1.5", "alignment_cost "), cost);
  // Half a second later: with open ends the peak is found where it is.
  const CommandResult open = run(both + "--open-begin --open-end --filter 0");
  EXPECT_THAT(open.output, HasSubstr("applied curve from 0.5"));
  EXPECT_EQ(number(both + "--samples 500 --rate 50", "pairs over "), 8.0);
}

TEST_F(AlignCommandTest, OutHoldsTheCurvesThePathAndThePicture) {
  const CommandResult result = run("target.csv applied.csv --samples 300 --out out");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto aligned = analysis::CsvTable::load(folder_ / "out" / "aligned.csv");
  const auto path = analysis::CsvTable::load(folder_ / "out" / "path.csv");
  EXPECT_EQ(aligned.rows(), 300u);
  // The parts of the score follow from the files.
  const auto target = aligned.numbers(1), applied = aligned.numbers(2), warped = aligned.numbers(3);
  double unaligned = 0.0, after = 0.0;
  for (std::size_t k = 0; k < target.size(); ++k) {
    unaligned += std::pow(target[k] - applied[k], 2) / 300.0;
    after += std::pow(target[k] - warped[k], 2) / 300.0;
  }
  EXPECT_THAT(result.output,
              HasSubstr(fmt::format("rms_unaligned   {:.6g}\n", std::sqrt(unaligned))));
  EXPECT_THAT(result.output, HasSubstr(fmt::format("rms_force       {:.6g}\n", std::sqrt(after))));
  EXPECT_THAT(result.output, HasSubstr(fmt::format("path            {} pairs", path.rows())));
  EXPECT_EQ(path.numbers(0).back(), 4.0);
  EXPECT_THAT(test::read_text(folder_ / "out" / "alignment.svg"), HasSubstr("<svg"));
  EXPECT_THAT(test::read_text(folder_ / "out" / "alignment.png"), StartsWith("\x89PNG"));
  const CommandResult again = run("target.csv applied.csv --out out");
  EXPECT_EQ(again.status, 2) << "a folder with something in it is not written over";
}

TEST_F(AlignCommandTest, BadFilesGetASentence) {
  expect_bad_file("", "bad.csv: holds no rows of values");
  expect_bad_file("time,force\n", "bad.csv: holds no rows of values");
  expect_bad_file("time,force\n0,1\n", "bad.csv:2: is the only row; allowed: at least two");
  expect_bad_file("time,force\n0,1\n0.1,nan\n",
                  "bad.csv:3: force is 'nan'; allowed: a finite number");
  expect_bad_file("time,force\n0,1\n0.1,\n", "bad.csv:3: force is ''; allowed: a finite number");
  expect_bad_file("time,force\n0,1\n0.1\n", "bad.csv:3: the row has 1 fields; allowed: 2");
  expect_bad_file("time,force\n0,1\n\n0.2,1\n", "bad.csv:3: the line is empty");
  expect_bad_file("time,force\n0,1\n0.2,1\n0.2,3\n",
                  "bad.csv:4: time is '0.2'; allowed: above 0.2, the time of the row before");
  expect_bad_file("time,force\n0,1\n0.1,1e13\n", "reaches 10000000000000.000000; allowed");
  expect_bad_file("time;force\n0;1,5\n0,1;2.5\n",
                  "bad.csv:3: force is '2.5'; allowed: a finite nu");
  expect_bad_file("t,force\n0,1\n1,2\n", "bad.csv: no column is named 'time'");
  expect_bad_file("<html>\n", "bad.csv: holds no rows of values");
  expect_bad("target.csv absent.csv", "absent.csv: no such file");
  expect_bad("target.csv .", ".: is a directory");
  expect_bad("target.csv - < /dev/null", "standard input: holds no rows of values");
}

TEST_F(AlignCommandTest, BadArgumentsGetASentence) {
  const std::string both = "target.csv applied.csv ";
  expect_bad("target.csv", "APPLIED");
  expect_bad("- -", "TARGET and APPLIED are both '-'; read only one of them from standard input");
  expect_bad(both + "--power 0.9", "--power is 0.9; allowed: a number from 1 to 100");
  expect_bad(both + "--power nan", "--power is nan; allowed");
  expect_bad(both + "--penalty -1", "--penalty is -1; allowed: a number from 0");
  expect_bad(both + "--slope-weight much", "much");
  expect_bad(both + "--window -0.1", "--window is -0.1; allowed");
  expect_bad(both + "--samples 1", "--samples is 1; allowed: a whole number from 2 to 10000");
  expect_bad(both + "--pattern best", "--pattern is 'best'; allowed: published, symmetric1, ");
  expect_bad(both + "--pattern symmetric2 --open-begin",
             "--open-begin is given with --pattern sym");
  expect_bad(both + "--rate 0", "the rate of target.csv is 0 Hz; allowed: a finite number above 0");
  expect_bad(both + "--rate 10 --time time", "has a rate and a column 'time' of times; give one");
  expect_bad(both + "--out target.csv", "target.csv");
}

TEST_F(AlignCommandTest, HelpShowsAnExample) {
  const CommandResult help = run("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.output, HasSubstr("Example:\n  haptrial align "));
}

TEST_F(AlignCommandTest, BashCompletesItsOptions) {
  const CommandResult options = run_command(
      "source '" HAPTRIAL_SOURCE_DIR
      "/experiments/completion.bash'\n"
      "COMP_WORDS=(haptrial align --open) COMP_CWORD=2; _haptrial; echo ${COMPREPLY[@]}");
  EXPECT_EQ(options.output, "--open-begin --open-end\n");
}

class CompareCommandTest : public testing::Test {
 protected:
  /// Runs and analyses a small study of virtual subjects.
  void make_study(const std::string& name, const std::string& more,
                  const fs::path& definition = test::shipped_definition()) {
    const CommandResult made = run_command("haptrial dry-run '" + definition.string() +
                                           "' --subjects 2 --trials 9 --out " + path(name) + " " +
                                           more + " && haptrial analyze " + path(name));
    ASSERT_EQ(made.status, 0) << made.errors;
  }

  CommandResult compare(const std::string& first, const std::string& second,
                        const std::string& more = "") {
    return run_command("haptrial compare " + path(first) + " " + path(second) + " " + more);
  }

  std::string path(const std::string& name) const {
    const std::string quote = "'";
    return quote + (folder_ / name).string() + quote;
  }

  test::TemporaryFolder folder_;
};

TEST_F(CompareCommandTest, OtherSeedsAreOtherPeople) {
  make_study("one", "--seed 1");
  make_study("two", "--seed 2");
  make_study("pace", "--seed 1",
             test::shipped_definition().parent_path() / "force_training_curve.toml");
  const CommandResult other = compare("one", "two");
  EXPECT_EQ(other.status, 0) << other.errors;
  EXPECT_THAT(other.output, testing::StartsWith("SIMULATED PARTICIPANTS"));
  EXPECT_THAT(other.output, HasSubstr("No participant is paired. Not paired: S01, S02 (virtual "
                                      "subjects of different seeds: 1 and 2)."));
  const CommandResult same = compare("one", "pace");
  EXPECT_EQ(same.status, 0) << same.errors;
  EXPECT_THAT(same.output, HasSubstr("Paired: 2 participants."));
  EXPECT_THAT(same.output, HasSubstr("force_training_curve compares forces over the place on the "
                                     "path, force_training over time."));
  const std::string differ = "The definitions differ in what was presented, recorded or scored: ";
  EXPECT_THAT(same.output, HasSubstr(differ));
  EXPECT_THAT(same.output, HasSubstr("guidance.kind was absent, is \"curve\""));
  EXPECT_THAT(other.output, testing::Not(HasSubstr("The definitions differ")));
}

TEST_F(CompareCommandTest, OtherScoringIsRefusedUnlessAskedFor) {
  std::string text = test::read_text(test::shipped_definition());
  const std::string key = "filter_width = 0.1 ";
  ASSERT_NE(text.find(key), std::string::npos);
  text.replace(text.find(key), key.size(), "filter_width = 0.2 ");
  std::ofstream(folder_ / "wide.toml") << text;
  make_study("one", "");
  make_study("wide", "", folder_ / "wide.toml");
  const CommandResult refused = compare("one", "wide", "--out " + path("out"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("scored with different parameters (box filter on the "
                                        "applied force: 0.1 s and 0.2 s)"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  const CommandResult asked = compare("one", "wide", "--different-scoring --out " + path("out"));
  EXPECT_EQ(asked.status, 0) << asked.errors;
  EXPECT_THAT(asked.output, testing::StartsWith("DIFFERENT SCORING"));
  const std::string page = test::read_text(folder_ / "out/comparison.html");
  EXPECT_LT(page.find("DIFFERENT SCORING"), page.find("class=\"lines\""));
}

}  // namespace
}  // namespace haptrial::align_command_test
