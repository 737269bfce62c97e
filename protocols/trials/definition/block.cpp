#include "protocols/trials/definition/block.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/table.h"

namespace haptrial::protocols {
namespace {

constexpr long kMostInBlock = 100000;

std::string as_formula(const std::optional<double>& number, const std::string& text) {
  if (number) {
    return fmt::format("{:.17g}", *number);
  }
  return text.find('$') != std::string::npos ? text : fmt::format("'{}'", text);
}

/// Every key but those that mean something else.
std::vector<GivenValue> read_values(Table& table, const std::vector<std::string>& others) {
  std::vector<GivenValue> values;
  for (const std::string& key : table.keys()) {
    if (std::find(others.begin(), others.end(), key) == others.end()) {
      values.push_back({key, formula_of_value(table, key)});
    }
  }
  return values;
}

Probe read_probe(Table& table) {
  Probe probe;
  probe.name = table.has("name") ? table.text("name") : "probe";
  probe.share = table.number("share", {0.0, 0.5, true}, "1");
  probe.values = read_values(table, {"name", "share"});
  if (probe.values.empty()) {
    table.reject("share", "stands alone; say what a probe gives: field = \"null\"");
  }
  return probe;
}

const std::vector<std::string>& block_keys() {
  static const std::vector<std::string> keys{"name", "trials", "practice", "right_in_a_row",
                                             "probe"};
  return keys;
}

Block read_block(Table& table, bool procedures) {
  Block block;
  block.name = table.text("name");
  block.practice = table.has("practice") && table.boolean("practice");
  block.values = read_values(table, block_keys());
  if (table.has("right_in_a_row")) {
    block.right_in_a_row = static_cast<int>(table.integer("right_in_a_row", 1, 1000));
  }
  if (table.has("trials") || block.practice || !procedures) {
    block.trials = static_cast<int>(table.integer("trials", 1, kMostInBlock));
  }
  if (table.has("probe")) {
    Table probe = table.table("probe");
    block.probe = read_probe(probe);
  }
  return block;
}

std::vector<Factor> read_factors(Table& root) {
  std::vector<Factor> factors;
  if (!root.has("factors")) {
    return factors;
  }
  Table table = root.table("factors");
  for (const std::string& name : table.keys()) {
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

void read_order(Table& design, TrialDesign& d) {
  if (design.has("blocks")) {
    d.order =
        balance_named(design.choice("blocks", {"fixed", "latin", "williams", "full", "random"}));
  }
  if (design.has("most_in_a_row")) {
    d.most_in_a_row = static_cast<int>(design.integer("most_in_a_row", 1, 1000));
  }
}

}  // namespace

std::string formula_of_value(Table& table, const std::string& key) {
  if (const auto text = table.whole_text(key)) {
    return as_formula(std::nullopt, *text);
  }
  return as_formula(table.number(key, {}, ""), "");
}

TrialDesign read_trial_design(Table& root, bool procedures) {
  TrialDesign d;
  Table design = root.table("design");
  d.participants = static_cast<int>(design.integer("participants", 1, 100000));
  if (design.has("break_after")) {
    d.break_after = static_cast<int>(design.integer("break_after", 0, kMostInBlock));
  }
  if (design.has("break_duration")) {
    d.break_duration = design.number("break_duration", {0.0, 36000.0}, "s");
  }
  read_order(design, d);
  d.factors = read_factors(root);
  if (root.has("practice")) {
    Table table = root.table("practice");
    d.blocks.push_back({"practice", static_cast<int>(table.integer("trials", 1, kMostInBlock)),
                        true, 0, read_values(table, {"trials", "right_in_a_row"}), std::nullopt});
    if (table.has("right_in_a_row")) {
      d.blocks.back().right_in_a_row = static_cast<int>(table.integer("right_in_a_row", 1, 1000));
    }
  }
  if (root.has("blocks")) {
    for (Table& table : root.tables("blocks")) {
      d.blocks.push_back(read_block(table, procedures));
    }
  } else if (procedures) {
    d.blocks.push_back({"main", 0, false, 0, {}, std::nullopt});
  } else {
    root.reject("design", "has nothing to present; add a [procedure] or [[blocks]]");
  }
  return d;
}

}  // namespace haptrial::protocols
