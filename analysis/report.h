#pragma once

#include <string>
#include <vector>

#include "analysis/figure.h"
#include "analysis/study.h"

namespace haptrial::analysis {

/// A figure and its picture as an SVG file.
struct Drawing {
  Figure figure;
  std::string svg;
};

/// The report of a study as one HTML file that needs nothing else: pictures, style and definition
/// are inside. Whatever comes from files is escaped. Equal input gives equal bytes.
std::string html_report(const StudyResult& study, const std::vector<Drawing>& drawings);

}  // namespace haptrial::analysis
