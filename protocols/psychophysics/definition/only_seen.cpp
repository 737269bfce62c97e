#include "protocols/psychophysics/definition/only_seen.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "core/base/definition/table.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/speech_options.h"
#include "protocols/psychophysics/definition/question.h"

namespace haptrial::protocols {
namespace {

std::vector<std::string> texts_or_none(Table& table, const char* key) {
  return table.has(key) ? table.texts(key) : std::vector<std::string>{};
}

/// Whether a field leads the hand somewhere.
bool leads(Table& root, const std::string& field) {
  static const std::set<std::string> kLeading{"spring", "minimum_jerk", "path", "curve"};
  if (!root.has("fields") || !root.table("fields").has(field)) {
    return false;
  }
  const auto type = root.table("fields").table(field).whole_text("type");
  return type && kLeading.contains(*type);
}

/// Names everything that a stage shows and nothing else carries.
std::vector<std::string> only_seen_in(Table& root, Table& stage) {
  const std::vector<std::string> fields = texts_or_none(stage, "fields");
  const bool led =
      std::ranges::any_of(fields, [&root](const std::string& field) { return leads(root, field); });
  std::vector<std::string> seen;
  if (led || stage.has("sound")) {
    return seen;
  }
  std::ranges::copy_if(texts_or_none(stage, "show"), std::back_inserter(seen),
                       [&](const std::string& name) {
                         return name != "hand" && name != "interval_number" && name != "null" &&
                                std::ranges::find(fields, name) == fields.end();
                       });
  return seen;
}

void add_choices(const TrialQuestion& question, std::vector<std::string>& sentences) {
  for (std::size_t i = 0; i < question.means.size(); ++i) {
    if (question.means[i].keys == 0 && !question.means[i].silent) {
      sentences.push_back(fmt::format(
          "the choice \"{}\" of \"{}\" has no key, and speech names keys alone; give it `keys`, or "
          "say in its label how it is given",
          question.choices[i].value, question.name));
    }
  }
}

}  // namespace

std::vector<std::string> only_seen(const Definition& definition,
                                   const std::vector<TrialQuestion>& questions) {
  std::vector<std::string> sentences;
  if (!speech_of(definition).spoken) {
    return sentences;
  }
  Table root = definition.root();
  for (Table& stage : root.tables("stages")) {
    const std::vector<std::string> seen = only_seen_in(root, stage);
    if (!seen.empty()) {
      sentences.push_back(fmt::format(
          "the stage \"{}\" shows {}, which speech does not tell and no force or sound carries; a "
          "blind participant cannot do it",
          stage.text("name"), fmt::join(seen, ", ")));
    }
  }
  for (const TrialQuestion& question : questions) {
    add_choices(question, sentences);
  }
  return sentences;
}

}  // namespace haptrial::protocols
