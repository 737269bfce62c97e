#pragma once

#include "core/base/definition/table.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::protocols {

struct Definition;

/// Kinds of the two events of a run in another language than the definition's: which one, and the
/// whole file with its texts, which is empty if there is none.
inline constexpr const char* kLanguageEvent = "language";
inline constexpr const char* kLanguageTextsEvent = "language_texts";

/// Kind of the event with the text of the script that chooses what is presented
/// (Definition::presenting_script).
inline constexpr const char* kLevelScriptEvent = "level_script";

/// The definition that a session was recorded with, with the texts that the participant read during
/// a trial: a session may be resumed in another language.
/// @param trial  from 1; another language's texts are those of its last attempt. 0, or a trial that
/// the file does not hold: those of the session's first trial
/// @throws InputError if it is no definition that this version knows
Table recorded_definition(const record::SessionReader& reader, int trial);

/// Takes over how a session was seen, which its events say: mirrored or not.
void show_as_recorded(const record::SessionReader& reader, Definition& definition);

}  // namespace haptrial::protocols
