#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/exchange/export_sessions.h"
#include "experiments/control/progress.h"

namespace haptrial::experiments {

/// Options of haptrial analyze that say which curves are analysed and how; command_analyze.cpp
/// describes them.
struct CurveOptions {
  std::string curves;
  std::string conditions;
  std::string table;
  std::string out;
  std::string definition;
  std::vector<std::string> columns;
  std::vector<std::string> factors;
  std::vector<std::string> planned;
  std::string reference;
};

/// haptrial analyze of curves of force, or of scores, from elsewhere.
/// @param paper  width of figures for a paper [mm]; 0: none are written
/// @returns lines for the terminal
std::vector<std::string> analyze_curves(const CurveOptions& options, int paper, int threads);

/// haptrial export --curves. @throws InputError for a session whose passes have no target force
void export_curves(const std::string& folder, const std::vector<std::filesystem::path>& files,
                   int jobs);

/// Shows how far an export is; an interrupt ends it.
class ExportWatch {
 public:
  explicit ExportWatch(const std::vector<std::filesystem::path>& files);
  /// @param samples  written so far. @throws RunError on an interrupt
  void operator()(std::uint64_t samples);

 private:
  std::vector<exchange::ExportSession> sessions_;
  Progress progress_;
};

}  // namespace haptrial::experiments
