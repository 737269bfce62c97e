#pragma once

#include <map>
#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::pages {

/// What is done with one screenful.
enum class ItemKind {
  kRead,     // read, and gone on from
  kConsent,  // accepted or declined: choices 0 and 1
  kChoice,
  kScale,   // a mark is moved between two ends
  kNumber,  // typed
  kText     // typed, in any words
};

struct ItemChoice {
  std::string value;   // what is recorded
  std::string label;   // what is shown
  double number{0.0};  // what is recorded as the value; NaN: it has none
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
  /// Whether a page wants more than to be read.
  bool asks() const;
};

/// Bounds of what is recorded [bytes].
inline constexpr std::size_t kNameBytes = 64;
inline constexpr std::size_t kTextBytes = 1000;

/// Reads [pages] of a definition; a definition without has none. Keys in brackets are optional.
///
///     [before], [after]  names of pages, in their order
///     [after_block]      { BLOCK = [names], … }
///     [pages.NAME]
///     kind      "text" (as if left out), "consent", "nasa_tlx", "edinburgh" or "questions"
///     [title], text, [picture]         of text and consent; the picture is a PNG file
///     [accept], [decline]              of consent: what the two choices say
///     [weighted]                       of nasa_tlx: true also asks the 15 pairs
///     [title], items                   of questions: [[pages.NAME.items]]
///     name, question                   of an item, and one of
///     choices   [{ value, [label], [number] }, …]
///     scale     [lowest, highest], with [step], [ends] = { low, high }
///     number    [lowest, highest]
///     words     true: any text
PagePlan read_pages(Table& root);

}  // namespace haptrial::pages
