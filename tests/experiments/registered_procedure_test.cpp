// A kind of procedure that no file of the product knows (docs/worked/own): a definition states it,
// virtual participants run it, a killed session resumes it, and the report has its estimate.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "docs/worked/own/robbins_monro.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::registered_procedure_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int kTrials = 16;
constexpr double kStart = 1.8, kGain = 0.8, kTarget = 0.6, kLow = 0.2, kHigh = 2.0;

const std::string kDefinition = R"([experiment]
protocol = "trials"
name = "pull"
[design]
participants = 2
[fields.pull]
type = "constant"
force = [0.0, "-$level", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.3 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "robbins_monro"
variable = "level"
unit = "N"
range = [0.2, 2.0]
start = 1.8
gain = 0.8
target = 0.6
stop = { trials = 16 }
counts = "$answer == 1"
expect = { threshold = 1.0, width = 1.0, guess = 0.0 }
[observer]
decides = "yes"
criterion = { median = 1.0, spread = 0.3 }
force_weber = 0.2
force_floor = 0.0
reaction = 0.05
[observer.actions]
feel = { do = "hold" }
)";

class RegisteredProcedureTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { robbins_monro::add(); }

  Experiment load(const std::string& text) const {
    test::write_text(folder_ / "pull.toml", text);
    return load_experiment(folder_ / "pull.toml");
  }
  SessionRequest request_for(const Experiment& experiment, const std::string& name) const {
    return test::session_request(experiment, folder_ / name, 7);
  }
  test::TemporaryFolder folder_;
};

struct Done {
  std::vector<double> asked, outcomes;
  bool operator==(const Done&) const = default;
};

/// Levels and outcomes of completed passes.
Done done_of(const record::SessionReader& file) {
  Done done;
  const auto passes = file.passes();
  for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
    if (passes.at(static_cast<std::size_t>(row.pass)).status == record::PassStatus::kCompleted) {
      done.asked.push_back(row.asked);
      done.outcomes.push_back(row.outcome);
    }
  }
  return done;
}

/// The rule written once more. @returns the level after each outcome, the start first
std::vector<double> levels_after(const std::vector<double>& outcomes) {
  std::vector<double> levels{kStart};
  for (const double outcome : outcomes) {
    const double step = kGain / static_cast<double>(levels.size()) * (outcome - kTarget);
    levels.push_back(std::min(kHigh, std::max(kLow, levels.back() - step)));
  }
  return levels;
}

TEST_F(RegisteredProcedureTest, ItsKeysAreReadAsThoseOfOthers) {
  const Experiment good = load(kDefinition);
  EXPECT_THAT(good.definition->description(),
              testing::Contains(HasSubstr("robbins_monro of level [N], at most 16 trials")));
  EXPECT_THAT(good.definition->description(),
              testing::Contains(HasSubstr("(simulated); the level with 60.0 % correct is ")));
  const auto with = [](const std::string& line, const std::string& instead) {
    std::string text = kDefinition;
    return text.replace(text.find(line), line.size(), instead);
  };
  const auto sentence = [this](const std::string& text) { return [this, text] { load(text); }; };
  EXPECT_THAT(sentence(with("gain = 0.8", "gain = 0")),
              ThrowsMessage<InputError>(HasSubstr("procedure.gain is 0; allowed: ")));
  EXPECT_THAT(sentence(with("gain = 0.8", "gian = 0.8")),
              ThrowsMessage<InputError>(HasSubstr("procedure.gian is not a known key; did you mean "
                                                  "gain?")));
  EXPECT_THAT(sentence(with("start = 1.8", "start = 2.8")),
              ThrowsMessage<InputError>(HasSubstr("within the range, 0.2 to 2")));
  EXPECT_THAT(sentence(with("\"robbins_monro\"", "\"robins_monro\"")),
              ThrowsMessage<InputError>(HasSubstr("magnitude, robbins_monro")));
  EXPECT_THAT(sentence(with("counts = \"$answer == 1\"", "counts = \"$answer - 1.5\"")),
              ThrowsMessage<InputError>(HasSubstr("allowed: 0 or 1; say what it learns")));
}

