// Boost.Beast is slow to compile: this file alone includes it.
#include "core/device/haply_link.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <thread>

#include "core/base/error.h"
#include "core/realtime/latest_value.h"
#include "core/realtime/real_time.h"

namespace haptrial::device {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::array kPorts{10001, 10000};  // since 3.1; 3.0
constexpr std::chrono::microseconds kShortestExchange{250};
constexpr std::chrono::seconds kTimeToAnswer{2};
constexpr std::chrono::milliseconds kTimeToClose{200};

constexpr const char* kHowToStart =
    "start it (Haply Hub, or systemctl start haply-inverse-service)";

/// Runs one asynchronous operation to its end, or for a while.
/// @param start   starts it with the handler that it is given
/// @param cancel  makes it end
template <class Start, class Cancel>
error_code finish(asio::io_context& io, Start start, Cancel cancel) {
  std::optional<error_code> result;
  start([&result](const error_code& error, auto&&...) { result = error; });
  const auto deadline = Clock::now() + kTimeToAnswer;
  io.restart();
  while (!result && io.run_one_until(deadline) > 0) {
  }
  if (!result) {
    cancel();
    io.restart();
    while (!result && io.run_one() > 0) {
    }
    return asio::error::timed_out;
  }
  return *result;
}

/// Connects to this machine, by either version of the internet protocol.
bool connect(asio::io_context& io, tcp::socket& socket, int port) {
  for (const char* address : {"127.0.0.1", "::1"}) {
    const tcp::endpoint endpoint(asio::ip::make_address(address),
                                 static_cast<unsigned short>(port));
    const error_code error = finish(
        io, [&](auto handler) { socket.async_connect(endpoint, handler); },
        [&] { socket.close(); });
    if (!error) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      return true;
    }
    error_code ignored;
    socket.close(ignored);
  }
  return false;
}

/// Asks for the version; empty if the service does not answer such a request.
std::string ask_version(asio::io_context& io, int port) {
  tcp::socket socket(io);
  if (!connect(io, socket, port)) {
    return "";
  }
  http::request<http::empty_body> request(http::verb::get, "/version", 11);
  request.set(http::field::host, fmt::format("localhost:{}", port));
  request.set(http::field::connection, "close");
  http::response<http::string_body> response;
  beast::flat_buffer buffer;
  const auto close = [&] { socket.close(); };
  const error_code sent = finish(
      io, [&](auto handler) { http::async_write(socket, request, handler); }, close);
  const error_code read =
      sent ? sent
           : finish(
                 io, [&](auto handler) { http::async_read(socket, buffer, response, handler); },
                 close);
  return read || response.result() != http::status::ok ? "" : read_haply_version(response.body());
}

using Stream = beast::websocket::stream<tcp::socket>;

/// Connects a stream, and reads the first message.
/// @param port  0: either of the usual ones
HaplyService open_stream(asio::io_context& io, Stream& stream, int port) {
  std::vector<int> ports(kPorts.begin(), kPorts.end());
  if (port != 0) {
    ports = {port};
  }
  for (const int each : ports) {
    if (!connect(io, stream.next_layer(), each)) {
      continue;
    }
    const auto close = [&] { stream.next_layer().close(); };
    const error_code shaken = finish(
        io,
        [&](auto handler) {
          stream.async_handshake(fmt::format("localhost:{}", each), "/", handler);
        },
        close);
    beast::flat_buffer buffer;
    const error_code read =
        shaken ? shaken
               : finish(
                     io, [&](auto handler) { stream.async_read(buffer, handler); }, close);
    const auto inventory =
        read ? std::nullopt : read_haply_inventory(beast::buffers_to_string(buffer.data()));
    if (!inventory) {
      throw RunError(fmt::format(
          "port {} answers, but not as Haply's Inverse Service does; allowed: a service of version "
          "3.0 to 3.5, and port of [haply] for one on another port",
          each));
    }
    return {each, ask_version(io, each), *inventory};
  }
  throw RunError(fmt::format("no Haply Inverse Service answers on port {} of this computer; {}",
                             fmt::join(ports, " or "), kHowToStart));
}

