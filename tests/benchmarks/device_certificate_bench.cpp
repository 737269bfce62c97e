// Certificates of a virtual arm with planted faults: how often their 95 % intervals hold the truth.
// The table of docs/devices.md.
//
//     bench_device_certificate [certificates] [first seed]

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "tests/analysis/device/device_coverage.h"

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int first = argc > 2 ? std::atoi(argv[2]) : 1;
  if (seeds < 1) {
    fmt::print(stderr, "bench_device_certificate: at least 1 certificate\n");
    return 2;
  }
  fmt::print("{} certificates, seeds {} to {}\n", seeds, first, first + seeds - 1);
  fmt::print("{:28} {:>9} {:>9}   share [%]\n", "figure", "held", "of");
  for (const haptrial::test::CoverageCount& count : haptrial::test::count_coverage(first, seeds)) {
    fmt::print("{:28} {:9} {:9}   {:.1f}\n", count.figure, count.held, count.of,
               100.0 * count.held / count.of);
  }
  return 0;
}
