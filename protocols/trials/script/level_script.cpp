#include "protocols/trials/script/level_script.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

namespace haptrial::protocols {
namespace {

using Json = nlohmann::json;

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

/// Nothing for a line that is no answer, such as one that the script prints for itself.
std::optional<LevelScript::Answer> answer_in(const std::string& line, std::size_t dimensions) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("level")) {
    return std::nullopt;
  }
  const Json& said = json["level"];
  if (said.is_null()) {
    return LevelScript::Answer{std::nullopt, "it left the choice to the procedure"};
  }
  psychometric::Level level;
  for (const Json& each : said.is_array() ? said : Json::array({said})) {
    level.push_back(each.is_number() ? each.get<double>() : std::nan(""));
  }
  const bool finite = std::ranges::all_of(level, [](double each) { return std::isfinite(each); });
  if (level.size() != dimensions || !finite) {
    return LevelScript::Answer{std::nullopt,
                               fmt::format("its level was {}, not {}", said.dump(),
                                           dimensions == 1
                                               ? "a number"
                                               : fmt::format("{} numbers", dimensions))};
  }
  return LevelScript::Answer{std::move(level), ""};
}

}  // namespace

LevelScript::LevelScript(std::filesystem::path file, double deadline)
    : file_(std::filesystem::absolute(std::move(file))), deadline_(deadline) {}

LevelScript::~LevelScript() { stop(); }

void LevelScript::start() {
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
}

void LevelScript::stop() noexcept {
  to_.close();
  if (process_) {
    process_->kill();
    process_.reset();
  }
  from_.close();
}

std::optional<std::string> LevelScript::line_before(Clock::time_point end,
                                                    const std::function<void()>& pulse) {
  constexpr int kLook = 50;  // [ms]
  while (true) {
    if (const std::size_t at = heard_.find('\n'); at != std::string::npos) {
      std::string line = heard_.substr(0, at);
      heard_.erase(0, at + 1);
      return line;
    }
    if (Clock::now() >= end) {
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

LevelScript::Answer LevelScript::lost() {
  const std::string said = said_;
  stop();
  return {std::nullopt, "it ended without a level" + (said.empty() ? "" : ": " + said)};
}

LevelScript::Answer LevelScript::ask(const std::string& question, std::size_t dimensions,
                                     const std::function<void()>& pulse) {
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(deadline_));
  try {
    if (!process_) {
      start();
    }
  } catch (const std::system_error& error) {
    return {std::nullopt, fmt::format("it cannot be started: {}", error.what())};
  }
  const bool sent = send_all(to_.get(), question + '\n');
  while (const auto line = line_before(end, pulse)) {
    if (auto answer = answer_in(*line, dimensions); answer && sent) {
      return *answer;
    }
    if (!line->empty()) {
      said_ = *line;
    }
  }
  if (Clock::now() < end) {
    return lost();
  }
  stop();  // its answer would be one to the next question
  return {std::nullopt, fmt::format("it gave no level within {:g} s", deadline_)};
}

}  // namespace haptrial::protocols
