// Certificates of a virtual arm with planted faults: how often their 95 % intervals hold the truth.
// The tables of docs/devices.md.
//
//     bench_device_certificate [certificates] [first seed] [tip | rotation | grip] [free]
//
// free: from motion alone, without a sensor, with faults drawn at random.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "core/device/handle_part.h"
#include "tests/analysis/device/device_coverage.h"

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int first = argc > 2 ? std::atoi(argv[2]) : 1;
  if (seeds < 1) {
    fmt::print(stderr, "bench_device_certificate: at least 1 certificate\n");
    return 2;
  }
  const std::string word = argc > 3 ? argv[3] : "tip";
  using haptrial::device::Part;
  const Part of = word == "rotation" ? Part::kRotation : word == "grip" ? Part::kGrip : Part::kTip;
  if (word != haptrial::device::part_word(of)) {
    fmt::print(stderr, "bench_device_certificate: {} is no tip, rotation or grip\n", word);
    return 2;
  }
  const bool free = argc > 4 && std::string(argv[4]) == "free";
  fmt::print("{} certificates of a {}{}, seeds {} to {}\n", seeds, word,
             free ? " that is let go" : "", first, first + seeds - 1);
  fmt::print("{:28} {:>9} {:>9}   share [%]\n", "figure", "held", "of");
  for (const haptrial::test::CoverageCount& count :
       free ? haptrial::test::count_free_coverage(of, first, seeds)
            : haptrial::test::count_coverage(haptrial::test::faulty_part(of), first, seeds)) {
    fmt::print("{:28} {:9} {:9}   {:.1f}\n", count.figure, count.held, count.of,
               100.0 * count.held / count.of);
  }
  return 0;
}
