#!/usr/bin/env bash
# Installs what is missing, builds and runs every test.
#   ./check.sh         release build
#   ./check.sh asan    under AddressSanitizer and UndefinedBehaviorSanitizer
#   ./check.sh tsan    under ThreadSanitizer
#   ./check.sh bench   the benchmarks, beside their peers
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/setup.sh"

export ASAN_OPTIONS=detect_stack_use_after_return=1
export LSAN_OPTIONS=suppressions=$root/tests/support/lsan.supp:print_suppressions=0
export TSAN_OPTIONS=suppressions=$root/tests/support/tsan.supp

# Tests on real data, which the project does not ship, look where HAPTRIAL_DATA says, else here.
data=${HAPTRIAL_DATA:-$root/../shared/data}
[ -d "$data" ] || say "no folder $data: tests on real data will skip"

# How many places a test takes stands at haptrial_discover in cmake/Modules.cmake.
run_tests() {
  ctest --test-dir "$root/$1" --output-on-failure --no-tests=error -j $((7 * $(nproc)))
}

case "${1:-release}" in
  release)
    install_packages build test site
    build build -DHAPTRIAL_WERROR=ON -DHAPTRIAL_TESTS=ON -DHAPTRIAL_UNITY=ON -DHAPTRIAL_PYTHON=ON
    run_tests build
    ;;
  asan | tsan)
    install_packages build test
    [ "$1" = asan ] && sanitizer=address || sanitizer=thread
    build "build-$1" -DHAPTRIAL_WERROR=ON -DHAPTRIAL_SANITIZER=$sanitizer -DHAPTRIAL_TESTS=ON -DHAPTRIAL_UNITY=ON
    run_tests "build-$1"
    ;;
  bench)
    install_packages build bench
    build build-bench -DHAPTRIAL_BENCHMARKS=ON -DHAPTRIAL_TESTS=OFF -DHAPTRIAL_UNITY=ON
    for benchmark in "$root"/build-bench/bench_*; do
      say "== $(basename "$benchmark")"
      "$benchmark"
    done
    ;;
  *)
    die "'$1' is not known; allowed: nothing, asan, tsan or bench"
    ;;
esac
