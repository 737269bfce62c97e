#include "analysis/device/certificate_record.h"

#include <cmath>
#include <utility>

namespace haptrial::analysis {

double align_forces(PartRecord& part, const std::vector<double>& tick_at) {
  const std::vector<Eigen::Vector3d> forces = std::exchange(part.measured, {});
  const std::vector<double> times = std::exchange(part.measured_at, {});
  double late = 0.0;
  std::size_t at = 0;  // times grow, and so does the nearest one
  for (const double tick : tick_at) {
    while (at + 1 < times.size() && std::abs(times[at + 1] - tick) <= std::abs(times[at] - tick)) {
      ++at;
    }
    part.measured.push_back(forces[at]);
    part.measured_at.push_back(times[at]);
    late += tick - times[at];
  }
  return tick_at.empty() ? 0.0 : late / static_cast<double>(tick_at.size());
}

}  // namespace haptrial::analysis