/// The chosen one of a list, and after it the others in their order.
/// @param number  how many after it; the list has none there: null
const HaplyListing* choose(std::vector<HaplyListing>& list, const std::string& id, int number,
                           const char* what) {
  if (!id.empty()) {
    const auto named = std::find_if(list.begin(), list.end(),
                                    [&](const HaplyListing& each) { return each.id == id; });
    if (named == list.end()) {
      std::vector<std::string> ids;
      for (const HaplyListing& each : list) {
        ids.push_back(each.id);
      }
      throw RunError(fmt::format("the Inverse Service lists no {} '{}'; it lists: {}", what, id,
                                 ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, ", "))));
    }
    std::rotate(list.begin(), named, named + 1);
  }
  return static_cast<std::size_t>(number) < list.size() ? &list[static_cast<std::size_t>(number)]
                                                        : nullptr;
}

}  // namespace

class HaplyLink::Connection {
 public:
  explicit Connection(const HaplyAddress& address)
      : patience_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(address.patience))) {
    open(address);
    exchange_first();
    thread_ = std::thread([this] { run(); });
    running_.wait(false);  // a busy computer may start an ordinary thread late
  }
  ~Connection() {
    asio::post(io_, [this] { end(); });
    thread_.join();
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  const HaplyListing& device() const noexcept { return device_; }
  const std::string& grip() const noexcept { return grip_; }
  const std::string& version() const noexcept { return version_; }
  bool read(HaplyState& state) noexcept { return sensed_.read(state); }
  void write(const Eigen::Vector3d& force) noexcept { command_.write(force); }

 private:
  void open(const HaplyAddress& address);
  void exchange_first();
  // The link's thread.
  void run() noexcept;
  void receive();
  void pace();
  void wait_until(Clock::time_point when);
  void send();
  void end();
  void lose();
  void take(std::string_view text);
  Eigen::Vector3d newest_force();

  Clock::duration patience_;
  HaplyListing device_;
  std::string grip_;
  std::string version_;
  realtime::LatestValue<HaplyState> sensed_;        // link -> servo
  realtime::LatestValue<Eigen::Vector3d> command_;  // servo -> link

  asio::io_context io_{1};
  Stream stream_{io_};
  asio::steady_timer timer_{io_};
  asio::steady_timer closing_{io_};
  beast::flat_buffer buffer_;
  std::optional<HaplyCommands> commands_;
  std::string message_;
  HaplyState state_;
  Eigen::Vector3d force_{Eigen::Vector3d::Zero()};
  Clock::time_point commanded_at_;
  Clock::time_point sent_at_;
  Clock::time_point fault_until_;
  HaplyFault fault_{HaplyFault::kNone};  // is told until then
  int unanswered_{0};                    // messages
  bool answered_{true};                  // a state came since the last message
  bool writing_{false};
  bool ending_{false};
  bool lost_{false};
  std::atomic<bool> running_{false};
  std::thread thread_;
};

void HaplyLink::Connection::open(const HaplyAddress& address) {
  HaplyService service = open_stream(io_, stream_, address.port);
  version_ = service.version;
  const HaplyListing* const device =
      choose(service.inventory.devices, address.device_id, address.number, "device");
  if (device == nullptr) {
    const std::size_t count = service.inventory.devices.size();
    throw RunError(count == 0 ? std::string("the Inverse Service lists no device; check cable and "
                                            "power")
                              : fmt::format("the Inverse Service lists {} of the {} devices that "
                                            "are needed; check cable and power",
                                            count, address.number + 1));
  }
  if (!device->plain_axes) {
    throw RunError(fmt::format(
        "the Inverse Service turns, moves or scales the positions of device '{}' (basis, mount or "
        "transform); allowed: its own axes, as after a restart of the service",
        device->id));
  }
  device_ = *device;
  const HaplyListing* const grip =
      choose(service.inventory.grips, address.grip_id, address.number, "grip");
  grip_ = grip != nullptr ? grip->id : "";
  commands_.emplace(device_.id, version_);
}

void HaplyLink::Connection::exchange_first() {
  message_ = commands_->first();
  const auto close = [this] { stream_.next_layer().close(); };
  const error_code sent = finish(
      io_, [this](auto handler) { stream_.async_write(asio::buffer(message_), handler); }, close);
  const error_code read =
      sent ? sent
           : finish(
                 io_, [this](auto handler) { stream_.async_read(buffer_, handler); }, close);
  if (read) {
    throw RunError(
        "the Inverse Service lists the device, but does not answer; restart the service");
  }
  take(beast::buffers_to_string(buffer_.data()));
  buffer_.consume(buffer_.size());
  if (state_.fault != HaplyFault::kNone || state_.status != HaplyFault::kNone) {
    throw RunError(
        fmt::format("device '{}' cannot be used: {}", device_.id,
                    describe(state_.fault != HaplyFault::kNone ? state_.fault : state_.status)));
  }
  sent_at_ = commanded_at_ = Clock::now();
}

