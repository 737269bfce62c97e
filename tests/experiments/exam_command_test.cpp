// haptrial exam, as it is called from a shell, with another program at the other end of a pipe.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "analysis/files/csv.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exam_command_test {
namespace {

using testing::HasSubstr;

const std::filesystem::path kSource = HAPTRIAL_SOURCE_DIR;

class ExamCommandTest : public testing::Test {
 protected:
  test::CommandResult run(const std::string& line) const {
    return test::run_command("cd '" + folder_.path().string() + "' && haptrial exam " + line);
  }
  const std::string half_space_ =
      "python3 '" + (kSource / "docs/worked/exam/half_space.py").string() + "'";
  const test::TemporaryFolder folder_;
};

/// A program that takes every body for a half-space is exact on the plane, and there alone.
TEST_F(ExamCommandTest, AnotherProgramSitsIt) {
  ASSERT_EQ(run("make 'an exam'").status, 0);
  const auto sat = run("run 'an exam' --out answers --name half-space --program " + half_space_);
  ASSERT_EQ(sat.status, 0) << sat.errors;
  const auto scored = run("score 'an exam' answers --out scores");
  ASSERT_EQ(scored.status, 0) << scored.errors;
  EXPECT_THAT(scored.output, HasSubstr("half-space: 1 of 16 cases right"));
  const auto table = analysis::CsvTable::load(folder_ / "scores/scores.csv");
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const bool plane = table.text(i, table.column("case")) == "plane";
    EXPECT_EQ(table.text(i, table.column("verdict")) == "right", plane) << "row " << i;
  }
  EXPECT_THAT(test::read_text(folder_ / "scores/report.html"), HasSubstr("ridges right"));
}

/// A program without any force: it is told of tools and their turns, and its tools go through all.
TEST_F(ExamCommandTest, AnotherProgramSitsTheExamOfRigidTools) {
  ASSERT_EQ(run("make 'rigid exam' --rigid").status, 0);
  std::ofstream(folder_ / "nothing.sh") << R"(while read -r word rest; do
  case $word in
    tick) set -- $rest; [ $# = 8 ] && echo 0 0 0 0 0 0;;
    *) echo ready;;
  esac
done
)";
  const auto sat = run("run 'rigid exam' --out answers --name nothing --program sh nothing.sh");
  ASSERT_EQ(sat.status, 0) << sat.errors;
  const auto scored = run("score 'rigid exam' answers --out scores");
  ASSERT_EQ(scored.status, 0) << scored.errors;
  EXPECT_THAT(scored.output, HasSubstr("nothing: 0 of 3 cases right"));
  EXPECT_THAT(test::read_text(folder_ / "scores/report.html"), HasSubstr("torque error"));
  const auto point = run("run 'rigid exam' proxy --out more");
  EXPECT_EQ(point.status, 2);
  EXPECT_THAT(point.errors, HasSubstr("proxy renders a point; allowed in an exam of rigid tools"));
}

/// The rows of a renderer in a table of scores.
std::string rows_of(const std::string& renderer, const std::filesystem::path& table) {
  std::istringstream lines(test::read_text(table));
  std::string rows;
  for (std::string line; std::getline(lines, line);) {
    rows += line.starts_with(renderer + ",") ? line + "\n" : "";
  }
  return rows;
}

TEST_F(ExamCommandTest, TheKeptScoresAreReproduced) {
  ASSERT_EQ(run("make exam").status, 0);
  const char* renderers[] = {"proxy", "penalty", "distance-field", "voxel"};
  std::string folders;
  for (const std::string renderer : renderers) {
    ASSERT_EQ(run("run exam " + renderer + " --out " + renderer).status, 0);
    folders += renderer + " ";
  }
  ASSERT_EQ(run("score exam " + folders + "--out scores").status, 0);
  for (const std::string renderer : renderers) {
    const std::string rows = rows_of(renderer, kSource / "results/exam/exam-scores.csv");
    EXPECT_FALSE(rows.empty());
    EXPECT_EQ(rows_of(renderer, folder_ / "scores/scores.csv"), rows);
  }
}

