#include "core/pages/read_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/definition/table.h"
#include "core/pages/known_questionnaires.h"

namespace haptrial::pages {
namespace {

constexpr std::size_t kLongestText = 4000;  // [bytes]; more would not be legible on a screen
constexpr std::size_t kMostChoices = 12;
constexpr double kMostSteps = 200.0;  // of a scale

std::string text_of(Table& table, const char* key) {
  std::string text = table.shown_text(key);
  if (text.size() > kLongestText) {
    table.reject(key, fmt::format("{} bytes long", text.size()),
                 fmt::format("at most {} bytes", kLongestText));
  }
  return text;
}

void take_title(Table& table, Item& item) {
  if (table.has("title")) {
    item.title = text_of(table, "title");
  }
}

Item reading(Table& table, const char* name, ItemKind kind) {
  Item item;
  item.name = name;
  item.kind = kind;
  take_title(table, item);
  item.text = text_of(table, "text");
  if (table.has("picture")) {
    item.picture = table.text("picture");
  }
  return item;
}

Item consent(Table& table) {
  Item item = reading(table, "consent", ItemKind::kConsent);
  item.choices = {{"accepted", table.shown_text("accept", "I agree to take part"), 1.0},
                  {"declined", table.shown_text("decline", "I do not agree"), 0.0}};
  return item;
}

void take_name(Table& table, const char* key, std::string& name) {
  name = table.text(key);
  if (name.size() > kNameBytes || name.find('.') != std::string::npos) {
    table.reject(key, fmt::format("\"{}\"", name),
                 fmt::format("a name without a point, of at most {} bytes", kNameBytes));
  }
}

void take_choices(Table& table, Item& item) {
  std::vector<Table> choices = table.tables("choices");
  if (choices.size() < 2 || choices.size() > kMostChoices) {
    table.reject("choices", fmt::format("a list of {}", choices.size()),
                 fmt::format("2 to {} choices", kMostChoices));
  }
  std::set<std::string> values;
  for (Table& each : choices) {
    ItemChoice choice;
    take_name(each, "value", choice.value);
    each.name_entry(choice.value);
    choice.label = each.shown_text("label", choice.value);
    choice.number = each.has("number") ? each.number("number", {}, "")
                                       : std::numeric_limits<double>::quiet_NaN();
    if (!values.insert(choice.value).second) {
      each.reject("value", fmt::format("\"{}\"", choice.value), "a value that no other choice has");
    }
    item.choices.push_back(std::move(choice));
  }
}

void take_range(Table& table, const char* key, Item& item) {
  const std::vector<double> range = table.numbers(key, {}, "");
  if (range.size() != 2 || range[1] <= range[0]) {
    table.reject(key, "another list", "[lowest, highest]");
    return;
  }
  item.low = range[0];
  item.high = range[1];
}

void take_scale(Table& table, Item& item) {
  take_range(table, "scale", item);
  if (table.has("step")) {
    item.step = table.number("step", {0.0, 1e9, true}, "");
  }
  const double steps = (item.high - item.low) / item.step;
  if (std::abs(steps - std::round(steps)) > 1e-9 * steps || steps > kMostSteps) {
    table.reject(table.has("step") ? "step" : "scale", fmt::format("{} steps long", steps),
                 fmt::format("a whole number of steps, at most {}", kMostSteps));
  }
  if (table.has("ends")) {
    Table ends = table.table("ends");
    item.low_end = ends.shown_text("low");
    item.high_end = ends.shown_text("high");
  }
}

Item question(Table& table) {
  Item item;
  take_name(table, "name", item.name);
  table.name_entry(item.name);
  item.text = text_of(table, "question");
  const bool words = table.has("words") && table.boolean("words");
  const int kinds = (table.has("choices") ? 1 : 0) + (table.has("scale") ? 1 : 0) +
                    (table.has("number") ? 1 : 0) + (words ? 1 : 0);
  if (kinds != 1) {
    table.reject("question",
                 "has no one way to be answered; state one of choices, scale, number, words");
  } else if (table.has("choices")) {
    item.kind = ItemKind::kChoice;
    take_choices(table, item);
  } else if (table.has("scale")) {
    item.kind = ItemKind::kScale;
    take_scale(table, item);
  } else if (table.has("number")) {
    item.kind = ItemKind::kNumber;
    take_range(table, "number", item);
  } else {
    item.kind = ItemKind::kText;
  }
  return item;
}

std::vector<Item> questions(Table& table) {
  std::vector<Item> items;
  const std::string title = table.has("title") ? text_of(table, "title") : "";
  std::set<std::string> names;
  for (Table& each : table.tables("items")) {
    items.push_back(question(each));
    items.back().title = title;
    if (!names.insert(items.back().name).second) {
      each.reject("name", fmt::format("\"{}\"", items.back().name),
                  "a name that no other item of the page has");
    }
  }
  return items;
}

/// The texts of a questionnaire that the program has, for other languages.
std::vector<Item> known(Table& table, std::vector<Item> items) {
  for (Item& item : items) {
    const auto shown = [&](const char* what, std::string& text) {
      if (!text.empty()) {
        text = table.shown_as(fmt::format("{}.{}", item.name, what), text);
      }
    };
    shown("title", item.title);
    shown("text", item.text);
    shown("low", item.low_end);
    shown("high", item.high_end);
    for (ItemChoice& choice : item.choices) {
      choice.label =
          table.shown_as(fmt::format("{}.{}.label", item.name, choice.value), choice.label);
    }
  }
  return items;
}

Page read_page(Table& table, const std::string& name) {
  Page page;
  page.name = name;
  const std::string kind =
      table.has("kind")
          ? table.choice("kind", {"text", "consent", "nasa_tlx", "edinburgh", "questions"})
          : "text";
  if (kind == "consent") {
    page.kind = PageKind::kConsent;
    page.items = {consent(table)};
  } else if (kind == "nasa_tlx") {
    page.kind = PageKind::kNasaTlx;
    page.weighted = table.has("weighted") && table.boolean("weighted");
    page.items = known(table, nasa_tlx_items(page.weighted));
  } else if (kind == "edinburgh") {
    page.kind = PageKind::kEdinburgh;
    page.items = known(table, edinburgh_items());
  } else if (kind == "questions") {
    page.kind = PageKind::kQuestions;
    page.items = questions(table);
  } else {
    page.items = {reading(table, "read", ItemKind::kRead)};
  }
  return page;
}

/// The names of pages under a key, each of a page that is there.
std::vector<std::string> names_of(Table& table, const std::string& key, const PagePlan& plan) {
  std::vector<std::string> names = table.texts(key);
  for (const std::string& name : names) {
    const bool there = std::any_of(plan.pages.begin(), plan.pages.end(),
                                   [&](const Page& page) { return page.name == name; });
    if (!there) {
      table.reject(key, fmt::format("a list with \"{}\"", name),
                   "names of pages, each with a table [pages.NAME]");
    } else if (std::count(names.begin(), names.end(), name) > 1) {
      table.reject(key, fmt::format("a list with \"{}\" twice", name), "each page once");
    }
  }
  return names;
}

bool is_when(const std::string& key) {
  return key == "before" || key == "after" || key == "after_block";
}

/// A page that nobody is shown is a mistake; consent comes before anything is done.
void check_use(Table& table, const PagePlan& plan) {
  for (const Page& page : plan.pages) {
    const auto has = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), page.name) != names.end();
    };
    const bool later =
        has(plan.after) || std::any_of(plan.after_block.begin(), plan.after_block.end(),
                                       [&](const auto& each) { return has(each.second); });
    if (!later && !has(plan.before)) {
      table.reject(page.name, "is never shown; name it in before, after or after_block");
    } else if (later && page.kind == PageKind::kConsent) {
      table.reject(page.name, "asks for consent when the session is under way; name it in before");
    }
  }
}

}  // namespace

PagePlan read_pages(Table& root) {
  PagePlan plan;
  if (!root.has("pages")) {
    return plan;
  }
  Table table = root.table("pages");
  for (const std::string& name : table.keys_as_written()) {
    if (is_when(name)) {
      continue;
    }
    if (name.size() > kNameBytes) {
      table.reject(name, "has too long a name", fmt::format("at most {} bytes", kNameBytes));
    }
    Table page = table.table(name);
    plan.pages.push_back(read_page(page, name));
  }
  if (table.has("before")) {
    plan.before = names_of(table, "before", plan);
  }
  if (table.has("after")) {
    plan.after = names_of(table, "after", plan);
  }
  if (table.has("after_block")) {
    Table blocks = table.table("after_block");
    for (const std::string& block : blocks.keys()) {
      plan.after_block[block] = names_of(blocks, block, plan);
    }
  }
  check_use(table, plan);
  return plan;
}

}  // namespace haptrial::pages