/// Runs below the servo thread, which it must not delay, and above everything else.
void HaplyLink::Connection::run() noexcept {
  const realtime::RealTimeScope urgent(realtime::RealTimeScope::kPriority - 10);
  running_.store(true);
  running_.notify_one();
  try {
    io_.restart();
    receive();
    pace();
    io_.run();
  } catch (const std::exception&) {  // no memory
    lose();
  }
}

void HaplyLink::Connection::receive() {
  stream_.async_read(buffer_, [this](const error_code& error, std::size_t) {
    if (error) {
      lose();
      return;
    }
    const auto data = buffer_.data();
    take({static_cast<const char*>(data.data()), data.size()});
    buffer_.consume(buffer_.size());
    receive();
    answered_ = true;
    unanswered_ = std::max(0, unanswered_ - 1);
    if (!ending_ && unanswered_ == 0) {
      pace();
    }
  });
}

/// Sends after a state: one that came twice brings no second message. Neither do the answers to
/// messages that were sent again, or they would wait in the service from then on.
void HaplyLink::Connection::pace() {
  wait_until(std::max(Clock::now(), sent_at_ + kShortestExchange));
}

/// Replaces the wait before this one.
void HaplyLink::Connection::wait_until(Clock::time_point when) {
  timer_.expires_at(when);
  timer_.async_wait([this](const error_code& error) {
    if (!error && !ending_) {
      send();
    }
  });
}

void HaplyLink::Connection::send() {
  if (lost_) {
    return;
  }
  if (!writing_) {
    message_ = commands_->force(newest_force());
    writing_ = true;
    sent_at_ = Clock::now();
    unanswered_ = answered_ ? 1 : unanswered_ + 1;  // what is missing by now does not come
    answered_ = false;
    stream_.async_write(asio::buffer(message_), [this](const error_code& error, std::size_t) {
      writing_ = false;
      if (error) {
        lose();
      } else if (ending_ && message_ != commands_->force(Eigen::Vector3d::Zero())) {
        send();
      } else if (ending_) {
        stream_.async_close(beast::websocket::close_code::normal,
                            [this](const error_code&) { io_.stop(); });
      }
    });
  }
  wait_until(Clock::now() + patience_ / 4);
}

void HaplyLink::Connection::end() {
  ending_ = true;
  timer_.cancel();
  if (lost_) {
    io_.stop();
    return;
  }
  closing_.expires_after(kTimeToClose);
  closing_.async_wait([this](const error_code&) { io_.stop(); });
  if (!writing_) {
    send();
  }
}

void HaplyLink::Connection::lose() {
  lost_ = true;
  timer_.cancel();
  state_.fault = HaplyFault::kClosed;
  sensed_.write(state_);
  if (ending_) {
    io_.stop();
  }
}

// A fault is told for a while: the state after it, which is well, may replace it before it was
// read.
void HaplyLink::Connection::take(std::string_view text) {
  state_ = read_haply_state(text, device_.id, grip_, state_);
  const auto now = Clock::now();
  if (state_.fault != HaplyFault::kNone) {
    fault_ = state_.fault;
    fault_until_ = now + patience_;
  } else if (now < fault_until_) {
    state_.fault = fault_;
  }
  sensed_.write(state_);
}

Eigen::Vector3d HaplyLink::Connection::newest_force() {
  const auto now = Clock::now();
  if (command_.read(force_)) {
    commanded_at_ = now;
  } else if (now - commanded_at_ > patience_) {
    force_.setZero();
  }
  if (ending_ || !force_.allFinite()) {
    force_.setZero();
  }
  return force_;
}

HaplyLink::HaplyLink(const HaplyAddress& address)
    : connection_(std::make_unique<Connection>(address)) {}
HaplyLink::~HaplyLink() = default;

const HaplyListing& HaplyLink::device() const noexcept { return connection_->device(); }
bool HaplyLink::has_grip() const noexcept { return !connection_->grip().empty(); }
const std::string& HaplyLink::version() const noexcept { return connection_->version(); }
bool HaplyLink::read(HaplyState& state) noexcept { return connection_->read(state); }
void HaplyLink::write(const Eigen::Vector3d& force) noexcept { connection_->write(force); }

HaplyService find_haply_service(int port) {
  asio::io_context io{1};
  Stream stream(io);
  HaplyService service = open_stream(io, stream, port);
  finish(
      io, [&](auto handler) { stream.async_close(beast::websocket::close_code::normal, handler); },
      [&] { stream.next_layer().close(); });
  return service;
}

}  // namespace haptrial::device
