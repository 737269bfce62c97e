#include "experiments/studies/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/nearest.h"
#include "core/render/flat/typesetter.h"
#include "core/render/gl/image.h"
#include "experiments/screen/video_player.h"
#include "experiments/studies/curve_analysis.h"
#include "experiments/studies/power_plan.h"
#include "experiments/studies/registry.h"
#include "protocols/definition/button_uses.h"
#include "protocols/definition/groups.h"
#include "protocols/definition/lab_file.h"
#include "protocols/definition/languages.h"
#include "protocols/definition/tutoring_warnings.h"

namespace haptrial::experiments {
namespace {

void refuse_session(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return;  // a pipe would wait here; load_with_lab() refuses it
  }
  if (file_head(file, 8) == "\x89HDF\r\n\x1a\n") {
    throw InputError(file.string() + ": is a session file; give a definition (.toml)");
  }
}

/// Notes what recorded sessions may have, but no session may begin with. Such bounds, which a later
/// version adds, stand here and not in a schema, since recordings of every version can be read.
/// Pages after a block that never ends would never be shown.
void check_blocks_of_pages(Table& root, const protocols::Definition& definition) {
  if (definition.pages.after_block.empty()) {
    return;
  }
  const std::vector<std::string> known = definition.block_names();
  Table pages = root.table("pages");
  Table blocks = pages.table("after_block");
  for (const auto& [block, names] : definition.pages.after_block) {
    if (known.empty()) {
      blocks.reject(block,
                    "names a block, and those of this protocol have no names; write the "
                    "pages in before or after");
    } else if (std::ranges::find(known, block) == known.end()) {
      const std::string hint = did_you_mean(block, known);
      blocks.reject(block, fmt::format("is no block{} allowed: {}", hint.empty() ? ";" : hint,
                                       fmt::join(known, ", ")));
    }
  }
}

void check_new_session(Table& root, const protocols::Definition& definition) {
  check_blocks_of_pages(root, definition);
  Table envelope = root.table("envelope");
  device::check_new_envelope(envelope, definition.envelope);
  channel::check_lines(root, definition.channels);
  definition.check_new_session(root);
  if (root.is_table("power")) {
    check_new_power(root);
  }
  if (!root.is_table("tutoring")) {
    return;
  }
  Table tutoring = root.table("tutoring");
  if (tutoring.has("passivity") && tutoring.text("passivity") == "waves") {
    tutoring.reject("passivity", "'waves', which version 0.2 alone had", "tank, none");
  }
}

/// @param folder  of a file with which sessions may begin; null for a text, as of a recording
Experiment read(Table& root, std::string_view file_name, const std::filesystem::path* folder) {
  Experiment experiment;
  experiment.study = &study_of(root);
  experiment.definition = experiment.study->protocol().read(root, file_name, folder);
  experiment.study->read_analysis(root, experiment.definition.get(), folder != nullptr);
  read_mark_rule(root);
  read_plan_table(root);
  protocols::check_markers(root, *experiment.definition);
  if (root.has("power")) {
    read_power_plan(root);
  }
  if (folder != nullptr) {
    check_new_session(root, *experiment.definition);
  }
  root.finish();
  experiment.shown = root.shown_texts();
  return experiment;
}

/// The pictures and videos of pages, before somebody looks at them.
void check_pictures(const protocols::Definition& definition, const std::filesystem::path& folder) {
  for (const questions::Page& page : definition.pages.pages) {
    for (const questions::Question& item : page.items) {
      if (!item.picture.empty()) {
        static_cast<void>(render::read_png(folder / item.picture));
      }
      if (!item.video.empty()) {
        try {
          static_cast<void>(video_facts(folder / item.video));
        } catch (const RunError&) {
          // ffmpeg is not there, which dry runs do without: warnings_of() says so.
        }
      }
    }
  }
}

/// Checks translations after they were read: the texts of the file, and those that it lacks.
/// @throws InputError for what it has beside the definition's texts
void check_translations(const Translations& translations, Experiment& experiment) {
  const auto unknown = unknown_translations(translations, experiment.shown);
  if (!unknown.empty()) {
    throw InputError(fmt::format("{}", fmt::join(unknown, "\n")));
  }
  experiment.untranslated = missing_translations(translations, experiment.shown);
  experiment.definition->language = translations.language;
  experiment.definition->language_texts = translations.file_text;
}

void warn_of_videos(const protocols::Definition& definition, std::vector<std::string>& warnings) {
  for (const questions::Page& page : definition.pages.pages) {
    for (const questions::Question& item : page.items) {
      if (!item.video.empty() && !is_installed("ffmpeg")) {
        warnings.push_back(
            fmt::format("pages.{}.video: ffmpeg is not installed on this machine, so participants "
                        "would not see it; install Debian's package ffmpeg",
                        page.name));
      }
    }
  }
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& file, const std::string& language,
                           std::span<const GivenKey> given) {
  const std::filesystem::path folder = file.parent_path();
  refuse_session(file);
  Table root = protocols::load_with_lab(file, given);
  std::optional<Translations> translations;
  if (!language.empty()) {
    translations = protocols::translations_for(file, language);
    root.translate(*translations);
  }
  Experiment experiment = read(root, file.string(), &folder);
  if (translations) {
    check_translations(*translations, experiment);
  }
  const auto unknown =
      unknown_placeholders(translations.value_or(Translations()), experiment.shown, file.string());
  if (!unknown.empty()) {
    throw InputError(fmt::format("{}", fmt::join(unknown, "\n")));
  }
  check_pictures(*experiment.definition, folder);
  experiment.study->protocol().load(*experiment.definition, folder);
  experiment.study->check_loaded(*experiment.definition);
  return experiment;
}

Experiment parse_experiment(std::string_view text, std::string_view file_name) {
  return parse_experiment(std::vector<NamedText>{{std::string(text), std::string(file_name)}});
}

Experiment parse_experiment(const std::vector<NamedText>& parts) {
  Table root = Table::parse(parts);
  return read(root, parts.front().file_name, nullptr);
}

namespace {

/// Sentences on boards, which the definition has a table for, that give no force along some axes.
void warn_of_missing_axes(const protocols::Definition& d, std::vector<std::string>& warnings) {
  const auto warn = [&](const char* name, const auto& board) {
    const std::string missing =
        board.line.port.empty() ? ""
                                : device::missing_axes_sentence(name, device::force_axes(board));
    if (!missing.empty()) {
      warnings.push_back(missing);
    }
  };
  warn("hapi", d.vendor.hapi);
  warn("paddle", d.vendor.paddle);
}

}  // namespace

std::vector<std::string> warnings_of(const Experiment& experiment) {
  std::vector<std::string> warnings = experiment.definition->warnings();
  warn_of_missing_axes(*experiment.definition, warnings);
  warn_of_videos(*experiment.definition, warnings);
  std::ranges::move(protocols::group_warnings(experiment.definition->groups),
                    std::back_inserter(warnings));
  for (std::string& warning : protocols::button_warnings(*experiment.definition)) {
    warnings.push_back(std::move(warning));
  }
  for (std::string& warning : protocols::tutoring_warnings(*experiment.definition)) {
    warnings.push_back(std::move(warning));
  }
  for (std::string& warning : experiment.study->analysis_warnings(*experiment.definition)) {
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

FindCase find_case_of(const Experiment& experiment, const std::filesystem::path& file) {
  const protocols::Definition& definition = *experiment.definition;
  const Study& study = *experiment.study;
  const std::filesystem::path folder = file.parent_path();
  if (!study.next_case(definition, folder, {})) {
    return {};
  }
  return [&study, &definition, folder](const std::vector<std::filesystem::path>& sessions) {
    return *study.next_case(definition, folder, sessions);
  };
}

std::vector<std::string> undrawable_texts(const Experiment& experiment) {
  std::vector<std::string> sentences;
  for (const ShownText& text : experiment.shown) {
    const bool plain = std::all_of(text.text.begin(), text.text.end(),
                                   [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    const auto missing = plain ? std::vector<char32_t>() : render::missing_characters(text.text);
    if (!missing.empty()) {
      std::vector<std::string> names;
      for (const char32_t c : missing) {
        names.push_back(fmt::format("U+{:04X}", static_cast<unsigned>(c)));
      }
      sentences.push_back(fmt::format(
          "{} has characters that no typeface of this machine has, which are shown as boxes: {}; "
          "install one that has them, such as a package fonts-noto-…",
          text.key, fmt::join(names, ", ")));
    }
  }
  return sentences;
}

void print_warnings(const Experiment& experiment) {
  for (const std::string& warning : warnings_of(experiment)) {
    fmt::print("warning: {}\n", warning);
  }
}

}  // namespace haptrial::experiments
