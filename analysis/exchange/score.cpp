#include "analysis/exchange/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "analysis/files/delimited.h"
#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis {
namespace {

std::vector<const Score*>& all_scores() {
  static std::vector<const Score*> scores;
  return scores;
}

std::string header() {
  std::string text;
  exchange::RowText row(text, exchange::Delimited::kCsv);
  for (const char* column :
       {"subject", "session", "pass", "trial", "phase", "score", "value", "unit"}) {
    row.add(std::string_view(column));
  }
  row.end();
  return text;
}

int add_rows(const Score& score, const record::SessionReader& session, std::string& text) {
  const std::vector<record::PassRow> passes = session.passes();
  const std::set<int> left_out = record::trials_left_out(session);
  int rows = 0;
  for (const ScoreValue& each : score.values(session)) {
    if (each.pass < 0 || static_cast<std::size_t>(each.pass) >= passes.size() ||
        !std::isfinite(each.value)) {
      throw RunError(
          fmt::format("{}: the score '{}' gives {} for pass {}; allowed: a finite number "
                      "for one of its {} passes",
                      session.path().string(), score.name(), each.value, each.pass, passes.size()));
    }
    const record::PassRow& pass = passes[static_cast<std::size_t>(each.pass)];
    if (!pass.practice && left_out.contains(pass.trial)) {
      continue;
    }
    exchange::RowText row(text, exchange::Delimited::kCsv);
    row.add(std::string_view(session.info().subject)).add(session.info().session);
    row.add(each.pass).add(static_cast<int>(pass.trial)).add(std::string_view(pass.phase.name()));
    row.add(score.name()).add(each.value).add(score.unit()).end();
    ++rows;
  }
  return rows;
}

}  // namespace

const std::vector<const Score*>& scores() { return all_scores(); }

void add_score(const Score& score) {
  const bool taken = std::any_of(all_scores().begin(), all_scores().end(),
                                 [&](const Score* other) { return other->name() == score.name(); });
  if (taken || score.name().empty()) {
    throw std::invalid_argument(
        fmt::format("add_score: there is a score '{}' already", score.name()));
  }
  all_scores().push_back(&score);
}

int write_scores(const std::vector<std::filesystem::path>& sessions,
                 const std::filesystem::path& table) {
  std::string text = header();
  int rows = 0;
  for (const std::filesystem::path& file : sessions) {
    const record::SessionReader session(file);
    for (const Score* score : all_scores()) {
      rows += add_rows(*score, session, text);
    }
  }
  write_whole(table, text);
  return rows;
}

}  // namespace haptrial::analysis
