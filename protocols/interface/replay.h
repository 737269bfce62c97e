#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/record/rows/answer_rows.h"
#include "core/record/rows/session_types.h"
#include "core/record/rows/trial_facts.h"
#include "core/render/gl/image.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// Request to go through a trial of a recorded session again.
struct ReplayRequest {
  std::filesystem::path file;
  int trial{0};                 // from 1; 0: not said
  std::string phase;            // a word of the protocol; empty: all
  int fps{30};                  // of the pictures
  bool pictures{false};         // whether any are wanted
  std::filesystem::path sound;  // a file for it; empty: none
  /// Takes the pictures in their order.
  std::function<void(const render::Image&)> picture;
  /// How far it is, for a progress line. @throws RunError on an interrupt
  std::function<void(double done, double all, const std::string& what, double rate)> progress;
  std::function<void(const std::string&)> tell;  // takes lines for the terminal
};

/// A session file's records of its trials.
struct RecordedTrials {
  std::span<const record::PassRow> passes;
  std::span<const record::ResponseRow> responses;
  std::span<const record::SkippedRow> skipped;
  std::span<const record::TakenBackRow> taken_back;  // passes that are as if they had not been
};

/// Whether a pass is one of the trial.
bool is_of(const record::PassRow& pass, const PlannedTrial& trial);

/// Outcome of a trial that an earlier run, or the session that is replayed, presented; nothing if
/// it did not. The responses are those of the attempt that counts. A damaged pass that other trials
/// followed was completed, as they depend on its answer.
/// @param last  the phase with which a trial is done
std::optional<Outcome> recorded_outcome(const RecordedTrials& recorded, const PlannedTrial& trial,
                                        const record::Phase& last);

}  // namespace haptrial::protocols
