#include "analysis/contact/exam/program_renderer.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <sstream>
#include <system_error>

#include "core/base/error.h"

namespace haptrial::evaluation {
namespace {

constexpr int kLongest = 60'000;        // an answer may take [ms]
constexpr std::size_t kLongLine = 400;  // [bytes]

/// @returns whether something was read before the time was over.
bool read_more(int from, std::string& text) {
  pollfd waited{from, POLLIN, 0};
  if (::poll(&waited, 1, kLongest) <= 0) {
    return false;
  }
  std::array<char, 4096> bytes;
  const ssize_t count = ::read(from, bytes.data(), bytes.size());
  if (count > 0) {
    text.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return count > 0;
}

}  // namespace

ProgramRenderer::ProgramRenderer(const std::vector<std::string>& words)
    : name_(words.empty() ? "" : words.front()) {
  try {
    program_ = std::make_unique<ChildProcess>(
        Program{.words = words, .input = to_.from.get(), .output = from_.to.get()});
  } catch (const std::system_error& error) {
    throw InputError(
        fmt::format("--program: {} cannot be started: {}", name_, error.code().message()));
  }
  to_.from.close();
  from_.to.close();
}

void ProgramRenderer::begin(const ContactTask& task) {
  rigid_ = task.is_rigid();
  expect_ready(fmt::format("body stiffness {} friction {} rate {} {}", task.stiffness,
                           task.friction, task.rate, task.body.string()));
  if (rigid_) {
    expect_ready(fmt::format("tool turning {} {}", task.turning_stiffness, task.tool.string()));
  }
}

std::string ProgramRenderer::words_of(const Eigen::Isometry3d& tool) const {
  const Eigen::Vector3d p = tool.translation();
  const std::string place = fmt::format("{} {} {}", p.x(), p.y(), p.z());
  if (!rigid_) {
    return place;
  }
  const Eigen::Quaterniond q(tool.linear());
  return fmt::format("{} {} {} {} {}", place, q.w(), q.x(), q.y(), q.z());
}

void ProgramRenderer::start(const Eigen::Isometry3d& tool) {
  expect_ready("start " + words_of(tool));
}

Answer ProgramRenderer::tick(double time, const Eigen::Isometry3d& tool) {
  const std::string line = fmt::format("tick {} {}", time, words_of(tool));
  const std::string said = ask(line);
  std::istringstream words(said);
  words.imbue(std::locale::classic());
  Answer answer;
  const auto read = [&](Eigen::Vector3d& v) {
    return words >> v.x() >> v.y() >> v.z() && v.allFinite();
  };
  std::string more;
  if (!read(answer.force) || (rigid_ && !read(answer.torque)) || words >> more) {
    refuse(line, said);
  }
  return answer;
}

void ProgramRenderer::expect_ready(const std::string& line) {
  const std::string answer = ask(line);
  if (answer != "ready") {
    refuse(line, answer);
  }
}

std::string ProgramRenderer::ask(const std::string& line) {
  const std::string sent = line + "\n";
  bool there = write_fully(to_.to.get(), sent.data(), sent.size());
  std::size_t end = rest_.find('\n');
  while (there && end == std::string::npos && rest_.size() < kLongLine) {
    there = read_more(from_.from.get(), rest_);
    end = rest_.find('\n');
  }
  if (end == std::string::npos) {
    throw InputError(
        fmt::format("--program: {} gave no line to '{}'{}; allowed: one line within a "
                    "minute",
                    name_, line, rest_.empty() ? "" : fmt::format(" but '{}'", rest_)));
  }
  std::string answer = rest_.substr(0, end);
  rest_.erase(0, end + 1);
  if (answer.ends_with('\r')) {
    answer.pop_back();
  }
  return answer;
}

void ProgramRenderer::refuse(const std::string& line, const std::string& found) const {
  throw InputError(fmt::format("--program: {} answers '{}' to '{}'; allowed: {}", name_, found,
                               line,
                               !line.starts_with("tick") ? "ready"
                               : rigid_                  ? "six finite numbers"
                                                         : "three finite numbers"));
}

}  // namespace haptrial::evaluation
