#include "protocols/psychophysics/definition/block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/definition/schema.h"
#include "protocols/definition/schedule.h"

namespace haptrial::protocols {
namespace {

constexpr long kMostInBlock = 100000;

std::string as_formula(const std::optional<double>& number, const std::string& text) {
  if (number) {
    return fmt::format("{}", *number);
  }
  return text.find('$') != std::string::npos ? text : fmt::format("'{}'", text);
}

/// Every key but those that mean something else. @param description  of each
std::vector<GivenValue> read_values(Table& table, const std::vector<std::string>& others,
                                    const char* description) {
  std::vector<GivenValue> values;
  for (const std::string& key : table.keys()) {
    if (std::find(others.begin(), others.end(), key) == others.end()) {
      table.describe({key, description, "", true});
      values.push_back({key, formula_of_value(table, key)});
    }
  }
  return values;
}

const Schema<Probe>& probe_schema() {
  static const auto schema = Schema<Probe>()
                                 .text("name", &Probe::name, "Name of the probes among the trials")
                                 .number("share", &Probe::share, {0.0, 0.5, true}, "1",
                                         "Share of the block's trials that are probes")
                                 .required();
  return schema;
}

Probe read_probe(Table& table) {
  Probe probe = probe_schema().read(table);
  probe.values =
      read_values(table, {"name", "share"},
                  "Value of the name in the probes of the block: a number, formula or word");
  if (probe.values.empty()) {
    table.reject("share", "stands alone; say what a probe gives: field = \"null\"");
  }
  return probe;
}

const std::vector<std::string>& block_keys() {
  static const std::vector<std::string> keys{"name",           "trials",     "practice",
                                             "right_in_a_row", "procedures", "probe"};
  return keys;
}

constexpr const char* kRightInARow =
    "Right answers in a row with which practice ends before its last trial";

const Schema<Block>& block_schema() {
  using B = Block;
  static const auto schema =
      Schema<B>()
          .text("name", &B::name, "Name of the block")
          .required()
          .flag("practice", &B::practice, "Whether the block is practice, which is not scored")
          .integer("right_in_a_row", &B::right_in_a_row, 1, 1000, kRightInARow)
          .otherwise("all trials")
          .texts("procedures", &B::procedures,
                 "Names of the procedures that choose the levels in the block")
          .otherwise("all, unless the block gives one of their variables a value");
  return schema;
}

constexpr const char* kBlockTrials = "Trials of the block; needed without a procedure";

Block read_block(Table& table, bool procedures) {
  Block block = block_schema().read(table);
  block.values =
      read_values(table, block_keys(), "Value of the name in the block: a number, formula or word");
  table.describe({"trials", kBlockTrials, "until its procedures are finished", false});
  if (table.has("trials") || block.practice || !procedures) {
    block.trials = static_cast<int>(table.integer("trials", 1, kMostInBlock));
  }
  if (table.has("probe")) {
    Table probe = table.table("probe");
    block.probe = read_probe(probe);
  }
  return block;
}

const Schema<Block>& practice_schema() {
  using B = Block;
  static const auto schema =
      Schema<B>()
          .integer("trials", &B::trials, 1, kMostInBlock, "Trials of practice")
          .required()
          .integer("right_in_a_row", &B::right_in_a_row, 1, 1000, kRightInARow)
          .otherwise("all trials");
  return schema;
}

std::vector<Factor> read_factors(Table& root) {
  std::vector<Factor> factors;
  if (!root.has("factors")) {
    return factors;
  }
  Table table = root.table("factors");
  for (const std::string& name : table.keys()) {
    table.describe(
        {name, "Levels of the factor NAME: two or more numbers, words or formulas", "", true});
    const auto rows = table.rows(name, "two or more levels: [\"left\", \"right\"]");
    if (rows.size() != 1 || rows[0].size() < 2) {
      table.reject(name, "another list", "two or more levels: [\"left\", \"right\"]");
      continue;
    }
    factors.push_back({name, {}});
    for (const NumberOrText& level : rows[0]) {
      factors.back().levels.push_back(as_formula(level.number, level.text));
    }
  }
  return factors;
}

/// One number for combinations, or a table with a number for each factor.
std::vector<RunLimit> read_run_limits(Table& table, const std::string& key) {
  constexpr long kMostRun = 1000;
  if (!table.is_table(key)) {
    return {{"", static_cast<int>(table.integer(key, 1, kMostRun))}};
  }
  std::vector<RunLimit> limits;
  Table factors = table.table(key);
  for (const std::string& factor : factors.keys()) {
    factors.describe(
        {factor, "Most trials of one level of the factor NAME that follow each other", "", true});
    limits.push_back({factor, static_cast<int>(factors.integer(factor, 1, kMostRun))});
  }
  return limits;
}

const Schema<TrialDesign>& trial_design_schema() {
  using D = TrialDesign;
  constexpr long kMostSessions = 100;
  static const auto schema =
      Schema<D>()
          .integer("participants", &D::participants, 1, 100000, "Participants of the study")
          .required()
          .integer("break_after", &D::break_after, 0, kMostInBlock,
                   "Trials after which a break comes; 0: no breaks")
          .number("break_duration", &D::break_duration, {0.0, 36000.0}, "s", "Duration of a break")
          .custom("blocks", "Order of the blocks over participants",
                  [](Table& table, const std::string& key, D& d) {
                    d.order = balance_named(
                        table.choice(key, {"fixed", "latin", "williams", "full", "random"}));
                  })
          .otherwise("fixed")
          .custom("most_in_a_row",
                  "Most trials of one combination of factors that follow each other, or of one "
                  "level of a factor: 3, or { FACTOR = 3 }",
                  [](Table& table, const std::string& key, D& d) {
                    d.most_in_a_row = read_run_limits(table, key);
                  })
          .otherwise("no limit")
          .choice("trials", &D::trial_order,
                  {{"cycles", TrialOrder::kCycles},
                   {"shuffled", TrialOrder::kShuffled},
                   {"random", TrialOrder::kRandom}},
                  "Order of the trials of a block without procedures: every combination of factors "
                  "once before any comes again, all equally often in one random order, or each "
                  "trial drawn anew")
          .integer("sessions", &D::sessions, 1, kMostSessions,
                   "Sessions of each participant, on days of their own");
  return schema;
}

/// The places of the blocks that a session names.
std::vector<std::size_t> read_session(Table& session, const std::vector<Block>& blocks) {
  std::vector<std::string> names;
  for (const Block& block : blocks) {
    names.push_back(block.name);
  }
  session.describe({"blocks",
                    "Blocks of the session of this number; without [design.session] every session "
                    "has all of them",
                    "", true});
  std::vector<std::size_t> places;
  for (const std::string& name : session.texts("blocks")) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) {
      session.reject("blocks", fmt::format("an array with \"{}\"", name),
                     fmt::format("blocks of the definition: {}", fmt::join(names, ", ")));
    } else {
      places.push_back(static_cast<std::size_t>(at - names.begin()));
    }
  }
  return places;
}

