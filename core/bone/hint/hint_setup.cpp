#include "core/bone/hint/hint_setup.h"

#include <fmt/format.h>

#include "core/base/definition/schema.h"
#include "core/base/error.h"

namespace haptrial::hint {
namespace {

constexpr std::array<const char*, kHintKinds> kTexts{"Press more lightly (near {structure})",
                                                     "Slow down (near {structure})",
                                                     "You cannot see what you are drilling"};
constexpr std::string_view kStructure = "{structure}";

constexpr std::array<const char*, kHintKinds> kReaders{
    "Text for a participant who presses too hard; {structure} is the name of the nearest structure",
    "Text for a participant whose tip is too fast; {structure} is the name of the nearest "
    "structure",
    "Text for a participant who drills bone that other bone hides"};

void read_kinds(Table& table, const std::string& key, HintSetup& setup) {
  setup.kinds.fill(false);
  bool known = true;
  for (const std::string& word : table.texts(key)) {
    bool found = false;
    for (const HintKind kind : kAllHintKinds) {
      if (word == name_of(kind)) {
        found = setup.kinds[static_cast<std::size_t>(kind)] = true;
      }
    }
    known = known && found;
  }
  if (!known) {
    table.reject(key, "something else", "a list of \"force\", \"speed\" and \"hidden\"");
  }
}

/// Texts of the program's own can be translated, too: they are asked for although no key is there.
void read_texts(Table& table, HintSetup& setup) {
  for (const HintKind kind : kAllHintKinds) {
    const auto i = static_cast<std::size_t>(kind);
    const std::string key = fmt::format("{}_text", name_of(kind));
    table.describe({key, kReaders[i], kTexts[i]});
    setup.texts[i] = table.shown_text(key, kTexts[i]);
    table.note_placeholders(key, {std::string(kStructure)});
  }
}

}  // namespace

std::string_view name_of(HintKind kind) noexcept {
  constexpr std::array<std::string_view, kHintKinds> kNames{"force", "speed", "hidden"};
  return kNames[static_cast<std::size_t>(kind)];
}

const Schema<HintSetup>& hint_schema() {
  using S = HintSetup;
  static const auto schema =
      Schema<S>()
          .derive([](S& s) { s.kinds.fill(true); })
          .custom("kinds",
                  "Mistakes that hints are about: too much force, too much speed, bone that other "
                  "bone hides",
                  read_kinds)
          .otherwise("all three")
          .custom("shown_in",
                  "Procedures in which the participant sees hints; every other: the first "
                  "participant from the first on, the second from the second on; or the groups "
                  "that alone do so, in every procedure",
                  [](Table& table, const std::string& key, S& s) {
                    s.shown = read_given_in(table, key);
                  })
          .otherwise("all")
          .text(
              "file", &S::file,
              "File with safe values, as haptrial bone safe writes it; relative to the definition")
          .otherwise("none")
          .check([](Table& table, S& s) {
            if (!table.has("file") && s.needs_limits()) {
              table.reject(
                  table.has("kinds") ? "kinds" : "file",
                  "needs a file with safe limits: name one that haptrial bone safe wrote as "
                  "hints.file, or set hints.kinds to [\"hidden\"]");
            }
          })
          .number("reach", &S::reach, {0.0, 0.03, true}, "m",
                  "Distance from a structure up to which forces and speeds are judged")
          .integer("fewest", &S::fewest, 1, 1000, "Number of faulty removals that begin a hint")
          .number("within", &S::within, {0.0, 10.0, true}, "s",
                  "Time within which faulty removals must come to begin a hint")
          .number("holds", &S::holds, {0.1, 60.0}, "s",
                  "Time for which a hint stays after the last faulty removal")
          .flag("sound", &S::sound, "Whether a chime is heard when a hint begins")
          .check(read_texts);
  return schema;
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
  for (std::size_t at = text.find(kStructure); at != std::string::npos;
       at = text.find(kStructure, at + structure.size())) {
    text.replace(at, kStructure.size(), structure);
  }
  return text;
}

}  // namespace haptrial::hint
