#include "core/record/isolated_info.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <string>
#include <vector>

#include "core/record/session_info.h"

namespace haptrial::record {
namespace {

constexpr unsigned kPatience = 10;  // [s]
constexpr const char* kEnd = "end";

void put(int to, const std::string& text) {
  const char* at = text.c_str();
  std::size_t left = text.size() + 1;
  while (left > 0) {
    const ssize_t done = write(to, at, left);
    if (done < 0) _exit(1);
    at += done;
    left -= static_cast<std::size_t>(done);
  }
}

/// The other process: every field as name, NUL, value, NUL.
[[noreturn]] void tell(const std::filesystem::path& file, int to) {
  const struct rlimit none {};
  setrlimit(RLIMIT_CORE, &none);
  for (const int crash : {SIGSEGV, SIGBUS, SIGABRT}) std::signal(crash, SIG_DFL);
  alarm(kPatience);
  try {
    for (const EventRow& row : info_rows(get_info(h5::open_file(file)))) {
      put(to, row.kind);
      put(to, row.text);
    }
    put(to, kEnd);
  } catch (const std::exception&) {
    // The text without its end says it.
  }
  _exit(0);
}

std::string read_all(int from) {
  std::string text;
  std::array<char, 4096> piece;
  for (;;) {
    const ssize_t size = read(from, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace

std::optional<SessionInfo> isolated_info(const std::filesystem::path& file) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  const pid_t process = fork();
  if (process == 0) tell(file, ends[1]);
  close(ends[1]);
  const std::string text = process > 0 ? read_all(ends[0]) : "";
  close(ends[0]);
  if (process > 0) {
    while (waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size(); at = text.find('\0', at) + 1) {
    if (text.find('\0', at) == std::string::npos) return std::nullopt;
    words.emplace_back(text.c_str() + at);
  }
  if (words.size() % 2 == 0 || words.back() != kEnd) return std::nullopt;
  std::vector<EventRow> rows;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) rows.push_back({0, words[i], words[i + 1]});
  return info_of(rows);
}

}  // namespace haptrial::record
