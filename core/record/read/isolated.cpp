#include "core/record/read/isolated.h"

#include <unistd.h>

#include <csignal>
#include <system_error>

#include "core/base/child_process.h"

namespace haptrial::record {
namespace {

constexpr unsigned kPatience = 10;  // [s] for each gigabyte
constexpr std::uint64_t kGigabyte = 1ull << 30;
constexpr char kEnd = '.';  // the last byte of what was said whole; without it the work failed

std::string words_of(unsigned seconds, const std::function<std::string()>& work) {
  Pipe pipe;
  ChildProcess child([&] {
    std::signal(SIGALRM, SIG_DFL);
    alarm(seconds);
    const std::string words = work() + kEnd;
    write_fully(pipe.to.get(), words.data(), words.size());
  });
  pipe.to.close();
  std::string words = read_to_end(pipe.from.get());
  child.wait();
  return words;
}

}  // namespace

std::optional<std::string> in_a_process_of_its_own(std::uint64_t bytes,
                                                   const std::function<std::string()>& work) {
  const auto patience = kPatience * static_cast<unsigned>(1 + bytes / kGigabyte);
  std::string words;
  try {
    words = words_of(patience, work);
  } catch (const std::system_error&) {
    return std::nullopt;
  }
  if (words.empty() || words.back() != kEnd) {
    return std::nullopt;
  }
  words.pop_back();
  return words;
}

}  // namespace haptrial::record
