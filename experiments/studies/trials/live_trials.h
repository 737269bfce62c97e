#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/live_figures.h"
#include "core/record/rows/response.h"
#include "core/record/trials/trial_rows.h"

namespace haptrial::experiments {

/// The trials of a running session: level, answer, and how many answers were right so far. A trial
/// that was presented again counts as it was answered the last time; one that comes again because
/// its answer was out of time counts when it comes.
class LiveTrials final : public record::LiveFigures {
 public:
  /// @param unit     of the levels, for people
  /// @param resumed  file of the earlier run, whose right answers count too; empty: none
  LiveTrials(std::string unit, const std::filesystem::path& resumed);

  void begin_pass(const record::PassRow& pass, std::int32_t row) override;
  void rows(const record::Rows& rows) override;
  void end_pass(const record::PassRow& pass) override;
  std::optional<record::LiveState> now() const override;
  std::vector<record::LiveState> done() const override;
  std::string trouble() const override;

 private:
  struct Trial {
    int number{0};
    bool practice{false};
    bool ended{false};
    std::string level;
    std::vector<std::string> answers;
    bool wrong{false};
    bool again{false};  // it comes again, and this answer does not count
  };
  struct Judged {
    int right{0}, answers{0};
  };
  record::LiveState state_of(const Trial& trial) const;
  void add(const record::ResponseRow& row);
  void add_resumed(const std::filesystem::path& file);

  mutable std::mutex mutex_;
  std::string unit_;
  std::map<std::int32_t, Trial> trials_;  // by row of /trials
  std::int32_t present_{-1};
  std::map<int, Judged> judged_;  // by number of the trial
  std::string trouble_;
};

}  // namespace haptrial::experiments
