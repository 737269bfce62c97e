#pragma once

#include <cstdint>
#include <string>

#include "core/questions/page.h"

namespace haptrial::experiments {

/// Answer of a virtual participant, so that a dry run goes through every page: it consents, chooses
/// at random, and is mostly right-handed. A random stream of the item's own decides, so that the
/// answer does not depend on other items.
/// @param session_seed  of the participant
/// @param occasion      "before", "after block 2", …
questions::Answer virtual_answer(const questions::Page& page, const questions::Question& item,
                                 std::uint64_t session_seed, const std::string& occasion);

}  // namespace haptrial::experiments
