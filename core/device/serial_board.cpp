#include "core/device/serial_board.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/serial_port.h"
#include "core/realtime/real_time.h"

namespace haptrial::device {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLineLook{5};      // for silence and the end
constexpr milliseconds kAnswerTime{5};    // then a board is asked again
constexpr milliseconds kStartAgain{250};  // likewise one that may be restarting
constexpr milliseconds kLastWord{50};     // for the zero force at the end

constexpr const char* kSilent = "the board gives no readings; check its power and firmware";
constexpr const char* kLost = "the board's serial line was lost; check its cable and power";

/// The thread goes on while a signal's handler on another one takes the force away.
void block_signals() {
  sigset_t all;
  sigfillset(&all);
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    sigdelset(&all, crash);
  }
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

std::chrono::duration<double> seconds(double value) { return std::chrono::duration<double>(value); }

void check_setup(const SerialBoardSetup& s, double rate) {
  if (!(s.max_force > 0.0 && s.workspace_radius > 0.0 && s.patience > 0.0 && s.start_time > 0.0 &&
        s.velocity_window > 0.0 && rate > 0.0)) {
    throw std::invalid_argument("SerialBoard: a parameter is out of its bounds");
  }
}

}  // namespace

std::vector<std::string> find_serial_lines() {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/serial/by-id", error)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string missing_axes_sentence(const std::string& name, const Eigen::Vector3d& axes) {
  std::vector<std::string> has;
  std::vector<std::string> lacks;
  for (int axis = 0; axis < 3; ++axis) {
    (axes[axis] > 0.0 ? has : lacks).emplace_back(1, "xyz"[axis]);
  }
  return lacks.empty() ? ""
                       : fmt::format(
                             "the {} moves and gives forces along {} alone; forces along {} "
                             "are left out, and the hand does not move there",
                             name, fmt::join(has, " and "), fmt::join(lacks, " and "));
}

const Schema<SerialBoardSetup>& serial_board_schema() {
  using S = SerialBoardSetup;
  static const auto schema =
      Schema<S>()
          .text("port", &S::port, "Serial line of the board: /dev/serial/by-id/… or /dev/ttyACM0")
          .required()
          .integer("baud", &S::baud, 9600, 921600,
                   "Bits per second on the serial line; a board with USB of its own ignores them")
          .number("max_force", &S::max_force, {0.0, 100.0, true}, "N",
                  "Greatest force that the board's motors hold")
          .number("workspace_radius", &S::workspace_radius, {0.0, 2.0, true}, "m",
                  "Radius of the board's workspace")
          .number("patience", &S::patience, {0.002, 1.0}, "s",
                  "Silence between the loop and the board after which the force is switched off")
          .number("start_time", &S::start_time, {0.1, 60.0}, "s",
                  "Longest time from the opening of the line, which restarts many boards, to the "
                  "first reading")
          .number("velocity_window", &S::velocity_window, {0.001, 0.015}, "s",
                  "Time of readings over which velocity is estimated")
          .check([](Table& table, const S& s) {
            if (!has_serial_rate(s.baud)) {
              table.reject("baud", std::to_string(s.baud),
                           "9600, 19200, 38400, 57600, 115200, 230400, 460800 or 921600");
            }
          });
  return schema;
}

SerialBoard::SerialBoard(SerialBoardSetup setup, std::unique_ptr<BoardProtocol> protocol,
                         double rate)
    : setup_((check_setup(setup, rate), std::move(setup))),
      protocol_(std::move(protocol)),
      info_{setup_.table, setup_.max_force, setup_.workspace_radius},
      rate_(rate),
      patience_ticks_(std::max(1, static_cast<int>(std::lround(setup_.patience * rate)))),
      window_ticks_(setup_.velocity_window * rate) {
  info_.force_axes = setup_.force_axes;
  open();
  thread_ = std::thread([this] { run(); });
  try {
    await_first_reading();
  } catch (...) {
    close();
    throw;
  }
}

SerialBoard::~SerialBoard() { close(); }

void SerialBoard::open() {
  line_ = open_serial_port(setup_.port, setup_.baud);
  if (line_ < 0) {
    throw InputError(fmt::format(
        "{0} {1}: {2}; connect the board, check {0}.port (/dev/serial/by-id names what is "
        "connected) and that you may open it (on Debian: group dialout)",
        setup_.table, setup_.port, errno == ENOTTY ? "is no serial line" : std::strerror(errno)));
  }
  wake_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (wake_ < 0) {
    const int error = errno;
    ::close(line_);
    throw RunError(fmt::format("{} {}: {}", setup_.table, setup_.port, std::strerror(error)));
  }
}

void SerialBoard::await_first_reading() {
  const auto deadline = Clock::now() + seconds(setup_.start_time);
  while (!sensed_.read(latest_)) {
    if (Clock::now() > deadline) {
      over_.store(true, std::memory_order_release);
      thread_.join();
      const std::string heard = protocol_->misunderstood();
      throw RunError(fmt::format(
          "{0} {1}: the board gives no reading within {2:g} s, {0}.start_time; {3}", setup_.table,
          setup_.port, setup_.start_time,
          heard.empty() ? std::string("check its power, its firmware and the baud rate")
                        : fmt::format("it sends \"{}\", which is no reading: check its firmware, "
                                      "the baud rate and the keys of [{}]",
                                      heard, setup_.table)));
    }
    std::this_thread::sleep_for(milliseconds(1));
  }
  if (latest_.trouble == kLost) {
    throw RunError(fmt::format("{} {}: {}", setup_.table, setup_.port, kLost));
  }
}

void SerialBoard::close() noexcept {
  over_.store(true, std::memory_order_release);
  if (thread_.joinable()) {
    thread_.join();
  }
  ::close(wake_);
  ::close(line_);
}

