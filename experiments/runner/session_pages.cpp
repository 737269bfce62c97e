#include "experiments/runner/session_pages.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/base/files/file_text.h"
#include "core/render/gl/image.h"
#include "experiments/pages/virtual_answers.h"
#include "experiments/runner/earlier_run.h"
#include "experiments/screen/screen.h"

namespace haptrial::experiments {
namespace {

using pages::ItemKind;
using record::AnsweredAt;
using record::PageTime;

AnsweredAt source_of(RequestSource by) {
  return by == RequestSource::kConsole ? AnsweredAt::kConsole : AnsweredAt::kTerminal;
}

std::string occasion_of(PageTime when, int block) {
  return when == PageTime::kBefore  ? "before"
         : when == PageTime::kAfter ? "after"
                                    : fmt::format("after block {}", block);
}

/// "3 / 10" on a page with several items; the item is one of the page's.
std::string progress_of(const pages::Page& page, const pages::Item& item) {
  return page.items.size() > 1
             ? fmt::format("{} / {}", &item - page.items.data() + 1, page.items.size())
             : "";
}

}  // namespace

SessionPages::SessionPages(const Parts& parts) : p_(parts), d_(*parts.request.definition) {}

bool SessionPages::before() { return show(d_.pages.before, PageTime::kBefore, 0); }

bool SessionPages::after() { return show(d_.pages.after, PageTime::kAfter, 0); }

bool SessionPages::after_block(int block, const std::string& name, bool missed) {
  const auto found = d_.pages.after_block.find(name);
  return found == d_.pages.after_block.end() ||
         show(found->second, PageTime::kAfterBlock, block, missed);
}

bool SessionPages::show(const std::vector<std::string>& names, PageTime when, int block,
                        bool missed) {
  for (const std::string& name : names) {
    const pages::Page& page = d_.pages.page(name);
    for (const pages::Item& item : page.items) {
      const bool read_before = missed && item.kind == ItemKind::kRead;
      if (!read_before && !show_item(page, item, when, block)) {
        return false;
      }
    }
  }
  return true;
}

/// Answers of an earlier run stand; texts are shown again, as instructions are.
bool SessionPages::show_item(const pages::Page& page, const pages::Item& item, PageTime when,
                             int block) {
  record::AnswerRow row;
  row.when = when;
  row.block = block;
  row.questionnaire = page.name;
  row.item = item.name;
  if (const auto earlier = answer_to(p_.record.earlier(), row)) {
    declined_ = declined_ || (item.kind == ItemKind::kConsent && earlier->value == 0.0);
    return !declined_;
  }
  PageAnswer answer;
  const auto begun = std::chrono::steady_clock::now();
  if (person_answers()) {
    if (!ask(page, item, answer, row.source)) {
      return false;
    }
    row.duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  } else {
    answer = virtual_answer(page, item, p_.session_seed, occasion_of(when, block));
    row.source = AnsweredAt::kVirtual;
  }
  if (item.kind != ItemKind::kRead) {
    row.value = answer.value;
    row.text = answer.text;
    p_.record.keep_answer(row);
  }
  if (!answer.reason.empty()) {
    p_.record.event("consent_by_experimenter", answer.reason);
  }
  if (item.kind == ItemKind::kConsent && answer.value == 0.0) {
    declined_ = true;
    p_.record.event("consent_declined", "the participant did not agree to take part");
  }
  return !declined_;
}

bool SessionPages::person_answers() const {
  return p_.controller.attended() || p_.screen != nullptr;
}

/// Shows the item until it is answered. @returns false if the session is ended meanwhile
bool SessionPages::ask(const pages::Page& page, const pages::Item& item, PageAnswer& answer,
                       AnsweredAt& source) {
  PageInput input(item, d_.texts);
  AskedItem asked = input.asked(++asked_);
  std::shared_ptr<const render::Image> picture;
  if (!item.picture.empty()) {
    const auto file = p_.request.definition_folder / item.picture;
    asked.picture = std::make_shared<std::string>(file_text(file));
    picture =
        p_.screen == nullptr ? nullptr : std::make_shared<render::Image>(render::read_png(file));
  }
  const auto draw = [&] {
    render::TextPage shown = input.page(picture);
    shown.progress = progress_of(page, item);
    p_.pacing.show_page(std::move(shown),
                        item.title.empty() ? item.text : item.title + "\n" + item.text);
  };
  p_.keys.set_open(true);
  p_.controller.status().asked = std::move(asked);
  draw();
  const PendingRequests& requests = p_.controller.requests();
  while (!input.answer() && !requests.abort) {
    if (requests.stopped || requests.pause) {
      p_.pacing.pause_where_asked();
      draw();
    }
    p_.pacing.wait_a_little("page");
    for (const render::KeyPress& key : p_.keys.pressed()) {
      if (!input.answer() && input.press(key)) {
        source = AnsweredAt::kWindow;
        draw();
      }
    }
    take_answers(input, source);
    if (item.kind == ItemKind::kRead && requests.start && !input.answer()) {
      input.give("");  // the experimenter goes on
      source = AnsweredAt::kConsole;
    }
  }
  p_.controller.status().asked = {};
  p_.keys.set_open(false);
  p_.pacing.clear_text();
  if (input.answer()) {
    answer = *input.answer();
  }
  return input.answer().has_value();
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