/// A name that two blocks have says nothing, and a block of no session would never come.
void check_sessions(Table& design, const TrialDesign& d) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < d.blocks.size(); ++i) {
    const std::string& name = d.blocks[i].name;
    if (!names.insert(name).second) {
      design.reject("session", fmt::format("names blocks, and two are called \"{}\"; give each a "
                                           "name of its own",
                                           name));
    }
    const bool presented = std::any_of(d.by_session.begin(), d.by_session.end(), [i](auto& each) {
      return std::find(each.begin(), each.end(), i) != each.end();
    });
    if (!presented) {
      design.reject("session", fmt::format("leaves out the block \"{}\"; add it to the blocks of "
                                           "a session, or delete it",
                                           name));
    }
  }
}

void read_sessions(Table& root, TrialDesign& d) {
  d.session_plans =
      read_session_plans(root, d.sessions, "its blocks", [&](Table& session, int number) {
        d.by_session.resize(static_cast<std::size_t>(number));
        d.by_session.back() = read_session(session, d.blocks);
      });
  if (!d.session_plans.empty()) {
    d.by_session.resize(d.session_plans.size());
    Table design = root.table("design");
    check_sessions(design, d);
  }
}

}  // namespace

std::vector<std::size_t> TrialDesign::blocks_of(int session) const {
  const auto at = static_cast<std::size_t>(std::max(1, session) - 1);
  if (at < by_session.size()) {
    return by_session[at];
  }
  std::vector<std::size_t> all(blocks.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::string formula_of_value(Table& table, const std::string& key) {
  if (const auto text = table.whole_text(key)) {
    return as_formula(std::nullopt, *text);
  }
  return as_formula(table.number(key, {}, ""), "");
}

std::string shown_level(const std::string& formula) {
  const bool quoted = formula.size() > 1 && formula.front() == '\'';
  return quoted ? formula.substr(1, formula.size() - 2) : formula;
}

std::vector<std::vector<GivenValue>> crossed(const std::vector<const Factor*>& factors) {
  std::vector<std::vector<GivenValue>> all{{}};
  for (const Factor* factor : factors) {
    std::vector<std::vector<GivenValue>> longer;
    for (const auto& combination : all) {
      for (const std::string& level : factor->levels) {
        longer.push_back(combination);
        longer.back().push_back({factor->name, level});
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::vector<std::string> levels_of(const std::vector<GivenValue>& values) {
  std::vector<std::string> levels;
  for (const GivenValue& value : values) {
    levels.push_back(shown_level(value.formula));
  }
  return levels;
}

TrialDesign read_trial_design(Table& root, bool procedures) {
  Table design = root.table("design");
  TrialDesign d = trial_design_schema().read(design);
  d.break_until_ready = read_break_until_ready(design, d.break_after);
  d.factors = read_factors(root);
  if (root.has("practice")) {
    Table table = root.table("practice");
    Block practice = practice_schema().read(table);
    practice.name = "practice";
    practice.practice = true;
    practice.values = read_values(table, {"trials", "right_in_a_row"},
                                  "Value of the name during practice: a number, formula or word");
    d.blocks.push_back(std::move(practice));
  }
  if (root.has("blocks")) {
    for (Table& table : root.tables("blocks")) {
      d.blocks.push_back(read_block(table, procedures));
    }
  } else if (procedures) {
    d.blocks.emplace_back().name = "main";
  } else {
    root.reject("design", "has nothing to present; add a [procedure] or [[blocks]]");
  }
  if (d.trial_order == TrialOrder::kRandom && !d.most_in_a_row.empty()) {
    design.reject("most_in_a_row",
                  "is a rule for the order, but trials = \"random\" draws each trial without one; "
                  "keep one of the two");
  }
  read_sessions(root, d);
  return d;
}

}  // namespace haptrial::protocols