/// An exam of some of the cases of one that is there.
void leave_cases(const std::filesystem::path& exam, const std::set<std::string>& names) {
  auto said = nlohmann::json::parse(test::read_text(exam / "exam.json"));
  auto& cases = said["cases"];
  for (std::size_t i = cases.size(); i-- > 0;) {
    if (!names.contains(cases[i]["name"])) {
      cases.erase(i);
    }
  }
  ASSERT_EQ(cases.size(), names.size());
  std::ofstream(exam / "exam.json") << said.dump(2);
}

class SoftExamCommandTest : public ExamCommandTest {
 protected:
  /// Compares rows with those kept. Solvers may add in another order elsewhere, so that numbers may
  /// be off by a hundredth.
  void expect_kept(const std::string& renderer, const std::set<std::string>& cases) const {
    const auto kept = analysis::CsvTable::load(kSource / "results/exam/soft-scores.csv");
    const auto now = analysis::CsvTable::load(folder_ / "scores/scores.csv");
    std::map<std::string, std::pair<std::string, double>> rows;
    for (std::size_t i = 0; i < kept.rows(); ++i) {
      rows[key(kept, i)] = {std::string(kept.text(i, kept.column("verdict"))), estimate(kept, i)};
    }
    std::size_t compared = 0;
    for (std::size_t i = 0; i < now.rows(); ++i) {
      if (now.text(i, now.column("renderer")) != renderer) {
        continue;
      }
      ASSERT_TRUE(rows.contains(key(now, i))) << key(now, i);
      const auto& [verdict, value] = rows.at(key(now, i));
      EXPECT_EQ(now.text(i, now.column("verdict")), verdict) << key(now, i);
      EXPECT_NEAR(estimate(now, i), value, 0.01 * std::abs(value) + 2e-5) << key(now, i);
      ++compared;
    }
    EXPECT_EQ(compared, 18 * cases.size()) << renderer;
  }

 private:
  static std::string key(const analysis::CsvTable& table, std::size_t row) {
    std::string key;
    for (const char* column : {"renderer", "case", "name"}) {
      key += std::string(table.text(row, table.column(column))) + ",";
    }
    return key;
  }
  static double estimate(const analysis::CsvTable& table, std::size_t row) {
    return table.numbers(table.column("estimate"), {row})[0];
  }
};

TEST_F(SoftExamCommandTest, TheKeptScoresOfOurOwnAreReproduced) {
  ASSERT_EQ(run("make exam --soft").status, 0);
  const std::set<std::string> some{"layers-pressed", "free-block"};  // the others take longer
  leave_cases(folder_ / "exam", some);
  for (const std::string renderer : {"springs", "implicit", "linear-elements"}) {
    const auto sat = run("run exam " + renderer + " --out " + renderer);
    ASSERT_EQ(sat.status, 0) << sat.errors;
  }
  ASSERT_EQ(run("score exam springs implicit linear-elements --out scores").status, 0);
  expect_kept("springs", some);
  expect_kept("implicit", some);
  expect_kept("linear-elements", some);
  EXPECT_THAT(test::read_text(folder_ / "scores/report.html"), HasSubstr("loses momentum"));
  const auto point = run("run exam proxy --out more");
  EXPECT_EQ(point.status, 2);
  EXPECT_THAT(point.errors,
              HasSubstr("proxy renders a point; allowed in an exam of soft bodies: springs, "));
}

