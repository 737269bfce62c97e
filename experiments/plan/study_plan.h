#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// A group of a planned study; a study without groups has one without a name.
struct PlannedGroup {
  std::string name;
  int participants{0};
  int sessions{1};  // to which each of them comes

  bool operator==(const PlannedGroup&) const = default;
};

/// The rule of analysis.sequential under which data may be analysed after every participant.
inline constexpr const char* kAtAnyTime = "bayes factor";

/// A preregistration: what a study states before its first participant. It is one JSON file,
/// NAME.plan.json beside the definition NAME.toml and beside the sessions, which is never changed.
struct StudyPlan {
  std::string name;      // of the study
  std::string made_utc;  // "2026-11-20T09:30:00Z"
  std::string login;     // of who made it
  std::string program;   // "haptrial 0.2.0 (1a2b3c4d5e6f)"
  std::string definition_name;
  std::string definition;         // whole text, with its lab file's
  std::string definition_sha256;  // of that text
  std::string scripts_sha256;     // of the script of levels beside it; empty: it has none
  std::vector<PlannedGroup> groups;
  int sessions{1};  // of each participant
  std::vector<std::string> hypotheses;
  std::vector<std::string> tests;       // planned ones of the definition
  std::vector<std::string> exclusions;  // reasons for which a participant is left out
  std::string stopping;                 // rule, in words
  std::string ends_early;    // rule of analysis.sequential, "bayes factor"; empty: it does not
  std::vector<int> looks;    // participants at which data is analysed before the end
  std::string retain_until;  // date, "2036-12-31"; empty: not stated
  std::vector<std::string> power;  // sentences; empty: not stated

  std::string sha256;  // of the file; empty until it is read

  int participants() const;
};

/// The file's text. @returns the same bytes for the same plan
std::string plan_json(const StudyPlan& plan);
/// @throws InputError for a file that is no plan
StudyPlan read_study_plan(const std::filesystem::path& file);

/// Sentences on what another plan states otherwise; time and login do not count. Keys of the
/// definition are named. Empty: both state the same.
std::vector<std::string> plan_differences(const StudyPlan& before, const StudyPlan& after);

/// "my_study.plan.json" beside "my_study.toml", whether it is there or not.
std::filesystem::path plan_beside(const std::filesystem::path& definition);
/// The plan in a folder of sessions; nothing without one. @throws InputError for several
std::optional<std::filesystem::path> plan_in(const std::filesystem::path& folder);
/// Copies the plan beside a definition into the folder of its sessions, if there is one.
/// @throws InputError if the folder has another plan
void adopt_plan(const std::filesystem::path& definition, const std::filesystem::path& folder);

/// A sentence if the date until which data is kept is over; empty otherwise.
/// @param today  "2026-11-20"
std::string retention_sentence(const StudyPlan& plan, const std::string& today);

/// The time now in UTC, "2026-11-20T09:30:00Z".
std::string utc_now();
/// The name of the user who runs the program.
std::string login_name();
}  // namespace haptrial::experiments
