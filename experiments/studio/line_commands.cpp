#include "experiments/studio/line_commands.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <system_error>

#include "core/base/child_process.h"
#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostTried = 2;
constexpr std::size_t kMostUnread = 20'000'000;     // of the command [bytes]
constexpr std::chrono::seconds kLongestStart(120);  // bodies are prepared
constexpr std::chrono::seconds kLongestAnswer(120);

}  // namespace

class LineCommands::Child {
 public:
  Child(const std::string& program, const CommandWords& words,
        const std::filesystem::path& folder) {
    Program started{
        .words = {program}, .folder = folder, .input = to_.from.get(), .output = from_.to.get()};
    started.words.insert(started.words.end(), words.begin(), words.end());
    process_.emplace(started);
    to_.from.close();
    from_.to.close();
  }

  /// The next line; nothing at the end of the output. @throws RunError if it takes too long
  std::optional<std::string> line(std::chrono::seconds longest) {
    const auto until = Clock::now() + longest;
    for (;;) {
      if (const auto end = unread_.find('\n'); end != unread_.npos) {
        std::string next = unread_.substr(0, end);
        unread_.erase(0, end + 1);
        return next;
      }
      if (Clock::now() > until || unread_.size() > kMostUnread) {
        throw RunError("a command of the studio did not answer");
      }
      if (!read_more()) {
        return std::nullopt;
      }
    }
  }
  /// The answer to each line.
  std::vector<std::string> answer(const std::vector<std::string>& lines) {
    const std::lock_guard lock(mutex_);
    std::string text;
    for (const std::string& each : lines) {
      text += each + "\n";
    }
    std::vector<std::string> answers;
    const bool written = write_fully(to_.to.get(), text.data(), text.size());
    while (written && answers.size() < lines.size()) {
      auto next = line(kLongestAnswer);
      if (!next) {
        break;
      }
      answers.push_back(std::move(*next));
    }
    if (answers.size() < lines.size()) {
      throw RunError("a command of the studio has ended; begin again");
    }
    return answers;
  }
  std::string rest() { return std::exchange(unread_, {}); }
  void kill() { process_->kill(); }

 private:
  /// @returns whether there may be more
  bool read_more() {
    constexpr int kPause = 100;  // [ms]
    pollfd wait{from_.from.get(), POLLIN, 0};
    const int ready = poll(&wait, 1, kPause);
    if (ready == 0 || (ready < 0 && errno == EINTR)) {
      return true;
    }
    std::array<char, 4096> piece;
    const ssize_t size = read(from_.from.get(), piece.data(), piece.size());
    if (size > 0) {
      unread_.append(piece.data(), static_cast<std::size_t>(size));
    }
    return size > 0 || (size < 0 && errno == EINTR);
  }

  Pipe to_, from_;
  std::optional<ChildProcess> process_;
  std::mutex mutex_;
  std::string unread_;
};

LineCommands::LineCommands(std::string program, std::filesystem::path folder)
    : program_(std::move(program)), folder_(std::move(folder)) {}

LineCommands::~LineCommands() = default;

LineCommands::StartedCommand LineCommands::begin(const CommandWords& words) {
  std::shared_ptr<Child> child;
  try {
    child = std::make_shared<Child>(program_, words, folder_);
  } catch (const std::system_error& error) {
    throw RunError(
        fmt::format("{} cannot be started: {}", shown_command(words), error.code().message()));
  }
  std::string said;
  for (auto line = child->line(kLongestStart); line; line = child->line(kLongestStart)) {
    if (line->starts_with('{')) {
      const std::lock_guard lock(mutex_);
      while (children_.size() >= kMostTried) {
        children_.begin()->second->kill();
        children_.erase(children_.begin());
      }
      children_[++last_] = std::move(child);
      return {last_, *line};
    }
    said += *line + "\n";
  }
  return {0, said + child->rest()};
}

std::vector<std::string> LineCommands::answer(int number, const std::vector<std::string>& lines) {
  return child(number)->answer(lines);
}

void LineCommands::end(int number) {
  const std::lock_guard lock(mutex_);
  if (const auto found = children_.find(number); found != children_.end()) {
    found->second->kill();
    children_.erase(found);
  }
}

std::shared_ptr<LineCommands::Child> LineCommands::child(int number) const {
  const std::lock_guard lock(mutex_);
  const auto found = children_.find(number);
  if (found == children_.end()) {
    throw InputError("no command with this number answers; begin again");
  }
  return found->second;
}

}  // namespace haptrial::experiments