TEST_F(SoftExamCommandTest, TheProgramsOfThePageSitIt) {
  ASSERT_EQ(run("make exam --soft").status, 0);
  leave_cases(folder_ / "exam", {"free-block"});
  std::string folders;
  for (const auto& [program, name] :
       {std::pair<std::string, std::string>{"pbd_body", "position-based dynamics"},
        {"vbd_body", "vertex block descent"}}) {
    const std::string source = (kSource / "docs/worked/exam" / program).string() + ".cpp";
    const auto made = test::run_command("c++ -O2 -Wall -Wextra -Werror -o '" +
                                        (folder_ / program).string() + "' '" + source + "'");
    ASSERT_EQ(made.status, 0) << made.errors;
    const auto sat =
        run("run exam --out answers-" + program + " --name '" + name + "' --program ./" + program);
    ASSERT_EQ(sat.status, 0) << sat.errors;
    folders += "answers-" + program + " ";
  }
  ASSERT_EQ(run("score exam " + folders + "--out scores").status, 0);
  expect_kept("position-based dynamics", {"free-block"});
  expect_kept("vertex block descent", {"free-block"});
}

/// One tetrahedron of MuJoCo, by its package of npm. Pulled at the top it answers with the force of
/// the Saint Venant-Kirchhoff law; pushed while it is free it moves by Newton's second law.
TEST_F(SoftExamCommandTest, MujocoAnswersByThePipe) {
  const auto package =
      test::run_command("/usr/bin/python3 " + (kSource / "tests/support").string() +
                        "/npm_package.py " HAPTRIAL_BINARY_DIR " mujoco");
  if (package.status == 3) {
    GTEST_SKIP() << "no network, so no package: " << package.errors;
  }
  ASSERT_EQ(package.status, 0) << package.errors;
  constexpr double kSide = 0.01;
  constexpr double kForce = 1e-3;
  for (const auto& [name, base, top] : {std::tuple{"pulled", 1, 2}, {"pushed", 0, 0}}) {
    std::ofstream(folder_ / (std::string(name) + ".node"))
        << "4 3 3 1\n0 0 0 0 0 0 0 " << base << "\n1 " << kSide << " 0 0 0 0 0 " << base << "\n2 0 "
        << kSide << " 0 0 0 0 " << base << "\n3 0 0 " << kSide << " 0 0 " << kForce << ' ' << top
        << '\n';
    std::ofstream(folder_ / (std::string(name) + ".ele")) << "1 4 3\n0 0 1 2 3 10000 0.3 1000\n";
  }
  constexpr int kTicks = 20;
  constexpr double kPull = 0.1;  // of the side
  std::ofstream lines(folder_ / "lines");
  lines << "body soft rate 1000 pulled.node\nstart 1 2 3\n";
  for (int tick = 1; tick <= kTicks; ++tick) {  // it is there after half of them, and rests
    lines << "tick 0 1 2 " << 3.0 + kPull * kSide * std::min(1.0, 2.0 * tick / kTicks) << " 0\n";
  }
  lines << "body soft rate 1000 pushed.node\nstart 0 0 0\n";
  for (int tick = 1; tick <= kTicks; ++tick) {
    lines << "tick 0 0 0 0 1\n";
  }
  lines << "shape\n";
  lines.close();
  const auto answered =
      test::run_command("cd '" + folder_.path().string() + "' && node '" +
                        (kSource / "docs/worked/exam/mujoco_body.mjs").string() + "' '" +
                        package.output.substr(0, package.output.find('\n')) + "' < lines");
  ASSERT_EQ(answered.status, 0) << answered.errors;
  std::vector<std::string> answers;
  std::istringstream text(answered.output);
  for (std::string line; std::getline(text, line);) {
    answers.push_back(line);
  }
  ASSERT_EQ(answers.size(), 2u * (2 + kTicks) + 1) << answered.output;

  const double modulus = 1e4 * 0.7 / (1.3 * 0.4);  // lambda + 2 mu [Pa]
  const double strain = kPull + 0.5 * kPull * kPull;
  const double base = 0.5 * kSide * kSide;
  double x = 0, y = 0, z = 0;
  std::istringstream(answers[1 + kTicks]) >> x >> y >> z;
  EXPECT_NEAR(z, -base / 3.0 * (1.0 + kPull) * modulus * strain, 1e-9);

  const double mass = 1000.0 * base * kSide / 3.0;
  const double time = 1e-3 * kTicks;
  std::istringstream shape(answers.back());
  double sum = 0.0;
  for (int vertex = 0; vertex < 4 && shape >> x >> y >> z; ++vertex) {
    sum += z / 4.0;
  }
  const double exact = 0.5 * kForce / mass * time * time;
  EXPECT_GE(sum, exact * (1.0 - 1e-6));
  EXPECT_LE(sum, exact * (1.0 + 1.0 / kTicks)) << "a step takes its last velocity";
}

