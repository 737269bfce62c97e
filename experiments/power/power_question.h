#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "experiments/studies/power_plan.h"
#include "experiments/studies/study.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {

/// One combination of the levels of the varied keys.
struct QuestionCell {
  std::vector<double> levels;  // (keys)
  bool null{false};            // every effect is at its `none`
  bool checked{false};         // also in full sessions
  std::string name;            // "design.participants 12, observer.drift 0.01"
};

/// A definition with its table [power], ready to be simulated.
struct PowerQuestion {
  PowerPlan plan;
  std::string text;              // of the definition, with [power]
  std::vector<NamedText> parts;  // the same; the last has [power]
  std::string file_name;         // for sentences on [power]
  std::string definition_name;   // for those on the rest
  std::filesystem::path folder;  // of the definition, for files that it names
  std::string title;
  const Study* study{nullptr};
  std::vector<protocols::StudyGroup> groups;  // with their sizes; none are stated: empty
  std::vector<QuestionCell> cells;            // those without an effect first
  std::string fingerprint;                    // of the text and of this program

  /// The definition of a cell. Groups and design.participants, which have to fit each other, do so
  /// if one of them varies: groups in proportion, and participants as the sum of the groups.
  std::string text_of(const QuestionCell& cell) const;
  std::vector<NamedText> parts_of(const QuestionCell& cell) const;
};

/// @throws InputError for a file without [power], a definition with mistakes, a key that cannot be
/// varied, or more than 10,000 cells
PowerQuestion load_question(const std::filesystem::path& file);
/// The same from a definition with [power], or from one and what a file of its own asks about it.
/// @param folder  of the definition
PowerQuestion parse_question(const std::vector<NamedText>& parts,
                             const std::filesystem::path& folder);

/// The name and version of this program, as parts and reports have it.
std::string program_words();

}  // namespace haptrial::experiments
