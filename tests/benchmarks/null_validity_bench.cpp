// How often the construct-validity study finds a difference between virtual surgeons of one skill.
//   bench_null_validity STUDY.toml FOLDER [PEOPLE] [SECONDS]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/null_study.h"

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: bench_null_validity STUDY.toml NEW_FOLDER [PEOPLE] [SECONDS]\n");
    return 2;
  }
  haptrial::test::NullStudy study;
  study.people = argc > 3 ? std::max(15, std::atoi(argv[3])) : 60;
  study.seconds = argc > 4 ? std::atof(argv[4]) : study.seconds;
  const auto figures = haptrial::test::null_study(argv[1], argv[2], study);
  const auto [low, high] = std::minmax_element(figures.ratings.begin(), figures.ratings.end());
  fmt::print("{} simulated people of one skill, {} runs of 15; mean ratings {:.2f} to {:.2f}\n",
             study.people, study.runs, *low, *high);
  fmt::print("p < 0.05: Student over procedures {}, Welch over means {}, mixed model {}\n",
             figures.pooled, figures.means, figures.mixed);
  return 0;
}
