#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "experiments/command/sessions/run_options.h"
#include "protocols/tutoring/model_motion.h"

namespace haptrial::protocols {
struct Definition;
class Protocol;
}  // namespace haptrial::protocols

namespace haptrial::experiments {

/// Refusals of `run` before a device is opened or anything moves, in the words of its options.

/// @throws InputError for options that contradict each other or would have no effect.
void check_run_options(const RunOptions& options);

/// @throws InputError unless a session can begin in this file, or with --resume go on in it.
void check_session_file(const RunOptions& options, const std::filesystem::path& file);

/// The seed of a session: the option's, else that of the session that is resumed or of the study's
/// sessions in the folder; else 1.
/// @param own  file of the session that is to be recorded
std::string session_seed(const RunOptions& options, const std::filesystem::path& own);

/// The language of the session that is to be resumed, if none was given; empty: the definition's.
std::string begun_language(const RunOptions& options, const protocols::Definition& setup);

/// The number by which the participant's session that is resumed, or one in the folder, was
/// recorded; none if there is no such session or an older file does not have it.
/// @param own  file of the session that is to be recorded
std::optional<int> recorded_number(const RunOptions& options, const std::filesystem::path& own);

/// Compares identifier, definition and seed with those of the sessions that the folder holds
/// already; a pilot may differ from all of them.
/// @returns a sentence about keys that differ and may; empty if none
/// @throws InputError if they are of another study or seed, naming the keys, and for the
/// identifier of an excluded participant.
/// @param options  with a seed
/// @param own  file of the session that is to be recorded
std::string check_study(const RunOptions& options, const protocols::Protocol& protocol,
                        const protocols::Definition& setup, const std::filesystem::path& own);

/// @throws InputError where a recording drives the session (--device replay:FILE) and is of another
/// subject, seed or definition, or has answers that nobody would give, or more devices are named
/// than the definition drives.
void check_recording(const RunOptions& options, const protocols::Protocol& protocol,
                     const protocols::Definition& setup);

/// Reads --tutor of `run` and `dry-run`, so that a recording that can't lead is refused before a
/// folder is made.
/// @throws InputError where it holds no such run, or is a session of another protocol
protocols::TutorChoice checked_tutor(const std::string& text, const protocols::Protocol& protocol);

/// @throws InputError if nobody could read or answer the definition's pages.
void check_pages(const RunOptions& options, const protocols::Definition& setup);

}  // namespace haptrial::experiments
