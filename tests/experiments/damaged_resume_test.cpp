// `--resume` on a file that a power cut damaged: every chunk of it in turn is lost.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/file_text.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/recovered_rows.h"
#include "core/record/rows/session_tables.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::damaged_resume_test {
namespace {

namespace fs = std::filesystem;
using record::PassStatus;

const char* const kFollowsAnswers = R"([experiment]
protocol = "trials"
name = "follows"
[design]
participants = 4
mirror_left_handed = true
[fields.pull]
type = "constant"
force = [0.0, "-$level", 0.0]  # downwards [N]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.25 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "staircase"
variable = "level"
unit = "N"
start = 0.5
steps = [0.1]
down = 1
up = 1
range = [0.0, 1.0]
estimate = { of = "mean of levels" }
counts = "$answer == 1"
stop = { trials = 8 }
[observer]
decides = "yes"
criterion = 0.25   # [N]
force_floor = 0.01 # [N]
reaction = 0.1
[observer.actions]
feel = { do = "hold" }
)";

constexpr int kTrials = 8;

class DamagedResumeTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kThreadSanitizer) {
      GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
    }
    test::write_text(folder_ / "study.toml", kFollowsAnswers);
    experiment_ = load_experiment(folder_ / "study.toml");
    fs::create_directories(out());
    SessionRequest request = test::session_request(experiment_, out() / "P01.h5", 3, "P01");
    test::run_and_kill(request, 1900);
    killed_ = file_text(partial());
    ASSERT_GT(record::SessionReader(partial()).passes().size(), 3U);
  }

  fs::path out() const { return folder_ / "out"; }
  fs::path partial() const { return out() / "P01.h5.partial"; }

  /// Resumes by command the killed session, of which some bytes became zeros.
  test::CommandResult resume(std::uint64_t first, std::uint64_t bytes) const {
    fs::remove_all(out());
    fs::create_directories(out());
    std::string damaged = killed_;
    damaged.replace(first, bytes, bytes, '\0');
    test::write_text(partial(), damaged);
    return test::run_command("haptrial run '" + (folder_ / "study.toml").string() +
                             "' --subject P01 --device virtual --resume --out '" + out().string() +
                             "'");
  }

  /// Trials that were not aborted come once each, and each level follows from the answer before.
  void expect_that_levels_follow() const {
    const record::SessionReader file(out() / "P01.h5");
    const std::vector<record::PassRow> passes = file.passes();
    const auto of = [&](std::int32_t pass) { return passes.at(static_cast<std::size_t>(pass)); };
    std::map<int, double> levels, answers;  // by the trial
    for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
      if (of(row.pass).status != PassStatus::kAborted) {
        EXPECT_TRUE(levels.emplace(of(row.pass).trial, row.applied).second);
      }
    }
    for (const record::ResponseRow& row : file.responses()) {
      if (of(row.pass).status != PassStatus::kAborted) {
        answers[row.trial] = row.value;
      }
    }
    ASSERT_EQ(levels.size(), kTrials);
    for (int trial = 1; trial < kTrials; ++trial) {
      ASSERT_TRUE(levels.contains(trial + 1) && answers.contains(trial)) << trial;
      const double step = answers.at(trial) == 1.0 ? -0.1 : 0.1;
      EXPECT_NEAR(levels.at(trial + 1), levels.at(trial) + step, 1e-6) << trial;
    }
  }

  test::TemporaryFolder folder_;
  Experiment experiment_;
  std::string killed_;
};

struct Chunk {
  std::uint64_t offset{0};
  bool samples{false};
};

/// The chunks of a file, the superblock among them.
std::vector<Chunk> chunks_of(const std::string& file) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
  const std::size_t row = record::samples_table().schema().row_bytes();
  std::vector<Chunk> chunks{{}};
  record::scan_chunks(bytes, 1 << 22, [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
    chunks.push_back({offset, raw.size() > 500 * row});
  });
  return chunks;
}

TEST_F(DamagedResumeTest, AnyChunkMayBeLost) {
  const std::vector<Chunk> chunks = chunks_of(killed_);
  ASSERT_GT(chunks.size(), 6U);
  for (const Chunk& chunk : chunks) {
    SCOPED_TRACE(chunk.offset);
    const test::CommandResult done = resume(chunk.offset, 96);
    EXPECT_EQ(done.status, 0) << done.errors;
    ASSERT_TRUE(fs::exists(out() / "P01.h5")) << done.output;
    if (chunk.samples) {
      expect_that_levels_follow();
    }
  }
}

}  // namespace
}  // namespace haptrial::experiments::damaged_resume_test
