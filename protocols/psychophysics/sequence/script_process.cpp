#include "protocols/psychophysics/sequence/script_process.h"

#include <fmt/format.h>
#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "protocols/psychophysics/definition/script_plan.h"

namespace haptrial::protocols {
namespace {

/// Whether all of it went; a reader that has died is no signal.
bool send_all(int to, const std::string& text) noexcept {
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = ::send(to, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) {
      return false;
    }
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

/// Whether the other side of a socket has read all that was sent, or will never.
bool has_read_all(int socket) noexcept {
  int left = 0;
  return ::ioctl(socket, SIOCOUTQ, &left) != 0 || left == 0;
}

/// Whether a line is an answer, and not one that the script prints for itself.
bool is_answer(const std::string& line, const std::string& key) {
  const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  return json.is_object() && json.contains(key);
}

}  // namespace

ScriptProcess::ScriptProcess(std::filesystem::path file, double deadline, std::string key,
                             double longest_start)
    : file_(std::filesystem::absolute(std::move(file))),
      deadline_(deadline),
      key_(std::move(key)),
      longest_start_(longest_start) {}

ScriptProcess::~ScriptProcess() { stop(); }

void ScriptProcess::start_early() noexcept {
  try {
    start();
  } catch (const std::exception&) {
    stop();  // the question tries again, and says why not
  }
}

void ScriptProcess::start() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  Descriptor ours(ends[0]);
  const Descriptor theirs(ends[1]);
  Pipe answers;
  Program program;
  if (file_.extension() == ".py") {
    program.words = {"python3", "-u", file_.string()};
  } else {
    program.words = {file_.string()};
  }
  program.folder = file_.parent_path();
  program.input = theirs.get();
  program.output = answers.to.get();
  process_ = std::make_unique<ChildProcess>(program);
  to_ = std::move(ours);
  from_ = std::move(answers.from);
  heard_.clear();
  said_.clear();
  started_ = false;
}

void ScriptProcess::stop() noexcept {
  to_.close();
  if (process_) {
    process_->kill();
    process_.reset();
  }
  from_.close();
}

void ScriptProcess::begin_to_wait() {
  const double seconds = started_ ? deadline_ : longest_start_;
  end_ = Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

bool ScriptProcess::is_late() {
  if (!started_ && has_read_all(to_.get())) {
    started_ = true;
    begin_to_wait();
  }
  return Clock::now() >= end_;
}

std::optional<std::string> ScriptProcess::next_line(const std::function<void()>& pulse) {
  constexpr int kLook = 50;  // [ms]
  while (true) {
    if (const std::size_t at = heard_.find('\n'); at != std::string::npos) {
      std::string line = heard_.substr(0, at);
      heard_.erase(0, at + 1);
      return line;
    }
    if (is_late()) {
      return std::nullopt;
    }
    pollfd watched{from_.get(), POLLIN, 0};
    if (::poll(&watched, 1, kLook) <= 0) {
      if (pulse) {
        pulse();
      }
      continue;
    }
    std::array<char, 4096> piece;
    const ssize_t count = ::read(from_.get(), piece.data(), piece.size());
    if (count <= 0) {
      return std::nullopt;
    }
    heard_.append(piece.data(), static_cast<std::size_t>(count));
  }
}

ScriptProcess::Reply ScriptProcess::lost() {
  const std::string said = said_;
  stop();
  return {"", fmt::format("it ended with no {}{}", key_, said.empty() ? "" : ": " + said)};
}

ScriptProcess::Reply ScriptProcess::late() {
  stop();  // its answer would be one to the next question
  return {"", started_ ? fmt::format("it gave no {} within {:g} s", key_, deadline_)
                       : fmt::format("it did not read its question within {:g} s after its start",
                                     longest_start_)};
}

ScriptProcess::Reply ScriptProcess::ask(const std::string& question,
                                        const std::function<void()>& pulse) {
  try {
    if (!process_) {
      start();
    }
  } catch (const std::system_error& error) {
    return {"", fmt::format("it cannot be started: {}", error.what())};
  }
  const bool sent = send_all(to_.get(), question + '\n');
  begin_to_wait();
  while (const auto line = next_line(pulse)) {
    if (sent && is_answer(*line, key_)) {
      started_ = true;
      return {*line, ""};
    }
    if (!line->empty()) {
      said_ = *line;
    }
  }
  return Clock::now() < end_ ? lost() : late();
}

bool kept_before(const ScriptPlan& plan, const char* event, const record::SessionReader& earlier) {
  bool kept = false;
  for (const record::EventRow& row : earlier.events()) {
    if (row.kind == event && row.text != plan.text) {
      throw InputError(fmt::format(
          "{}: began with another {}; put that one back (the file keeps it in /events), or begin a "
          "new session",
          earlier.path().string(), plan.file.filename().string()));
    }
    kept = kept || row.kind == event;
  }
  return kept;
}

}  // namespace haptrial::protocols
