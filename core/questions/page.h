#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/questions/question.h"

namespace haptrial::questions {

enum class PageKind { kText, kConsent, kNasaTlx, kEdinburgh, kQuestions };

/// A page of a definition: screenfuls that follow each other.
struct Page {
  std::string name;
  PageKind kind{PageKind::kText};
  bool weighted{false};                    // NASA-TLX with its 15 pairs
  std::vector<questions::Question> items;  // each unlike the others in its name
};

/// The pages of a session and when each is shown.
struct PagePlan {
  std::vector<Page> pages;
  std::vector<std::string> before;                              // names, before everything else
  std::vector<std::string> after;                               // after the last trial
  std::map<std::string, std::vector<std::string>> after_block;  // by the block's name

  bool empty() const { return pages.empty(); }
  /// @throws std::invalid_argument if there is none of that name
  const Page& page(const std::string& name) const;
};

}  // namespace haptrial::questions
