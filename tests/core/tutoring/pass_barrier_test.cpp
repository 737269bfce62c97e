// Passes in step over a channel that loses, doubles and overtakes.

#include "core/tutoring/pass_barrier.h"

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <string>
#include <vector>

#include "core/base/random.h"

namespace haptrial::tutoring {
namespace {

using Step = PassBarrier::Step;

/// A session that presents trials of two phases until all are done. It may be aborted at any tick,
/// and then presents the trial again.
struct Session {
  PassBarrier turns;
  int trials;
  std::uint32_t trial{1};
  std::uint32_t phase{0};
  int left{0};  // ticks of the pass
  bool over{false};
  std::vector<std::string> record;

  explicit Session(int all) : trials(all) {}
  void begin(int ticks) {
    left = ticks;
    turns.begin(trial * PassBarrier::kPhases + phase);
  }
  void ended(Step step) {
    const bool done = step == Step::kComplete;
    record.push_back(std::to_string(trial) + "." + std::to_string(phase) + (done ? "" : "x"));
    if (done && phase == 0) {
      phase = 1;
      return;
    }
    trial += done || step == Step::kSkip ? 1 : 0;
    phase = 0;
    over = trial > static_cast<std::uint32_t>(trials);
  }
  std::vector<std::string> completed() const {
    std::vector<std::string> all;
    for (const std::string& each : record) {
      if (each.back() != 'x') {
        all.push_back(each);
      }
    }
    return all;
  }
};

class Two {
 public:
  explicit Two(std::uint64_t seed, int trials)
      : random_(seed, "turns"), sides_{Session(trials), Session(trials)} {}

  void tick(double loss, double abort) {
    for (int i = 0; i < 2; ++i) {
      Session& s = sides_[i];
      auto& in = to_[i];
      // Any of the last messages may come now, and the newest one counts.
      while (!in.empty() && (in.size() > 8 || random_.uniform() < 0.5)) {
        if (random_.uniform() >= loss && in.front().first > newest_[i]) {
          newest_[i] = in.front().first;
          heard_[i] = in.front().second;
        }
        in.pop_front();
      }
      if (s.over) {
        continue;
      }
      if (!s.turns.open()) {
        s.begin(1 + static_cast<int>(random_.uniform() * 20.0));
      }
      if (random_.uniform() < abort) {
        s.turns.abort();
        s.ended(Step::kBreak);
      } else {
        const Step step = s.turns.step(heard_[i], s.left <= 0, sides_[1 - i].over);
        s.left -= step == Step::kRun ? 1 : 0;
        if (step == Step::kRun) {
          running_[i] = s.trial * 2 + s.phase;
        }
        if (step != Step::kWait && step != Step::kRun && step != Step::kHold) {
          s.ended(step);
        }
      }
      to_[1 - i].push_back({++sent_, s.turns.own()});
    }
  }

  bool over() const { return sides_[0].over && sides_[1].over; }
  const Session& side(int i) const { return sides_[i]; }

 private:
  RandomStream random_;
  std::array<Session, 2> sides_;
  std::array<std::deque<std::pair<std::uint64_t, TurnState>>, 2> to_;
  std::array<std::uint64_t, 2> newest_{};
  std::array<TurnState, 2> heard_{};
  std::array<std::uint32_t, 2> running_{};
  std::uint64_t sent_{0};
};

TEST(TurnsTest, EveryPassIsCompletedOnBothSidesWhateverIsLost) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Two two(seed, 10);
    for (int i = 0; i < 100000 && !two.over(); ++i) {
      two.tick(0.5, 0.0);
    }
    ASSERT_TRUE(two.over()) << "seed " << seed;
    ASSERT_EQ(two.side(0).record.size(), 20u);
    ASSERT_EQ(two.side(0).record, two.side(1).record);
    ASSERT_EQ(two.side(0).record, two.side(0).completed());
  }
}

TEST(TurnsTest, AbortsOnEitherSideLeaveBothInStep) {
  int missed = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Two two(seed, 10);
    for (int i = 0; i < 200000 && !two.over(); ++i) {
      two.tick(0.3, 0.01);
    }
    ASSERT_TRUE(two.over()) << "seed " << seed << ": sides wait for each other";
    // Every trial ends on both sides. One may have its last pass completed at the moment at which
    // the other aborts it; the other then leaves the trial.
    for (int side = 0; side < 2; ++side) {
      missed += 20 - static_cast<int>(two.side(side).completed().size() > 20
                                          ? 20
                                          : two.side(side).completed().size());
    }
  }
  EXPECT_LT(missed, 50 * 40 / 20);
}

TEST(TurnsTest, NobodyIsWaitedForWhoIsOver) {
  PassBarrier turns;
  turns.begin(5 * PassBarrier::kPhases);
  EXPECT_EQ(turns.step({}, false, false), Step::kWait);
  EXPECT_EQ(turns.step({}, false, true), Step::kRun);
  EXPECT_FALSE(turns.together());
  EXPECT_EQ(turns.step({}, true, true), Step::kComplete);
}

TEST(TurnsTest, AWordFromThePassBeforeBeginsNothing) {
  PassBarrier turns;
  turns.begin(16);
  TurnState other{1, 1, 16, TurnPhase::kRuns, 0};
  EXPECT_EQ(turns.step(other, false, false), Step::kRun);
  turns.abort();
  turns.begin(16);  // the same again; the other side does not know yet
  EXPECT_EQ(turns.step(other, false, false), Step::kWait);
  other = {2, 0, 16, TurnPhase::kReady, 0};
  EXPECT_EQ(turns.step(other, false, false), Step::kRun);
  EXPECT_TRUE(turns.together());
}

}  // namespace
}  // namespace haptrial::tutoring
