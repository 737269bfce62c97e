#include "core/bone/hint/hint_setup.h"

#include <fmt/format.h>

#include <vector>

#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::hint {
namespace {

constexpr std::array<const char*, kHintKinds> kTexts{"Press more lightly (near {structure})",
                                                     "Slow down (near {structure})",
                                                     "You cannot see what you are drilling"};
constexpr std::string_view kStructure = "{structure}";

void read_kinds(Table& table, HintSetup& setup) {
  setup.kinds.fill(!table.has("kinds"));
  if (!table.has("kinds")) {
    table.otherwise("kinds", "all three");
    return;
  }
  const std::vector<std::string> words = table.texts("kinds");
  bool known = true;
  for (const std::string& word : words) {
    bool found = false;
    for (const HintKind kind : kAllHintKinds) {
      if (word == name_of(kind)) {
        found = setup.kinds[static_cast<std::size_t>(kind)] = true;
      }
    }
    known = known && found;
  }
  if (!known) {
    table.reject("kinds", "something else", "a list of \"force\", \"speed\" and \"hidden\"");
  }
}

}  // namespace

std::string_view name_of(HintKind kind) noexcept {
  constexpr std::array<std::string_view, kHintKinds> kNames{"force", "speed", "hidden"};
  return kNames[static_cast<std::size_t>(kind)];
}

HintSetup read_hint_setup(Table& table) {
  HintSetup s;
  read_kinds(table, s);
  s.shown = read_given_in(table, "shown_in");
  if (table.has("file")) {
    s.file = table.text("file");
  } else if (s.needs_limits()) {
    table.reject(table.has("kinds") ? "kinds" : "file",
                 "needs a file with safe limits: name one that haptrial bone safe wrote as "
                 "hints.file, or set hints.kinds to [\"hidden\"]");
  }
  s.reach = table.number_or("reach", s.reach, {0.0, 0.03, true}, "m");
  s.fewest = table.integer_or("fewest", s.fewest, 1, 1000);
  s.within = table.number_or("within", s.within, {0.0, 10.0, true}, "s");
  s.holds = table.number_or("holds", s.holds, {0.1, 60.0}, "s");
  s.sound = table.has("sound") && table.boolean("sound");
  for (const HintKind kind : kAllHintKinds) {
    const auto i = static_cast<std::size_t>(kind);
    const std::string key = fmt::format("{}_text", name_of(kind));
    table.otherwise(key, kTexts[i]);
    s.texts[i] = table.shown_text(key, kTexts[i]);
  }
  return s;
}

void load_limits(HintSetup& setup, const std::filesystem::path& folder) {
  if (setup.file.empty()) {
    return;
  }
  const std::filesystem::path file = folder / setup.file;
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(fmt::format(
        "hints.file: {}: no such file; haptrial bone safe makes one from the sessions of "
        "experts",
        file.string()));
  }
  setup.limits = load_safe_limits(file);
}

std::string hint_text(const HintSetup& setup, HintKind kind, std::string_view structure) {
  std::string text = setup.texts[static_cast<std::size_t>(kind)];
  if (const std::size_t at = text.find(kStructure); at != std::string::npos) {
    text.replace(at, kStructure.size(), structure);
  }
  return text;
}

}  // namespace haptrial::hint
