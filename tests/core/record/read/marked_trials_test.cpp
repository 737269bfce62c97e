#include "core/record/read/marked_trials.h"

#include <gtest/gtest.h>

#include "core/record/hdf5/session_writer.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::marked_trials_test {
namespace {

constexpr std::int64_t kTick = 1'000'000;  // [ns]: 1 kHz

/// A session whose passes follow each other, 100 ticks each, without samples: times are by rate.
class MarkedTrialsTest : public testing::Test {
 protected:
  SessionInfo info(const std::string& rule) const {
    SessionInfo info = test::example_info();
    info.rate = 1000.0;
    info.definition = rule.empty() ? "[experiment]\n" : "[analysis]\n" + rule + "\n";
    return info;
  }
  void add(int trial, int attempt, PassStatus status, const char* phase = "test",
           int repetition = 1) {
    PassRow row{trial, "haptic", Phase(phase)};
    row.attempt = attempt;
    row.status = status;
    row.repetition = repetition;
    row.first_sample = 100 * passes_.size();
    row.last_sample = row.first_sample + 99;
    passes_.push_back(row);
  }
  /// @param tick  of the mark
  void mark(const std::string& text, std::int64_t tick) {
    marks_.push_back({tick * kTick, "bad_trial", text});
  }
  std::vector<MarkedTrial> marks(const std::string& rule) {
    const std::filesystem::path file = folder_ / (std::to_string(++files_) + ".h5");
    SessionWriter writer(file, info(rule));
    for (const PassRow& pass : passes_) {
      writer.add_pass(pass);
    }
    for (const EventRow& event : marks_) {
      writer.add_event(event);
    }
    writer.close();
    left_out_ = trials_left_out(SessionReader(file));
    return marked_trials(SessionReader(file));
  }

  test::TemporaryFolder folder_;
  std::vector<PassRow> passes_;
  std::vector<EventRow> marks_;
  std::set<int> left_out_;
  int files_{0};
};

TEST_F(MarkedTrialsTest, OnlyTheRuleLeavesTrialsOut) {
  add(1, 1, PassStatus::kCompleted);
  add(2, 1, PassStatus::kCompleted);
  add(3, 1, PassStatus::kCompleted);
  mark("trial 1: The phone rang", 50);
  mark("trial 3: hand slipped", 250);
  mark("practice trial 2: slipped", 260);
  mark("before the first trial", 0);
  const auto without = marks("");
  ASSERT_EQ(without.size(), 3u);
  EXPECT_EQ(without[0].trial, 1);
  EXPECT_EQ(without[0].reason, "The phone rang");
  EXPECT_EQ(without[0].time_ns, 50 * kTick);
  EXPECT_TRUE(without[2].practice);
  EXPECT_TRUE(left_out_.empty());
  marks("exclude_marked = true");
  EXPECT_EQ(left_out_, (std::set<int>{1, 3})) << "practice is none of the study's trials";
  marks("exclude_marked = true\nexclude_words = [\"PHONE\", \"door\"]");
  EXPECT_EQ(left_out_, std::set<int>{1});
  marks("exclude_marked = true\nexclude_words = [\"hon\", \"slip\"]");
  EXPECT_TRUE(left_out_.empty()) << "parts of words";
  marks("exclude_marked = false");
  EXPECT_TRUE(left_out_.empty());
}

TEST_F(MarkedTrialsTest, AMarkIsOnTheAttemptDuringWhichItCame) {
  add(1, 1, PassStatus::kAborted);    // ticks 0 to 99
  add(2, 1, PassStatus::kCompleted);  // 100 to 199
  add(1, 2, PassStatus::kCompleted);  // 200 to 299
  mark("trial 1: sneezed", 60);
  EXPECT_TRUE(marks("exclude_marked = true")[0].presented_again);
  EXPECT_TRUE(left_out_.empty()) << "the attempt that is analysed is not the marked one";
  mark("trial 1: slipped", 290);
  const auto both = marks("exclude_marked = true");
  EXPECT_FALSE(both[1].presented_again);
  EXPECT_EQ(left_out_, std::set<int>{1});
}

TEST_F(MarkedTrialsTest, ADrillingThatGoesOnWithItsBoneIsTheMarkedOne) {
  add(1, 1, PassStatus::kAborted, "drilling", 1);
  add(1, 2, PassStatus::kCompleted, "drilling", 1);
  mark("trial 1: table bumped", 60);
  marks("exclude_marked = true");
  EXPECT_EQ(left_out_, std::set<int>{1});
  add(1, 3, PassStatus::kCompleted, "drilling", 2);  // on a fresh bone
  marks("exclude_marked = true");
  EXPECT_TRUE(left_out_.empty());
}

}  // namespace
}  // namespace haptrial::record::marked_trials_test
