#include "analysis/contact/exam/program_renderer.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <sstream>
#include <system_error>
#include <utility>

#include "analysis/contact/exam/soft_body.h"
#include "core/base/error.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::evaluation {
namespace {

constexpr int kLongest = 60'000;         // an answer may take [ms]
constexpr int kPause = 100;              // between questions whether to go on [ms]
constexpr std::size_t kLongLine = 400;   // [bytes]
constexpr std::size_t kLongNumber = 40;  // with what stands between numbers [bytes]

std::string beginning_of(const std::string& answer) {
  return answer.size() < kLongLine ? answer : answer.substr(0, kLongLine) + "...";
}

}  // namespace

ProgramRenderer::ProgramRenderer(const std::vector<std::string>& words, std::function<bool()> go_on)
    : name_(words.empty() ? "" : words.front()), go_on_(std::move(go_on)) {
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
  kind_ = task.kind();
  if (kind_ == ExamKind::kSoft) {
    vertices_ = read_soft_body(task.body).mesh.vertices.size();
    expect_ready(fmt::format("body soft rate {} {}", task.rate, task.body.string()));
    return;
  }
  expect_ready(fmt::format("body stiffness {} friction {} rate {} {}", task.stiffness,
                           task.friction, task.rate, task.body.string()));
  if (kind_ == ExamKind::kRigid) {
    expect_ready(fmt::format("tool turning {} {}", task.turning_stiffness, task.tool.string()));
  }
}

std::string ProgramRenderer::words_of(const Eigen::Isometry3d& tool) const {
  const Eigen::Vector3d p = tool.translation();
  const std::string place = fmt::format("{} {} {}", p.x(), p.y(), p.z());
  if (kind_ != ExamKind::kRigid) {
    return place;
  }
  const Eigen::Quaterniond q(tool.linear());
  return fmt::format("{} {} {} {} {}", place, q.w(), q.x(), q.y(), q.z());
}

void ProgramRenderer::start(const Eigen::Isometry3d& tool) {
  expect_ready("start " + words_of(tool));
}

Answer ProgramRenderer::tick(double time, const Eigen::Isometry3d& tool) {
  const bool rigid = kind_ == ExamKind::kRigid;
  const std::string load = kind_ == ExamKind::kSoft ? fmt::format(" {}", load_) : "";
  const std::vector<double> said =
      ask_numbers(fmt::format("tick {} {}{}", time, words_of(tool), load), rigid ? 6 : 3);
  Answer answer;
  answer.force = {said[0], said[1], said[2]};
  if (rigid) {
    answer.torque = {said[3], said[4], said[5]};
  }
  return answer;
}

deformable::Vectors ProgramRenderer::shape() {
  const std::vector<double> said = ask_numbers("shape", 3 * vertices_);
  deformable::Vectors moved;
  for (std::size_t i = 0; i < said.size(); i += 3) {
    moved.emplace_back(said[i], said[i + 1], said[i + 2]);
  }
  return moved;
}

void ProgramRenderer::expect_ready(const std::string& line) {
  const std::string answer = ask(line, kLongLine);
  if (answer != "ready") {
    throw InputError(fmt::format("--program: {} answers '{}' to '{}'; allowed: ready", name_,
                                 beginning_of(answer), line));
  }
}

std::vector<double> ProgramRenderer::ask_numbers(const std::string& line, std::size_t count) {
  const std::string said = ask(line, kLongLine + kLongNumber * count);
  std::istringstream words(said);
  words.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double number = 0.0; words >> number && std::isfinite(number);) {
    numbers.push_back(number);
  }
  if (numbers.size() != count || !words.eof()) {
    throw InputError(fmt::format("--program: {} answers '{}' to '{}'; allowed: {} finite numbers",
                                 name_, beginning_of(said), line, count));
  }
  return numbers;
}

void ProgramRenderer::check_cancelled() const {
  if (go_on_ && !go_on_()) {
    throw geometry::Cancelled();
  }
}

/// @returns whether something was read before the time was over.
bool ProgramRenderer::read_more() {
  pollfd waited{from_.from.get(), POLLIN, 0};
  int ready = 0;
  for (int passed = 0; ready <= 0 && passed < kLongest; passed += kPause) {
    ready = ::poll(&waited, 1, kPause);
    check_cancelled();
  }
  if (ready <= 0) {
    return false;
  }
  std::array<char, 4096> bytes;
  const ssize_t count = ::read(waited.fd, bytes.data(), bytes.size());
  if (count > 0) {
    rest_.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return count > 0;
}

std::string ProgramRenderer::ask(const std::string& line, std::size_t longest) {
  const std::string sent = line + "\n";
  bool there = write_fully(to_.to.get(), sent.data(), sent.size());
  std::size_t end = rest_.find('\n');
  while (there && end == std::string::npos && rest_.size() < longest) {
    there = read_more();
    end = rest_.find('\n');
  }
  if (end == std::string::npos) {
    throw InputError(fmt::format(
        "--program: {} gave no line to '{}'{}; allowed: one line within a "
        "minute",
        name_, line, rest_.empty() ? "" : fmt::format(" but '{}'", beginning_of(rest_))));
  }
  std::string answer = rest_.substr(0, end);
  rest_.erase(0, end + 1);
  if (answer.ends_with('\r')) {
    answer.pop_back();
  }
  return answer;
}

}  // namespace haptrial::evaluation
