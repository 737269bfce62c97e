#include "analysis/exchange/bids_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "analysis/exchange/columns.h"
#include "analysis/exchange/pass_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"

namespace haptrial::exchange::bids {
namespace {

using record::AnswerRow;
using record::PageTime;

const char* word_of(PageTime when) {
  return when == PageTime::kBefore ? "before" : when == PageTime::kAfter ? "after" : "after_block";
}

/// One showing of a page: its answers by item.
struct Showing {
  const Session* session;
  PageTime when;
  std::int32_t block;
  std::map<std::string, std::string> answers;
};

struct Page {
  std::string questionnaire;
  std::vector<ColumnDoc> items;
  std::vector<Showing> showings;
};

Page& page_of(const std::string& questionnaire, std::vector<Page>& pages) {
  const auto at = std::ranges::find(pages, questionnaire, &Page::questionnaire);
  return at != pages.end() ? *at : pages.emplace_back(Page{questionnaire, {}, {}});
}

/// The column of an item's answers; the columns of every page have their names already.
std::string column_of(const std::string& item) {
  const auto taken = {"participant_id", "session_id", "when", "after_block"};
  return std::ranges::find(taken, item) != taken.end() ? item + "_answer" : item;
}

void add_answer(const Session& session, const AnswerRow& row, std::vector<Page>& pages) {
  if (row.item == "consent") {
    return;
  }
  Page& page = page_of(row.questionnaire, pages);
  const std::string column = column_of(row.item);
  merge_columns({{column, "", fmt::format("the answer to {}", row.item)}}, page.items);
  const bool same = !page.showings.empty() && page.showings.back().session == &session &&
                    page.showings.back().when == row.when &&
                    page.showings.back().block == row.block;
  if (!same) {
    page.showings.push_back({&session, row.when, row.block, {}});
  }
  page.showings.back().answers[column] =
      std::isfinite(row.value) ? fmt::format("{}", row.value) : row.text;
}

std::vector<ColumnDoc> docs_of(const Page& page, bool several) {
  std::vector<ColumnDoc> docs{{"participant_id", "", "the subject's label in this data set"}};
  if (several) {
    docs.push_back({"session_id", "", "the session's label in this data set"});
  }
  docs.push_back({"when",
                  "",
                  "when the page was shown",
                  {{"before", "before the first trial"},
                   {"after_block", "after the trials of a block"},
                   {"after", "after the last trial"}}});
  docs.push_back({"after_block", "", "the block after which the page was shown; 0: none"});
  merge_columns(page.items, docs);
  return docs;
}

std::string table_of(const Page& page, bool several, Delimited kind) {
  std::string text = heading(docs_of(page, several), kind);
  RowText row(text, kind);
  for (const Showing& showing : page.showings) {
    row.add(showing.session->subject);
    if (several) {
      row.add(showing.session->session);
    }
    row.add(word_of(showing.when)).add(showing.block);
    for (const ColumnDoc& item : page.items) {
      const auto answer = showing.answers.find(item.name);
      row.add(answer != showing.answers.end() ? answer->second : std::string());
    }
    row.end();
  }
  return text;
}

}  // namespace

std::vector<Phenotype> phenotypes(std::span<const Session> sessions, Delimited kind) {
  std::vector<Page> pages;
  bool several = false;
  for (const Session& session : sessions) {
    several = several || !session.session.empty();
    const record::SessionReader reader(session.source.file);
    const std::vector<AnswerRow> rows = reader.rows<AnswerRow>();
    const std::vector<bool> standing = record::standing_answers(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (standing[i]) {
        add_answer(session, rows[i], pages);
      }
    }
  }
  std::vector<Phenotype> made;
  std::set<std::string> names;
  for (const Page& page : pages) {
    const std::string label = bids_label(page.questionnaire);
    std::string name = label.empty() ? "page" : label;
    for (int number = 2; !names.insert(name).second; ++number) {
      name = fmt::format("{}{}", label.empty() ? "page" : label, number);
    }
    made.push_back({name, table_of(page, several, kind), docs_of(page, several)});
  }
  return made;
}

}  // namespace haptrial::exchange::bids
