#include "core/pages/read_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/definition/schema.h"
#include "core/pages/known_questionnaires.h"

namespace haptrial::pages {
namespace {

constexpr std::size_t kLongestText = 4000;  // [bytes]; more would not be legible on a screen
constexpr std::size_t kMostChoices = 12;
constexpr double kMostSteps = 200.0;  // of a scale

const Schema<Item>& title_schema() {
  static const auto schema =
      Schema<Item>()
          .shown_text("title", &Item::title, kLongestText, "Heading of the page")
          .otherwise("none");
  return schema;
}

const Schema<Item>& reading_schema() {
  static const auto schema = Schema<Item>()
                                 .shown_text("text", &Item::text, kLongestText, "Text of the page")
                                 .required()
                                 .text("picture", &Item::picture,
                                       "Picture on the page, a PNG file relative to the definition")
                                 .otherwise("none");
  return schema;
}

Item reading(Table& table, const char* name, ItemKind kind) {
  Item item;
  item.name = name;
  item.kind = kind;
  title_schema().read(table, item);
  reading_schema().read(table, item);
  return item;
}

struct ConsentWords {
  std::string accept{"I agree to take part"};
  std::string decline{"I do not agree"};
};

const Schema<ConsentWords>& consent_schema() {
  using W = ConsentWords;
  static const auto schema =
      Schema<W>()
          .shown_text("accept", &W::accept, "Words of the choice of people who take part")
          .shown_text("decline", &W::decline,
                      "Words of the choice of people who do not take part, "
                      "which ends the session");
  return schema;
}

Item consent(Table& table) {
  Item item = reading(table, "consent", ItemKind::kConsent);
  const ConsentWords words = consent_schema().read(table);
  item.choices = {{"accepted", words.accept, 1.0}, {"declined", words.decline, 0.0}};
  return item;
}

/// Gives an entry of a list its name, which files and translations have.
void name_entry(Table& table, const char* key, const std::string& name) {
  if (name.size() > kNameBytes || name.find('.') != std::string::npos) {
    table.reject(key, fmt::format("\"{}\"", name),
                 fmt::format("a name without a point, of at most {} bytes", kNameBytes));
  }
  table.name_entry(name);
}

const Schema<ItemChoice>& choice_schema() {
  using C = ItemChoice;
  static const auto schema =
      Schema<C>()
          .text("value", &C::value, "Value of the choice in files")
          .required()
          .check([](Table& table, C& choice) {
            name_entry(table, "value", choice.value);
            choice.label = choice.value;
          })
          .shown_text("label", &C::label, "Words of the choice that participants read")
          .otherwise("the value")
          .number("number", &C::number, {}, "", "Number that a choice counts as in scores")
          .otherwise("none");
  return schema;
}

void take_choices(Table& table, Item& item) {
  std::vector<Table> choices = table.tables("choices");
  if (choices.size() < 2 || choices.size() > kMostChoices) {
    table.reject("choices", fmt::format("a list of {}", choices.size()),
                 fmt::format("2 to {} choices", kMostChoices));
  }
  std::set<std::string> values;
  for (Table& each : choices) {
    ItemChoice choice = choice_schema().read(each);
    if (!values.insert(choice.value).second) {
      each.reject("value", fmt::format("\"{}\"", choice.value), "a value that no other choice has");
    }
    item.choices.push_back(std::move(choice));
  }
}

void read_range(Table& table, const std::string& key, Item& item) {
  const std::vector<double> range = table.numbers(key, {}, "");
  if (range.size() != 2 || range[1] <= range[0]) {
    table.reject(key, "another list", "[lowest, highest]");
    return;
  }
  item.low = range[0];
  item.high = range[1];
}

void check_steps(Table& table, Item& item) {
  const double steps = (item.high - item.low) / item.step;
  if (std::abs(steps - std::round(steps)) > 1e-9 * steps || steps > kMostSteps) {
    table.reject(table.has("step") ? "step" : "scale", fmt::format("{} steps long", steps),
                 fmt::format("a whole number of steps, at most {}", kMostSteps));
  }
}

const Schema<Item>& ends_schema() {
  static const auto schema =
      Schema<Item>()
          .shown_text("low", &Item::low_end, "Words at the lowest value of a scale")
          .required()
          .shown_text("high", &Item::high_end, "Words at the highest value of a scale")
          .required();
  return schema;
}

const Schema<Item>& scale_schema() {
  static const auto schema =
      Schema<Item>()
          .custom("scale", "Lowest and highest value of a scale on which a mark is moved",
                  read_range)
          .otherwise("choices, a number or words")
          .number("step", &Item::step, {0.0, 1e9, true}, "",
                  "Distance between neighbouring values of a scale")
          .check(check_steps)
          .custom("ends", "Words at both ends of a scale",
                  [](Table& table, const std::string& key, Item& item) {
                    Table ends = table.table(key);
                    ends_schema().read(ends, item);
                  })
          .otherwise("none");
  return schema;
}

const Schema<Item>& number_schema() {
  static const auto schema =
      Schema<Item>()
          .custom("number", "Lowest and highest number that may be typed", read_range)
          .otherwise("choices, a scale or words");
  return schema;
}

const Schema<Item>& question_schema() {
  static const auto schema =
      Schema<Item>()
          .text("name", &Item::name, "Name of the question in files")
          .required()
          .check([](Table& table, Item& item) { name_entry(table, "name", item.name); })
          .shown_text("question", &Item::text, kLongestText, "Text of the question")
          .required()
          .custom("words",
                  "Whether the answer is any typed words; else the question has choices, a scale "
                  "or a number",
                  [](Table& table, const std::string& key, Item& item) {
                    item.kind = table.boolean(key) ? ItemKind::kText : item.kind;
                  })
          .otherwise("false");
  return schema;
}

Item question(Table& table) {
  Item item = question_schema().read(table);
  const bool words = item.kind == ItemKind::kText;
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
    scale_schema().read(table, item);
  } else if (table.has("number")) {
    item.kind = ItemKind::kNumber;
    number_schema().read(table, item);
  }
  return item;
}

std::vector<Item> questions(Table& table) {
  std::vector<Item> items;
  const std::string title = title_schema().read(table).title;
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

const Schema<Page>& page_schema() {
  static const auto schema =
      Schema<Page>()
          .choice("kind", &Page::kind,
                  {{"text", PageKind::kText},
                   {"consent", PageKind::kConsent},
                   {"nasa_tlx", PageKind::kNasaTlx},
                   {"edinburgh", PageKind::kEdinburgh},
                   {"questions", PageKind::kQuestions}},
                  "Kind of the page: a text, consent, a known questionnaire, or questions of the "
                  "definition")
          .flag("weighted", &Page::weighted,
                "Whether the NASA-TLX also asks its 15 pairs of scales, which weight the ratings")
          .only_if([](const Page& page) { return page.kind == PageKind::kNasaTlx; });
  return schema;
}

Page read_page(Table& table, const std::string& name) {
  Page page = page_schema().read(table);
  page.name = name;
  if (page.kind == PageKind::kConsent) {
    page.items = {consent(table)};
  } else if (page.kind == PageKind::kNasaTlx) {
    page.items = known(table, nasa_tlx_items(page.weighted));
  } else if (page.kind == PageKind::kEdinburgh) {
    page.items = known(table, edinburgh_items());
  } else if (page.kind == PageKind::kQuestions) {
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

/// Keys that say when pages are shown, once all pages are read.
const Schema<PagePlan>& order_schema() {
  static const auto schema =
      Schema<PagePlan>()
          .custom("before", "Names of the pages before the first trial, in their order",
                  [](Table& table, const std::string& key, PagePlan& plan) {
                    plan.before = names_of(table, key, plan);
                  })
          .otherwise("none")
          .custom("after", "Names of the pages after the last trial, in their order",
                  [](Table& table, const std::string& key, PagePlan& plan) {
                    plan.after = names_of(table, key, plan);
                  })
          .otherwise("none");
  return schema;
}

void read_after_block(Table& table, PagePlan& plan) {
  for (const std::string& block : table.keys()) {
    table.describe(
        {block, "Names of the pages after the last trial of the block of this name", "", true});
    plan.after_block[block] = names_of(table, block, plan);
  }
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
  order_schema().read(table, plan);
  if (table.has("after_block")) {
    Table blocks = table.table("after_block");
    read_after_block(blocks, plan);
  }
  check_use(table, plan);
  return plan;
}

}  // namespace haptrial::pages
