#include "protocols/psychophysics/definition/script_plan.h"

#include <fmt/format.h>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::protocols {
namespace {

ScriptPlan read_script(Table& table, double deadline, double longest) {
  ScriptPlan plan;
  plan.file = table.text("file");
  plan.deadline = table.number_or("deadline", deadline, {0.05, longest}, "s");
  return plan;
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
  return read_script(table, 2.0, 10.0);
}

std::optional<ScriptPlan> read_decision_script(Table& observer) {
  if (!observer.has("script")) {
    return std::nullopt;
  }
  Table table = observer.table("script");
  return read_script(table, 60.0, 600.0);
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
