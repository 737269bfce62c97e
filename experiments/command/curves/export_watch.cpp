#include "experiments/command/curves/export_watch.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "experiments/control/interrupt.h"

namespace haptrial::experiments {

ExportWatch::ExportWatch(const std::vector<std::filesystem::path>& files)
    : sessions_(exchange::sessions_to_export(files)),
      progress_("export", static_cast<double>(exchange::total_samples(sessions_))) {}

void ExportWatch::operator()(std::uint64_t samples) {
  if (interrupted()) {
    throw RunError("interrupted; nothing was exported");
  }
  progress_.update(static_cast<double>(samples),
                   fmt::format("{:.1f} million samples", 1e-6 * static_cast<double>(samples)),
                   sessions_.front().info.rate);
}

}  // namespace haptrial::experiments
