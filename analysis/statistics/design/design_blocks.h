#pragma once

#include <string>

#include "analysis/document/document.h"
#include "analysis/statistics/design/design_tests.h"

namespace haptrial::analysis {

/// Adds the factors, their tests, on ranks too, and the families of comparisons with p values after
/// Holm: paragraphs and tables. @param unit  of differences; "": none
void add_design_tests(Document& document, const DesignTable& table, const DesignTests& tests,
                      const std::string& unit);

/// Adds how a sequential study stands, with its last looks.
void add_looks(Document& document, const SequentialResult& result);

}  // namespace haptrial::analysis