bool SerialBoard::read(DeviceReading& reading) noexcept {
  tick_ += 1.0;
  if (sensed_.read(latest_)) {
    ticks_without_news_ = 0;
    placed_ = *latest_.trouble != '\0' ? 0 : placed_;
    places_[placed_++ % places_.size()] = {tick_, latest_.position};
  } else {
    stale_.fetch_add(1, std::memory_order_relaxed);
    ++ticks_without_news_;
  }
  trouble_ = *latest_.trouble != '\0'                ? latest_.trouble
             : ticks_without_news_ > patience_ticks_ ? kSilent
                                                     : "";
  if (*trouble_ != '\0') {
    return false;
  }
  reading.tool.position = latest_.position;
  reading.tool.velocity = velocity();
  reading.buttons = latest_.buttons;
  reading.stop_pressed = is_pressed(latest_.buttons, setup_.stop_button);
  return true;
}

/// Slope of a straight line through the fresh readings of the window, at least two of them.
Eigen::Vector3d SerialBoard::velocity() const noexcept {
  const std::size_t held = std::min(placed_, places_.size());
  std::size_t count = 0;
  double time = 0.0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  const auto recent = [&](std::size_t age) -> const Place& {
    return places_[(placed_ - 1 - age) % places_.size()];
  };
  while (count < held && (count < 2 || recent(count).tick >= tick_ - window_ticks_)) {
    time += recent(count).tick;
    place += recent(count).position;
    ++count;
  }
  if (count < 2) {
    return Eigen::Vector3d::Zero();
  }
  time /= static_cast<double>(count);
  place /= static_cast<double>(count);
  double square = 0.0;
  Eigen::Vector3d product = Eigen::Vector3d::Zero();
  for (std::size_t age = 0; age < count; ++age) {
    const double late = recent(age).tick - time;
    square += late * late;
    product += late * (recent(age).position - place);
  }
  return rate_ / square * product;
}

bool SerialBoard::write(const Wrench& wrench) noexcept {
  command_.write(wrench.force);
  eventfd_write(wake_, 1);  // never waits: it fails when the count is at its end
  return true;
}

void SerialBoard::run() {
  block_signals();
  const realtime::RealTimeScope urgent(realtime::RealTimeScope::kPriority - 10);
  auto next = Clock::now();
  while (!over_.load(std::memory_order_acquire) && readings() == 0 && !lost_) {
    if (Clock::now() >= next) {
      next = Clock::now() + kStartAgain;
      protocol_->forget();
      send(protocol_->start_message());
      ask();
    }
    wait(kLineLook);
    hear();
  }
  while (!over_.load(std::memory_order_acquire) && !lost_) {  // silent until the first command
    exchange();
  }
  if (!lost_) {
    command(Eigen::Vector3d::Zero());
    for (const auto end = Clock::now() + kLastWord; !unsent_.empty() && Clock::now() < end;) {
      std::this_thread::sleep_for(milliseconds(1));
      flush();
    }
  }
}

void SerialBoard::exchange() {
  wait(kLineLook);
  take_command();
  hear();
  const auto now = Clock::now();
  const bool silent = now - commanded_at_ > seconds(setup_.patience);
  if (silent) {
    force_.setZero();
  }
  const bool late = now - asked_at_ > kAnswerTime;
  if (protocol_->answers() && (asked_ ? late : wanted_ || (silent && late))) {
    if (asked_) {
      protocol_->forget();
    }
    ask();
  } else if (!protocol_->answers() && force_.isZero(0.0) && !sent_.isZero(0.0)) {
    command(force_);  // at once, even if the board has ceased to speak
  }
}

/// Until something comes, at most for that time.
void SerialBoard::wait(milliseconds most) {
  std::array<pollfd, 2> ready{pollfd{line_, POLLIN, 0}, pollfd{wake_, POLLIN, 0}};
  poll(ready.data(), ready.size(), static_cast<int>(most.count()));
}

void SerialBoard::take_command() {
  eventfd_t count = 0;
  if (eventfd_read(wake_, &count) == 0 && command_.read(force_)) {
    commanded_at_ = Clock::now();
    wanted_ = true;
    if (!force_.allFinite()) {
      force_.setZero();
    }
  }
}

void SerialBoard::hear() {
  std::array<char, 512> bytes{};
  const ssize_t count = ::read(line_, bytes.data(), bytes.size());
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) {
    lose();
    return;
  }
  if (count < 0) {
    return;
  }
  const auto reading = protocol_->take({bytes.data(), static_cast<std::size_t>(count)});
  if (!reading) {
    return;
  }
  asked_ = false;
  sensed_.write(*reading);
  if (!protocol_->answers()) {
    command(force_);
  }
  readings_.fetch_add(1, std::memory_order_release);
}

void SerialBoard::ask() {
  command(force_);
  asked_ = true;
  asked_at_ = Clock::now();
  wanted_ = false;
}

void SerialBoard::command(const Eigen::Vector3d& force) {
  if (send(protocol_->force_message(force))) {
    sent_ = force;
  }
}

/// A message that the line does not take whole is finished before another is begun.
/// @returns whether this one was begun
bool SerialBoard::send(std::string_view bytes) {
  flush();
  if (!unsent_.empty()) {
    return false;
  }
  unsent_ = bytes;
  flush();
  return true;
}

void SerialBoard::flush() {
  while (!unsent_.empty() && !lost_) {
    const ssize_t count = ::write(line_, unsent_.data(), unsent_.size());
    if (count > 0) {
      unsent_.erase(0, static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      lose();
    }
  }
}

void SerialBoard::lose() {
  lost_ = true;
  BoardReading last;
  last.trouble = kLost;
  sensed_.write(last);
}

}  // namespace haptrial::device
