#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/definition/definition_changes.h"
#include "core/record/rows/session_types.h"

namespace haptrial::exchange {

/// The words that a data set with virtual participants has.
inline constexpr const char* kSimulatedNotice =
    "SIMULATED PARTICIPANTS: these data come from virtual subjects. They say how the experiment "
    "and "
    "its analysis work, not how people behave.";

/// A session file and its place among those of its subject.
struct ExportSession {
  std::filesystem::path file;
  record::SessionInfo info;
  std::uint64_t samples{0};  // rows of /samples
  std::size_t passes{0};     // 0 of a session that was recovered without any
  bool stimuli{false};       // it has rows of /stimuli
  bool mirrored{false};      // x of its tables runs to the participant's left
  int number{1};             // of the subject's session, from 1; if the files give a number twice,
                             // the place among the subject's sessions in order of start
  int of{1};                 // how many this subject has
  bool first{true};          // of this subject's here
};

/// The world frame of a session in words: where x, y and z run.
const char* axes_of(const ExportSession& session);

/// @returns the sessions by subject, then start.
/// @throws InputError when there is no file, one cannot be read, or one is given twice.
std::vector<ExportSession> sessions_to_export(std::span<const std::filesystem::path> files);

/// @throws InputError for a session whose trials another program presented, of which no time is
/// known. @param option  for the format that needs times
void refuse_imported(const ExportSession& session, const char* option);

/// The experiment's name as its definition has it, or without one that of the definition's file.
std::string experiment_name(const record::SessionInfo& info);

/// "true", or "false".
inline const char* truth(bool value) { return value ? "true" : "false"; }

/// Samples of all sessions together.
std::uint64_t total_samples(std::span<const ExportSession> sessions);

/// Called now and then on the calling thread with the samples written so far. What it throws stops
/// the export, of which then nothing is left.
using Watch = std::function<void(std::uint64_t samples)>;

/// Counts the samples that the threads have written, and stops them. Any thread.
class Counter {
 public:
  void add(std::uint64_t samples) { samples_.fetch_add(samples, std::memory_order_relaxed); }
  std::uint64_t samples() const { return samples_.load(std::memory_order_relaxed); }
  void stop() { stopped_.store(true); }
  /// @throws RunError after stop(): for the end of each piece of work.
  void check() const;

 private:
  std::atomic<std::uint64_t> samples_{0};
  std::atomic<bool> stopped_{false};
};

/// Calls work(i, counter) once for each i below `count`, over up to `jobs` threads.
/// @throws what `work` threw for the lowest i, or what `watch` threw.
void share_out(std::size_t count, int jobs, const std::function<void(std::size_t, Counter&)>& work,
               const Watch& watch);

/// Differences between the definitions of two sessions; binding changes make them two studies.
using CompareDefinitions = std::function<DefinitionChanges(const record::SessionInfo& first,
                                                           const record::SessionInfo& second)>;

/// How a data set of BIDS or Psych-DS is to be written.
struct DataSetOptions {
  std::string name{};                  // of the data set; empty: the experiment's
  std::vector<std::string> authors{};  // as the data set is to name them
  std::string program_version{};       // of the exporting program
  std::vector<std::pair<std::string, std::string>> phases{};  // of protocols, with meanings
  double motion{0.0};  // in BIDS, rate of the tip's movement beside the recording [Hz]; 0: without
  int jobs{1};
  CompareDefinitions compare{};  // none: every difference is binding
};

}  // namespace haptrial::exchange
