#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace haptrial::pages {

/// Kind of an item of a page.
enum class ItemKind {
  kRead,     // read, and gone on from
  kConsent,  // accepted or declined: choices 0 and 1
  kChoice,
  kScale,   // a mark is moved between two ends
  kNumber,  // typed
  kText     // typed, in any words
};

struct ItemChoice {
  std::string value;                                        // what is recorded
  std::string label;                                        // what is shown
  double number{std::numeric_limits<double>::quiet_NaN()};  // recorded as the value; NaN: none
};

/// One screenful of a page.
struct Item {
  std::string name;  // unlike every other's of its page
  ItemKind kind{ItemKind::kRead};
  std::string title;  // may be empty
  std::string text;   // the question
  std::vector<ItemChoice> choices;
  double low{0.0}, high{100.0};   // of scales and numbers
  double step{1.0};               // of scales
  std::string low_end, high_end;  // words at the ends of a scale; may be empty
  std::string picture;            // PNG file, as the definition names it; empty: none
};

enum class PageKind { kText, kConsent, kNasaTlx, kEdinburgh, kQuestions };

/// A page of a definition: screenfuls that follow each other.
struct Page {
  std::string name;
  PageKind kind{PageKind::kText};
  bool weighted{false};  // NASA-TLX with its 15 pairs
  std::vector<Item> items;
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

/// Bounds of what is recorded [bytes].
inline constexpr std::size_t kNameBytes = 64;
inline constexpr std::size_t kTextBytes = 1000;

}  // namespace haptrial::pages
