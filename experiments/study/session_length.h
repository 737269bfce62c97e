#pragma once

namespace haptrial::protocols {
struct Definition;
}

namespace haptrial::experiments {

struct Roster;

/// Time of a session at most, roughly: its trials and the breaks between them, without pages [s].
/// @param trials  of the session, at least 1
double session_seconds(const protocols::Definition& definition, int trials);

/// Sessions that a study still needs until every planned participant has had all of them.
int sessions_to_come(const Roster& roster);

}  // namespace haptrial::experiments
