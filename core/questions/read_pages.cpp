#include "core/questions/read_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/base/definition/schema.h"
#include "core/questions/kind_parts.h"
#include "core/questions/known_questionnaires.h"
#include "core/questions/question_kinds.h"

namespace haptrial::questions {
namespace {

using questions::Question;

const Schema<Question>& question_schema() {
  static const auto schema =
      Schema<Question>()
          .text("name", &Question::name, "Name of the question in files")
          .required()
          .check(
              [](Table& table, Question& item) { questions::name_entry(table, "name", item.name); })
          .shown_text("question", &Question::text, questions::kLongestText, "Text of the question")
          .required();
  return schema;
}

Question read_item(Table& table) {
  Question item = question_schema().read(table);
  const auto& kinds = questions::kinds_of_question();
  if (const auto* kind = questions::stated_kind(table, kinds)) {
    item.kind = kind;
    kind->read(table, item);
  } else {
    table.reject("question", fmt::format("has no one way to be answered; state one of {}",
                                         questions::keys_of_kinds(kinds)));
  }
  return item;
}

std::vector<Question> read_items(Table& table) {
  std::vector<Question> items;
  const std::string title = questions::title_schema().read(table).title;
  std::set<std::string> names;
  for (Table& each : table.tables("items")) {
    items.push_back(read_item(each));
    items.back().title = title;
    if (!names.insert(items.back().name).second) {
      each.reject("name", fmt::format("\"{}\"", items.back().name),
                  "a name that no other item of the page has");
    }
  }
  return items;
}

/// The texts of a questionnaire that the program has, for other languages.
std::vector<Question> known(Table& table, std::vector<Question> items) {
  for (Question& item : items) {
    const auto shown = [&](const char* what, std::string& text) {
      if (!text.empty()) {
        text = table.shown_as(fmt::format("{}.{}", item.name, what), text);
      }
    };
    shown("title", item.title);
    shown("text", item.text);
    shown("low", item.low_end);
    shown("high", item.high_end);
    for (questions::Choice& choice : item.choices) {
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

/// The one question of a page that has no list of them.
Question read_alone(Table& table, const questions::QuestionKind& kind, const char* name) {
  Question item;
  item.name = name;
  item.kind = &kind;
  kind.read(table, item);
  return item;
}

Page read_page(Table& table, const std::string& name) {
  Page page = page_schema().read(table);
  page.name = name;
  if (page.kind == PageKind::kConsent) {
    page.items = {read_alone(table, questions::consent_kind(), "consent")};
  } else if (page.kind == PageKind::kNasaTlx) {
    page.items = known(table, nasa_tlx_items(page.weighted));
  } else if (page.kind == PageKind::kEdinburgh) {
    page.items = known(table, edinburgh_items());
  } else if (page.kind == PageKind::kQuestions) {
    page.items = read_items(table);
  } else {
    page.items = {read_alone(table, questions::reading_kind(), "read")};
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
    if (name.size() > questions::kNameBytes) {
      table.reject(name, "has too long a name",
                   fmt::format("at most {} bytes", questions::kNameBytes));
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

}  // namespace haptrial::questions
