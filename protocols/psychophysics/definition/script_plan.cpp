#include "protocols/psychophysics/definition/script_plan.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::protocols {
namespace {

/// @param deadline  unless the definition states it; @param longest  that it may be [s]
Schema<ScriptPlan> make_script_schema(double deadline, double longest, std::string file_words,
                                      std::string deadline_words) {
  using P = ScriptPlan;
  return Schema<P>()
      .derive([deadline](P& plan) { plan.deadline = deadline; })
      .custom("file", std::move(file_words),
              [](Table& table, const std::string& key, P& plan) { plan.file = table.text(key); })
      .required()
      .number("deadline", &P::deadline, {0.05, longest}, "s", std::move(deadline_words));
}

const Schema<ScriptPlan>& level_script_schema() {
  static const auto schema = make_script_schema(
      2.0, 10.0,
      "Program or Python script (.py) beside the definition that chooses the levels between trials",
      "Longest time for an answer of the script while a person waits; without one it has a minute");
  return schema;
}

}  // namespace

std::optional<ScriptPlan> read_level_script(Table& root) {
  if (!root.has("level_script")) {
    return std::nullopt;
  }
  Table table = root.table("level_script");
  if (!root.has("procedure") && !root.has("procedures")) {
    root.reject("level_script", "stands without a [procedure]",
                "a procedure beside it, whose levels are presented where the script gives none");
  }
  return level_script_schema().read(table);
}

const Schema<ScriptPlan>& decision_script_schema() {
  static const auto schema =
      make_script_schema(60.0, 600.0,
                         "Program or Python script (.py) beside the definition by which virtual "
                         "participants answer",
                         "Longest time for an answer of the script");
  return schema;
}

void load_script(ScriptPlan& plan, const std::filesystem::path& folder) {
  if (plan.file.is_relative()) {
    plan.file = folder / plan.file;
  }
  constexpr std::size_t kMost = 200'000;  // [bytes]; every session file keeps it
  plan.text = file_text(plan.file);
  if (plan.text.empty() || plan.text.size() > kMost) {
    throw InputError(fmt::format("{}: holds {} bytes; allowed: a script of 1 to {} bytes",
                                 plan.file.string(), plan.text.size(), kMost));
  }
}

}  // namespace haptrial::protocols
