#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <thread>
#include <vector>

namespace haptrial::analysis {

/// Calls work(first, count) for groups of up to `group` of the items 0 .. items - 1, each once, on
/// up to `jobs` threads, this one among them. Every thread calls make() for a work of its own.
/// @throws what the first group that failed threw; std::invalid_argument for jobs below 1.
template <class Make>
void in_groups(std::size_t items, std::size_t group, int jobs, Make make) {
  if (jobs < 1) throw std::invalid_argument("jobs must be at least 1");
  const std::size_t groups = (items + group - 1) / group;
  std::vector<std::exception_ptr> errors(groups);
  std::atomic<std::size_t> next{0};
  const auto take_groups = [&] {
    auto work = make();
    for (std::size_t g; (g = next.fetch_add(1)) < groups;) {
      try {
        work(g * group, std::min(group, items - g * group));
      } catch (...) {
        errors[g] = std::current_exception();
      }
    }
  };
  std::vector<std::jthread> threads;
  const std::size_t wanted = std::min(static_cast<std::size_t>(jobs), groups);
  for (std::size_t k = 1; k < wanted; ++k) threads.emplace_back(take_groups);
  take_groups();
  threads.clear();  // joins
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace haptrial::analysis
