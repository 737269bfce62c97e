#include "experiments/runner/virtual_answers.h"

#include <fmt/format.h>

#include <optional>

#include "core/base/random.h"
#include "core/questions/question_kind.h"

namespace haptrial::experiments {

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

}  // namespace haptrial::experiments
