#pragma once

#include <array>
#include <vector>

#include "core/questions/question.h"

namespace haptrial::questions {

/// The six scales of the NASA-TLX, in their order: names of items.
inline constexpr std::array<const char*, 6> kTlxScales{"mental",      "physical", "temporal",
                                                       "performance", "effort",   "frustration"};

/// NASA Task Load Index: a rating from 0 to 100 in steps of 5 on each scale, then for the weights
/// the 15 pairs of scales, of which the one that matters more is chosen; items "mental" … and
/// "mental or physical" …
/// Source: Hart and Staveland 1988; Hart, NASA Task Load Index v. 1.0, 1986.
std::vector<questions::Question> nasa_tlx_items(bool weighted);

/// Edinburgh handedness inventory, ten activities, each answered from "always left" (-2) over
/// "either" (0) to "always right" (2), or "never done", which has no number.
/// Source: Oldfield 1971, appendix II.
std::vector<questions::Question> edinburgh_items();

}  // namespace haptrial::questions
