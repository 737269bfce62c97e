#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::protocols {
struct BoneDefinition;
}

namespace haptrial::experiments {

/// Sessions of one trainee, and with whom they are compared.
struct TraineeRequest {
  std::vector<std::filesystem::path> sessions;  // of one participant; in order of their start
  std::optional<int> trial;                     // of each; default: all
  std::vector<std::filesystem::path> experts;   // sessions; the best seen procedure is shown beside
  std::filesystem::path study;      // folder of sessions: those of its expert groups; empty: none
  std::filesystem::path score;      // file of a score; empty: none
  std::filesystem::path phases;     // file of a model of phases; empty: none
  std::filesystem::path checklist;  // empty: none
  std::filesystem::path out;        // new page (.html)
  bool overwrite{false};
};

/// Writes a page about the trainee's procedure; for several procedures an overview, and a page for
/// each beside it (NAME-1.html, ...).
/// @returns the files, the overview or the only page first
/// @throws InputError where sessions are no drillings or of several participants, a study has no
/// experts, or a page of that name exists.
std::vector<std::filesystem::path> write_trainee_pages(const TraineeRequest& request);

/// The page that a definition asks for, beside a session's file as NAME.html; one that is there is
/// replaced. @param folder  of the definition
/// @returns lines for the terminal: the page, or why there is none; nothing if none is asked for
std::vector<std::string> page_after_session(const protocols::BoneDefinition& definition,
                                            const std::filesystem::path& folder,
                                            const std::filesystem::path& file);

}  // namespace haptrial::experiments
