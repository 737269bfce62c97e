#pragma once

#include <filesystem>

#include "analysis/document/document.h"
#include "analysis/tutoring/link_study.h"

namespace haptrial::analysis::link {

/// Report of the link between two hands in a study, by network and by participant.
Document link_report(const LinkStudy& study);

/// A row for each led pass, in SI units; `subject` and `trial` are those of the study's own tables.
std::string link_csv(const LinkStudy& study);

/// link.html, link.md and link.csv. @throws RunError where the folder cannot be written
void write_link(const LinkStudy& study, const std::filesystem::path& folder);

}  // namespace haptrial::analysis::link
