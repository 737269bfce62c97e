#pragma once

#include <span>

#include "core/record/rows/session_types.h"

namespace haptrial::record {

class SessionReader;

/// @throws InputError that names the first phase of /trials that is none of `known`
void check_phases(const SessionReader& file, std::span<const Phase> known);

}  // namespace haptrial::record
