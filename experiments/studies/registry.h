#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "experiments/studies/study.h"

namespace haptrial::experiments {

/// Every study that this program has added, the default one first. Call before threads are started.
const std::vector<const Study*>& studies();

/// The words that [experiment] may have for protocols, synonyms too.
std::vector<std::string> protocol_words();
/// The study of one of these words; null for any other word.
const Study* find_study(std::string_view word);

/// One more. It lives as long as the program.
/// @throws std::invalid_argument for a name that is taken
void add_study(const Study& study);

/// Every table that a session of one of them may have beside those of every session.
record::TableList known_tables();
/// The phases of all of them, each once, with its meaning.
std::vector<std::pair<std::string, std::string>> known_phases();

/// The study whose protocol [experiment] names; the first one if it names none. A mistake in it is
/// thrown alone, since it decides what the other keys mean.
/// @throws InputError
const Study& study_of(Table& root);
/// The same from the definition that a session file keeps.
const Study& study_of(const record::SessionInfo& session);
const protocols::Protocol& protocol_of(const record::SessionInfo& session);

}  // namespace haptrial::experiments
