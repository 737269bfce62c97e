#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "analysis/exchange/export_sessions.h"
#include "experiments/control/progress.h"

namespace haptrial::experiments {

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
