#include "tests/experiments/force_log.h"

#include <chrono>
#include <cmath>
#include <fstream>

#include "tests/support/stand_in_record.h"

namespace haptrial::test {

std::vector<Commanded> read_force_log(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  ForceRecord::Head head{};
  std::vector<Commanded> all;
  if (!in.read(reinterpret_cast<char*>(&head), sizeof head)) {
    return all;
  }
  ForceRecord::Row row{};
  for (std::int64_t i = 0; i < head.count && in.read(reinterpret_cast<char*>(&row), sizeof row);
       ++i) {
    all.push_back({1e-9 * static_cast<double>(row.time_ns),
                   std::hypot(row.force[0], row.force[1], row.force[2])});
  }
  return all;
}

double monotonic_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace haptrial::test
