#pragma once

#include "core/base/definition/schema_forward.h"
#include "core/questions/page.h"

namespace haptrial::questions {

/// Reads [pages] of a definition; a definition without has none. Keys in brackets are optional.
///
///     [before], [after]  names of pages, in their order
///     [after_block]      { BLOCK = [names], … }
///     [pages.NAME]
///     kind      "text" (as if left out), "consent", "nasa_tlx", "edinburgh" or "questions"
///     [title], text, [picture]         of text and consent; the picture is a PNG file
///     [accept], [decline]              of consent: what the two choices say
///     [weighted]                       of nasa_tlx: true also asks the 15 pairs
///     [title], items                   of questions: [[pages.NAME.items]]
///     name, question                   of an item, and one of
///     choices   [{ value, [label], [number] }, …]
///     scale     [lowest, highest], with [step], [ends] = { low, high }
///     number    [lowest, highest]
///     words     true: any text
PagePlan read_pages(Table& root);

}  // namespace haptrial::questions
