#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::experiments {

struct AnalyzeOptions;
struct ExportOptions;

/// haptrial analyze of curves of force, or of scores, from elsewhere. @returns lines for the
/// terminal
std::vector<std::string> analyze_curves(const AnalyzeOptions& options, int threads);

/// haptrial export --curves. @throws InputError for a session whose passes have no target force
void export_curves(const ExportOptions& options, const std::vector<std::filesystem::path>& files,
                   int jobs);

}  // namespace haptrial::experiments
