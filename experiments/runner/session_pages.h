#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/questions/page.h"
#include "experiments/control/session_controller.h"
#include "experiments/runner/loop_pacing.h"
#include "experiments/runner/page_input.h"
#include "experiments/runner/session_record.h"
#include "experiments/runner/session_request.h"

namespace haptrial::experiments {

class Screen;
class VideoPlayer;

/// Shows the pages of a definition and records what is answered: in the participant's window, on
/// the console or in the terminal alike; without any of them, and on a simulated clock, a virtual
/// participant answers. What an earlier run recorded is not asked again. Among pages that follow
/// each other a participant may go back and change answers. Session's thread.
class SessionPages {
 public:
  /// All of them outlive the pages.
  struct Parts {
    const SessionRequest& request;
    SessionRecord& record;
    SessionController& controller;
    LoopPacing& pacing;
    PageKeys& keys;
    Screen* screen{nullptr};
    std::uint64_t session_seed{0};
  };
  explicit SessionPages(const Parts& parts);

  /// @returns false if the participant did not consent, or the experimenter ended the session
  bool before();
  /// Shows the pages after the last trial of a block. @param block  number of it @param name  the
  /// definition's
  /// @param missed  of an earlier run: only what it left unanswered is asked
  bool after_block(int block, const std::string& name, bool missed = false);
  bool has_after_block(const std::string& name) const;
  bool after();
  /// Whether the participant did not consent, in this run or an earlier one.
  bool declined() const { return declined_; }

 private:
  /// An item of the pages that follow each other, and when they do.
  struct Place {
    const questions::Page* page;  // null: the last look at all answers
    const questions::Question* item;
    record::PageTime when;
    int block;
    bool may_go_back{false};
  };
  enum class PageOutcome { kOn, kBack, kEnd };

  bool show(const std::vector<std::string>& names, record::PageTime when, int block,
            bool missed = false);
  PageOutcome show_item(const Place& place, bool again);
  PageOutcome ask(const Place& place, const std::optional<record::AnswerRow>& earlier,
                  questions::Answer& answer, record::AnsweredAt& source);
  void keep(const questions::Question& item, const questions::Answer& answer, record::AnswerRow row,
            bool changed);
  std::optional<record::AnswerRow> answer_to(const record::AnswerRow& asked) const;
  std::unique_ptr<VideoPlayer> video_of(const questions::Question& item);
  void take_answers(PageInput& input, record::AnsweredAt& source);
  bool person_answers() const;

  Parts p_;
  const protocols::Definition& d_;
  questions::Question last_look_;           // after several questions
  std::vector<record::AnswerRow> answers_;  // of earlier runs and this one
  int asked_{0};
  bool declined_{false};
};

}  // namespace haptrial::experiments