TEST_F(SoftExamCommandTest, BadAnswersGetASentence) {
  ASSERT_EQ(run("make exam --soft").status, 0);
  std::ofstream(folder_ / "mute.sh") << R"(while read -r word rest; do
  case $word in tick) echo 0 0 0;; *) echo ready;; esac
done
)";
  const auto sat = run("run exam --out a --program sh mute.sh");
  EXPECT_EQ(sat.status, 2);
  EXPECT_THAT(sat.errors, HasSubstr("sh answers 'ready' to 'shape'; allowed: 1875 finite numbers"));
  const auto both = run("make more --soft --rigid");
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.errors, HasSubstr("--rigid excludes --soft"));
}

/// A program that has stopped to answer ends with the command.
TEST_F(ExamCommandTest, AProgramEndsWithTheCommand) {
  ASSERT_EQ(run("make exam").status, 0);
  std::ofstream(folder_ / "silent.sh") << R"(echo $$ > process.txt
while read -r word rest; do
  case $word in tick) echo > waits; exec sleep 1000;; *) echo ready;; esac
done
)";
  for (const int signal : {SIGTERM, SIGINT}) {
    std::filesystem::remove(folder_ / "waits");
    test::LiveCommand command("exam run exam --out a --program sh silent.sh",
                              "cd '" + folder_.path().string() + "'");
    ASSERT_TRUE(command.reaches([&] { return std::filesystem::exists(folder_ / "waits"); }));
    command.signal(signal);
    const auto ended = command.wait();
    EXPECT_EQ(ended.status, 1);
    EXPECT_THAT(ended.errors, HasSubstr("cancelled"));
    pid_t process = 0;
    std::ifstream(folder_ / "process.txt") >> process;
    ASSERT_GT(process, 0);
    EXPECT_EQ(::kill(process, 0), -1) << "it runs on";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
  }
}

/// Words of the other program may look like options, known or not.
TEST_F(ExamCommandTest, AProgramGetsItsWordsWhateverTheyBeginWith) {
  ASSERT_EQ(run("make exam").status, 0);
  std::ofstream(folder_ / "words.sh") << R"(echo "$0 $*" > words.txt
while read -r word rest; do
  case $word in tick) echo 0 0 0;; *) echo ready;; esac
done
)";
  const auto sat = run("run exam --out a --program sh words.sh -u --out b --no-such 3");
  EXPECT_EQ(sat.status, 0) << sat.errors;
  std::ifstream file(folder_ / "words.txt");
  std::string words;
  std::getline(file, words);
  EXPECT_EQ(words, "words.sh -u --out b --no-such 3");
  EXPECT_EQ(run("run exam --out c --progam sh words.sh").status, 2);
}

TEST_F(ExamCommandTest, BadInputGetsASentence) {
  ASSERT_EQ(run("make exam").status, 0);
  const std::pair<const char*, const char*> bad[] = {
      {"run exam proxi --out a", "RENDERER is 'proxi'; allowed: proxy, penalty, voxel, "},
      {"run exam --out a", "exam run needs either RENDERER or --program"},
      {"run exam --out a --program no-such-program", "no-such-program cannot be started"},
      {"run exam --out a --program cat",
       "cat answers 'body stiffness 500 friction 0 rate 1000 exam/bodies/plane.obj'"},
      {"run exam --out a --program true", "true gave no line to 'body"},
      {"run nowhere proxy --out a", "nowhere/exam.json"},
      {"score exam nowhere", "nowhere/plane.csv"},
  };
  for (const auto& [line, sentence] : bad) {
    const auto result = run(line);
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(sentence));
  }
}

}  // namespace
}  // namespace haptrial::exam_command_test