TEST_F(RegisteredProcedureTest, GuessingIsComparedWithTheShareThatItSeeks) {
  std::string text = kDefinition;
  for (const auto& [what, instead] :
       {std::pair<std::string, std::string>{"counts = \"$answer == 1\"\n", ""},
        {"target = 0.6", "target = 0.4"},
        {"[procedure]", "correct = \"1\"\n[procedure]"}}) {
    text.replace(text.find(what), what.size(), instead);
  }
  EXPECT_THAT([&] { load(text); },
              ThrowsMessage<InputError>(HasSubstr("is in balance at 40 % right answers")));
}

TEST_F(RegisteredProcedureTest, ATakenWordIsRefused) {
  EXPECT_THAT([] { robbins_monro::add(); },
              ThrowsMessage<std::invalid_argument>(
                  "add_kind_of_procedure: there is a procedure 'robbins_monro' already"));
}

TEST_F(RegisteredProcedureTest, VirtualParticipantsRunItAndTheReportHasItsEstimate) {
  const Experiment experiment = load(kDefinition);
  std::vector<double> last;
  for (const char* name : {"S01", "S02"}) {
    SessionRequest request = request_for(experiment, std::string(name) + ".h5");
    request.subject = name;
    request.participant = static_cast<int>(last.size());
    run_session(request);
    const record::SessionReader file(request.file);
    EXPECT_TRUE(record::check_session(file, known_tables()).ok);
    const Done done = done_of(file);
    ASSERT_EQ(done.asked.size(), static_cast<std::size_t>(kTrials));
    const std::vector<double> wanted = levels_after(done.outcomes);
    for (std::size_t i = 0; i < done.asked.size(); ++i) {
      EXPECT_NEAR(done.asked[i], wanted[i], 1e-12) << i;
    }
    last.push_back(wanted.back());
  }
  AnalysisRequest request;
  request.folder = folder_.path();
  request.files = study_files(request.folder, Pilots::kLeftOut, protocol_of);
  request.out = folder_ / "report";
  experiment.study->analyze(request);
  EXPECT_THAT(test::read_text(request.out / "report.html"),
              HasSubstr("threshold, level after the last trial"));
  const auto table = analysis::CsvTable::load(request.out / "estimates.csv");
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, table.column("source")) == "procedure") {
      rows.push_back(row);
    }
  }
  const std::vector<double> reported = table.numbers(table.column("estimate"), rows);
  ASSERT_EQ(reported.size(), last.size());
  for (std::size_t i = 0; i < last.size(); ++i) {
    EXPECT_NEAR(reported[i], last[i], 1e-9);
  }
}

TEST_F(RegisteredProcedureTest, LiveAndKilledItGoesOnAsItWouldHave) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  const Experiment experiment = load(kDefinition);
  run_session(request_for(experiment, "whole.h5"));
  const Done whole = done_of(record::SessionReader(folder_ / "whole.h5"));
  test::run_and_kill(request_for(experiment, "killed.h5"), 2000);
  const Done kept = done_of(record::SessionReader((folder_ / "killed.h5").string() + ".partial"));
  EXPECT_GE(kept.asked.size(), 2u);
  EXPECT_LT(kept.asked.size(), whole.asked.size());
  SessionRequest request = request_for(experiment, "killed.h5");
  request.clock = realtime::ClockKind::kReal;
  request.resume = true;
  run_session(request);
  const record::SessionReader resumed(folder_ / "killed.h5");
  EXPECT_TRUE(record::check_session(resumed, known_tables()).ok);
  EXPECT_EQ(done_of(resumed), whole);
}

}  // namespace
}  // namespace haptrial::experiments::registered_procedure_test
