#include "experiments/runner/session_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "analysis/files/sha256.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "core/questions/question_kind.h"
#include "core/questions/question_kinds.h"
#include "core/render/gl/image.h"
#include "core/sound/cue.h"
#include "experiments/screen/screen.h"
#include "experiments/screen/video_player.h"

namespace haptrial::experiments {
namespace {

using record::AnsweredAt;
using record::PageTime;

constexpr double kVideoShare = 0.7;  // most of the screen's height
constexpr int kVideoWidth = 1280;    // that pictures are made smaller for [px]
constexpr int kVideoHeight = 720;

std::string card_of(const protocols::Definition& definition) {
  const sound::CueSet* sounds = definition.sounds();
  return sounds != nullptr ? sounds->device : sound::CueSet().device;
}

AnsweredAt source_of(RequestSource by) {
  return by == RequestSource::kConsole ? AnsweredAt::kConsole : AnsweredAt::kTerminal;
}

std::string occasion_of(PageTime when, int block) {
  return when == PageTime::kBefore  ? "before"
         : when == PageTime::kAfter ? "after"
                                    : fmt::format("after block {}", block);
}

/// "3 / 10" on a page with several items.
std::string progress_of(const questions::Page* page, const questions::Question& item) {
  return page != nullptr && page->items.size() > 1
             ? fmt::format("{} / {}", &item - page->items.data() + 1, page->items.size())
             : "";
}

bool is_question(const questions::Question& item) {
  const questions::QuestionTraits traits = item.kind->traits();
  return traits.asks && !traits.consents;
}

/// Whether an answer says the same as one that was given before.
bool is_same(const questions::Answer& answer, const record::AnswerRow& earlier) {
  const bool no_numbers = std::isnan(answer.value) && std::isnan(earlier.value);
  return answer.text == earlier.text && (no_numbers || answer.value == earlier.value);
}

questions::Question last_look(const std::string& text) {
  const render::TextPage shown = protocols::page_of(text);
  questions::Question item;
  item.kind = &questions::reading_kind();
  item.name = "answered";
  item.title = shown.title;
  item.text = shown.body;
  return item;
}

/// Answer of a virtual participant, so that a dry run goes through every page: it consents, chooses
/// at random, and is mostly right-handed. A random stream of the item's own decides, so that the
/// answer does not depend on other items.
/// @param session_seed  of the participant
/// @param occasion      "before", "after block 2", …
questions::Answer virtual_answer(const questions::Page& page, const questions::Question& item,
                                 std::uint64_t session_seed, const std::string& occasion) {
  RandomStream random(session_seed, fmt::format("page {} {} {}", page.name, item.name, occasion));
  questions::AnswerDraft draft;
  if (page.kind == questions::PageKind::kEdinburgh) {
    constexpr int kRight = 3;  // "right", and "always right"
    draft.chosen = kRight + static_cast<int>(random.below(2));
  } else {
    item.kind->simulate(item, std::nullopt, random, draft);
  }
  return item.kind->answer(item, draft);
}

}  // namespace

SessionPages::SessionPages(const Parts& parts)
    : p_(parts),
      d_(*parts.request.definition),
      last_look_(last_look(d_.texts.answered)),
      answers_(parts.record.earlier().answers) {}

bool SessionPages::before() { return show(d_.pages.before, PageTime::kBefore, 0); }

bool SessionPages::after() { return show(d_.pages.after, PageTime::kAfter, 0); }

bool SessionPages::has_after_block(const std::string& name) const {
  return d_.pages.after_block.contains(name);
}

bool SessionPages::after_block(int block, const std::string& name, bool missed) {
  const auto found = d_.pages.after_block.find(name);
  return found == d_.pages.after_block.end() ||
         show(found->second, PageTime::kAfterBlock, block, missed);
}

bool SessionPages::show(const std::vector<std::string>& names, PageTime when, int block,
                        bool missed) {
  std::vector<Place> places;
  for (const std::string& name : names) {
    const questions::Page& page = d_.pages.page(name);
    for (const questions::Question& item : page.items) {
      if (!missed || item.kind->traits().asks) {
        places.push_back({&page, &item, when, block});
      }
    }
  }
  const auto questions =
      std::ranges::count_if(places, [](const Place& place) { return is_question(*place.item); });
  if (questions > 1 && person_answers()) {
    places.push_back({nullptr, &last_look_, when, block});
  }
  const std::size_t answers_before = answers_.size();
  std::size_t reached = 0;  // all places before it were seen
  for (std::size_t i = 0; i < places.size();) {
    if (places[i].page == nullptr && answers_.size() == answers_before) {
      break;  // nothing was asked
    }
    places[i].may_go_back = i > 0;
    const PageOutcome turn = show_item(places[i], i < reached);
    if (turn == PageOutcome::kEnd) {
      return false;
    }
    i += turn == PageOutcome::kBack ? -1 : 1;
    reached = std::max(reached, i);
  }
  return true;
}

/// Answers of an earlier run stand; texts are shown again, as instructions are.
/// @param again  the participant has gone back to it
SessionPages::PageOutcome SessionPages::show_item(const Place& place, bool again) {
  const questions::Question& item = *place.item;
  record::AnswerRow row;
  row.when = place.when;
  row.block = place.block;
  row.questionnaire = place.page == nullptr ? "" : place.page->name;
  row.item = item.name;
  const std::optional<record::AnswerRow> earlier = answer_to(row);
  if (earlier && !again) {
    declined_ = declined_ || (item.kind->traits().consents && earlier->value == 0.0);
    return declined_ ? PageOutcome::kEnd : PageOutcome::kOn;
  }
  questions::Answer answer;
  const auto begun = std::chrono::steady_clock::now();
  if (person_answers()) {
    if (const PageOutcome turn = ask(place, earlier, answer, row.source);
        turn != PageOutcome::kOn) {
      return turn;
    }
    row.duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  } else {
    answer =
        virtual_answer(*place.page, item, p_.session_seed, occasion_of(place.when, place.block));
    row.source = AnsweredAt::kVirtual;
  }
  if (!earlier || !is_same(answer, *earlier)) {
    keep(item, answer, std::move(row), earlier.has_value());
  }
  return declined_ ? PageOutcome::kEnd : PageOutcome::kOn;
}

/// @param changed  the item was answered before
void SessionPages::keep(const questions::Question& item, const questions::Answer& answer,
                        record::AnswerRow row, bool changed) {
  if (!item.kind->traits().asks) {
    return;
  }
  row.value = answer.value;
  row.text = answer.text;
  p_.record.keep_answer(row);
  if (changed) {
    p_.record.event("answer_changed", row.questionnaire + "." + row.item);
  }
  answers_.push_back(std::move(row));
  if (!answer.reason.empty()) {
    p_.record.event("consent_by_experimenter", answer.reason);
  }
  if (item.kind->traits().consents && answer.value == 0.0) {
    declined_ = true;
    p_.record.event("consent_declined", "the participant did not agree to take part");
  }
}

/// The answer that counts so far.
std::optional<record::AnswerRow> SessionPages::answer_to(const record::AnswerRow& asked) const {
  for (std::size_t i = answers_.size(); i-- > 0;) {
    if (record::is_same_item(answers_[i], asked)) {
      return answers_[i];
    }
  }
  return std::nullopt;
}

bool SessionPages::person_answers() const {
  return p_.controller.attended() || p_.screen != nullptr;
}

/// Shows the item until it is answered, left for the one before, or the session is ended.
SessionPages::PageOutcome SessionPages::ask(const Place& place,
                                            const std::optional<record::AnswerRow>& earlier,
                                            questions::Answer& answer, AnsweredAt& source) {
  const questions::Question& item = *place.item;
  PageInput input(item, d_.texts, place.may_go_back);
  if (earlier) {
    input.show_earlier({earlier->value, earlier->text});
  }
  AskedItem asked = input.asked(++asked_);
  const std::unique_ptr<VideoPlayer> video = video_of(item);
  std::shared_ptr<const render::Image> picture;
  if (!item.picture.empty()) {
    const auto file = p_.request.definition_folder / item.picture;
    asked.picture = std::make_shared<std::string>(file_text(file));
    picture =
        p_.screen == nullptr ? nullptr : std::make_shared<render::Image>(render::read_png(file));
  }
  const auto draw = [&] {
    render::TextPage shown = input.page(picture);
    shown.progress = progress_of(place.page, item);
    if (video) {
      shown.picture_share = kVideoShare;
      shown.hint = video->is_over() ? shown.hint : "";
    }
    p_.pacing.show_page(std::move(shown),
                        item.title.empty() ? item.text : item.title + "\n" + item.text);
  };
  p_.keys.set_open(true);
  p_.controller.status().asked = std::move(asked);
  PendingRequests& requests = p_.controller.requests();
  requests.back = false;
  draw();
  bool back = false;
  bool plays = video != nullptr;
  while (!input.answer() && !back && !requests.abort) {
    if (requests.stopped || requests.pause) {
      p_.pacing.pause_where_asked();
      draw();
    }
    p_.pacing.wait_a_little("page");
    if (video && (picture != video->picture() || plays == video->is_over())) {
      picture = video->picture();
      plays = !video->is_over();
      draw();
    }
    for (const render::KeyPress& key : p_.keys.pressed()) {
      const bool counts = !plays || key.key == render::KeyPress::kBackspace;
      if (counts && !input.answer() && !input.goes_back() && input.press(key)) {
        source = AnsweredAt::kWindow;
        draw();
      }
    }
    take_answers(input, source);
    if (!item.kind->traits().asks && requests.start && !input.answer()) {
      input.give("");  // the experimenter goes on
      source = AnsweredAt::kConsole;
    }
    const bool asked_back = std::exchange(requests.back, false);
    back = !input.answer() && place.may_go_back && (input.goes_back() || asked_back);
  }
  p_.controller.status().asked = {};
  p_.keys.set_open(false);
  p_.pacing.clear_text();
  if (video) {
    p_.record.event("video", fmt::format("{}: {:.1f} of {:.1f} s were shown{}{}", item.video,
                                         video->played(), video->facts().duration,
                                         video->silence().empty() ? "" : ", without sound: ",
                                         video->silence()));
  }
  if (input.answer()) {
    answer = *input.answer();
  }
  return input.answer() ? PageOutcome::kOn : back ? PageOutcome::kBack : PageOutcome::kEnd;
}

/// Null: the item has none, or nobody would see it.
std::unique_ptr<VideoPlayer> SessionPages::video_of(const questions::Question& item) {
  if (item.video.empty()) {
    return nullptr;
  }
  try {
    if (p_.screen == nullptr) {
      throw RunError("the session has no window for the participant");
    }
    const auto file = p_.request.definition_folder / item.video;
    auto video = std::make_unique<VideoPlayer>(file, kVideoWidth, kVideoHeight, card_of(d_));
    p_.record.event("video",
                    fmt::format("{}: sha256={}", item.video, analysis::sha256_of_file(file)));
    return video;
  } catch (const std::runtime_error& error) {
    p_.record.event("video", fmt::format("{}: not shown: {}", item.video, error.what()));
    return nullptr;
  }
}

/// Takes answers from elsewhere than the window. An answer that is not allowed is refused with a
/// notice.
void SessionPages::take_answers(PageInput& input, AnsweredAt& source) {
  for (const SessionControl::Message& message : p_.controller.take_answers()) {
    if (message.answers != asked_ || input.answer()) {
      continue;  // to what was asked before
    }
    const std::string problem = input.give(message.text);
    source = source_of(message.by);
    p_.controller.status().asked.hint = problem;
  }
}

}  // namespace haptrial::experiments
