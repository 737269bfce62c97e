#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/definition/given_values.h"
#include "core/base/definition/table.h"
#include "core/base/definition/translations.h"
#include "experiments/studies/study.h"

namespace haptrial::experiments {

/// A definition and the study that its protocol belongs to.
struct Experiment {
  const Study* study{nullptr};
  std::unique_ptr<protocols::Definition> definition;
  std::vector<ShownText> shown{};           // everything that participants read
  std::vector<std::string> untranslated{};  // sentences: texts that the language lacks
};

/// @throws InputError with a sentence for every problem of the file.
/// @param language  of what participants read, "de"; empty: as the definition has it
/// @param given  keys that have these values in place of the file's
Experiment load_experiment(const std::filesystem::path& file, const std::string& language = "",
                           std::span<const GivenKey> given = {});
/// Experiment from the text that a session file keeps, without the parts that the protocol loads
/// beside it.
Experiment parse_experiment(std::string_view text, std::string_view file_name);
/// The same of several files, of which sentences name each with its own lines; the definition's is
/// the first.
Experiment parse_experiment(const std::vector<NamedText>& parts);

/// How to find the case that comes next; an empty function if the definition has no curriculum.
/// @param experiment  with its definition outlives what comes back  @param file  of the definition
FindCase find_case_of(const Experiment& experiment, const std::filesystem::path& file);

/// Sentences on what a definition allows but what spoils its data without a word: what was found,
/// and what will happen. None where all is well.
std::vector<std::string> warnings_of(const Experiment& experiment);

/// Sentences on texts with characters that no typeface of this machine has, each with its key.
std::vector<std::string> undrawable_texts(const Experiment& experiment);

/// Prints each, after "warning: ".
void print_warnings(const Experiment& experiment);

}  // namespace haptrial::experiments
