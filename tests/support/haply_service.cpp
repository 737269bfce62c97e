#include "tests/support/haply_service.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

namespace haptrial::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Json = nlohmann::json;

Json vector(const std::array<double, 3>& v) { return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}}; }

/// A service's threads are urgent, too; refused, they are merely less even.
void make_urgent() {
  const sched_param urgent{75};
  ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &urgent);
}

asio::io_context& context() {
  static asio::io_context io;
  return io;
}

}  // namespace

/// One connection, on a thread of its own that reads a message, waits for a tick and answers.
struct HaplyService::Client {
  explicit Client(tcp::socket socket)
      : descriptor(::dup(socket.native_handle())), stream(std::move(socket)) {}
  ~Client() { ::close(descriptor); }

  const int descriptor;  // to shut it down from other threads: the stream may close its own
  beast::websocket::stream<tcp::socket> stream;
  bool open{false};     // of mutex_
  bool waiting{false};  // for a tick; of mutex_
  bool stepped{false};  // of mutex_
  std::thread thread;
};

HaplyService::HaplyService(const Options& options) : options_(options) {
  handle_.forces_on = true;
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const auto endpoint =
      tcp::endpoint(asio::ip::address_v4::loopback(), static_cast<unsigned short>(options.port));
  if (::bind(listener_, endpoint.data(), static_cast<socklen_t>(endpoint.size())) != 0 ||
      ::listen(listener_, 8) != 0) {
    ::close(listener_);
    throw std::runtime_error("the stand-in of the Inverse Service finds no port");
  }
  tcp::endpoint bound;
  socklen_t size = static_cast<socklen_t>(bound.capacity());
  ::getsockname(listener_, bound.data(), &size);
  port_ = bound.port();
  listening_ = std::thread([this] { listen(); });
  if (options.rate > 0.0) {
    ticking_ = std::thread([this] { tick_on(); });
  }
}

HaplyService::~HaplyService() {
  kill();
  listening_.join();
  if (ticking_.joinable()) {
    ticking_.join();
  }
  for (const auto& client : clients_) {
    client->thread.join();
  }
  ::close(listener_);
}

std::string HaplyService::table() const {
  return fmt::format(
      "\n[haply]\nport = {}\nmax_force = 12.0\nworkspace_radius = 0.1\npatience = 0.02\n"
      "stop_button = 2\n",
      port_);
}

void HaplyService::kill() {
  const std::lock_guard lock(mutex_);
  dead_ = true;
  ::shutdown(listener_, SHUT_RDWR);
  for (const auto& client : clients_) {
    ::shutdown(client->descriptor, SHUT_RDWR);
  }
  changed_.notify_all();
}

void HaplyService::fail(Failure failure, long ticks) {
  const std::lock_guard lock(mutex_);
  handle_.failure = failure;
  handle_.failure_tick = handle_.ticks + ticks;
}

void HaplyService::with_handle(const std::function<void(StandInHandle&)>& change) {
  const std::lock_guard lock(mutex_);
  change(handle_);
}

void HaplyService::set_hand(std::function<void(StandInHandle&, double)> hand) {
  const std::lock_guard lock(mutex_);
  hand_ = std::move(hand);
}

void HaplyService::turn_grip(double w, double x, double y, double z) {
  const std::lock_guard lock(mutex_);
  grip_ = {w, x, y, z};
}

std::array<double, 3> HaplyService::force() {
  const std::lock_guard lock(mutex_);
  return handle_.force;
}

double HaplyService::force_size() {
  const auto f = force();
  return std::hypot(f[0], f[1], f[2]);
}

long HaplyService::ticks() {
  const std::lock_guard lock(mutex_);
  return handle_.ticks;
}

long HaplyService::messages() {
  const std::lock_guard lock(mutex_);
  return messages_;
}

std::string HaplyService::first_message() {
  const std::lock_guard lock(mutex_);
  return first_;
}

bool HaplyService::has_client() {
  const std::lock_guard lock(mutex_);
  for (const auto& client : clients_) {
    if (client->open) {
      return true;
    }
  }
  return false;
}

void HaplyService::listen() {
  for (;;) {
    const int accepted = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (accepted < 0) {
      return;
    }
    const std::lock_guard lock(mutex_);
    tcp::socket socket(context(), tcp::v4(), accepted);
    socket.set_option(tcp::no_delay(true));
    clients_.push_back(std::make_unique<Client>(std::move(socket)));
    Client& client = *clients_.back();
    if (dead_) {
      ::shutdown(client.descriptor, SHUT_RDWR);
    }
    client.thread = std::thread([this, &client] {
      try {
        serve(client);
      } catch (const std::exception&) {  // the client went away, or was sent away
      }
      const std::lock_guard end(mutex_);
      client.open = false;
      client.waiting = false;
      ::shutdown(client.descriptor, SHUT_RDWR);
      changed_.notify_all();
    });
  }
}

void HaplyService::serve(Client& client) {
  make_urgent();
  beast::flat_buffer buffer;
  http::request<http::string_body> request;
  http::read(client.stream.next_layer(), buffer, request);
  if (!beast::websocket::is_upgrade(request)) {
    http::response<http::string_body> response(http::status::ok, request.version());
    response.body() =
        Json{{"project_name", "haply-inverse-service"}, {"project_version", options_.version}}
            .dump();
    response.prepare_payload();
    http::write(client.stream.next_layer(), response);
    return;
  }
  client.stream.accept(request);
  client.stream.text(true);
  client.stream.write(asio::buffer(inventory()));
  for (bool first = true;; first = false) {
    buffer.consume(buffer.size());
    client.stream.read(buffer);
    const std::string message = beast::buffers_to_string(buffer.data());
    {
      std::unique_lock lock(mutex_);
      take(client, message);
      if (first) {
        first_ = message;
        client.open = true;
      }
      client.waiting = true;
      client.stepped = first;  // the first message is answered without a tick
      changed_.notify_all();
      changed_.wait(lock, [&] { return client.stepped || dead_; });
      client.waiting = false;
    }
    if (!answer(client)) {
      return;
    }
  }
}

void HaplyService::take(Client& client, const std::string& message) {
  ++messages_;
  const Json json = Json::parse(message);
  const std::string key = options_.version >= "3.5" ? "vector" : "values";
  for (const Json& device : json.at("inverse3")) {
    if (device.at("device_id") == options_.devices.front()) {
      const Json& force = device.at("commands").at("set_cursor_force").at(key);
      commanded_ = {force.at("x"), force.at("y"), force.at("z")};
      fresh_ = true;
    }
  }
  static_cast<void>(client);
}

bool HaplyService::answer(Client& client) {
  std::string text;
  Failure failure = Failure::kNone;
  bool silent = false;
  {
    const std::lock_guard lock(mutex_);
    failure = handle_.fails(handle_.failure) ? handle_.failure : Failure::kNone;
    text = state(failure);
    silent = failure == Failure::kStall || dead_ ||
             (failure == Failure::kMissing && ++answers_ % 10 == 0);
    if (failure == Failure::kLostLink) {
      return false;
    }
  }
  if (silent) {
    return true;
  }
  if (failure == Failure::kLate) {
    std::this_thread::sleep_for(std::chrono::milliseconds(8));
  }
  client.stream.write(asio::buffer(text));
  if (failure == Failure::kDoubled) {
    client.stream.write(asio::buffer(text));
  }
  return true;
}

void HaplyService::tick_on() {
  make_urgent();
  auto next = std::chrono::steady_clock::now();
  for (;;) {
    next += std::chrono::nanoseconds(static_cast<long>(1e9 / options_.rate));
    std::this_thread::sleep_until(next);
    const std::lock_guard lock(mutex_);
    if (dead_) {
      return;
    }
    tick();
  }
}

/// A command holds for one tick; silence is idle.
void HaplyService::tick() {
  const double rate = options_.rate > 0.0 ? options_.rate : 1000.0;
  handle_.force = fresh_ ? commanded_ : std::array<double, 3>{};
  fresh_ = false;
  if (hand_) {
    hand_(handle_, static_cast<double>(handle_.ticks) / rate);
  }
  handle_.step(1.0 / rate);
  for (const auto& client : clients_) {
    client->stepped = client->stepped || client->waiting;
  }
  changed_.notify_all();
}

void HaplyService::step() {
  std::unique_lock lock(mutex_);
  const auto waits = [this] {
    bool any_open = false;
    for (const auto& client : clients_) {
      any_open = any_open || client->open;
      if (client->open && client->waiting && !client->stepped) {
        return true;
      }
    }
    return !any_open || dead_;
  };
  changed_.wait(lock, waits);
  tick();
  if (!handle_.fails(Failure::kStall)) {
    changed_.wait(lock, waits);
  }
}

std::string HaplyService::inventory() {
  const std::lock_guard lock(mutex_);
  Json message = Json::parse(state(Failure::kNone));
  message["session_id"] = 7;
  for (Json& device : message["inverse3"]) {
    device["config"] = {{"type", options_.type},
                        {"handedness", "right"},
                        {"basis", {{"permutation", options_.basis}}},
                        {"gravity_compensation", {{"enabled", true}}}};
  }
  return message.dump();
}

/// The handle as the first device has it, with the failure in its text.
std::string HaplyService::device_state(Failure failure) {
  std::array<double, 3> position{};
  for (std::size_t i = 0; i < 3; ++i) {
    position[i] = kMiddle[i] + handle_.position[i];
  }
  position[2] += failure == Failure::kJump ? 0.02 : 0.0;
  Json state{{"cursor_position", vector(position)},
             {"current_cursor_force", vector(handle_.force)},
             {"control_mode", "idle"}};
  if (failure != Failure::kMissingField) {
    state["cursor_velocity"] = vector(handle_.velocity);
  }
  Json device{{"device_id", failure == Failure::kOtherDevice ? "FFFF" : options_.devices.front()},
              {"state", state},
              {"status", {{"calibrated", true}, {"power_supply", failure != Failure::kNoPower}}}};
  std::string text = device.dump();
  if (failure == Failure::kNotFinite) {
    const std::size_t at = text.find("\"y\":", text.find("cursor_position")) + 4;
    text.replace(at, text.find(',', at) - at, "NaN");
  }
  return text;
}

std::string HaplyService::state(Failure failure) {
  std::string devices = options_.devices.empty() ? "" : device_state(failure);
  for (std::size_t i = 1; i < options_.devices.size(); ++i) {
    devices += "," + Json{{"device_id", options_.devices[i]},
                          {"state",
                           {{"cursor_position", vector({0.0, 0.0, 0.0})},
                            {"cursor_velocity", vector({0.0, 0.0, 0.0})}}}}
                         .dump();
  }
  std::string grips;
  const unsigned buttons = handle_.buttons | (failure == Failure::kButton ? 4u : 0u);
  for (const std::string& grip : options_.grips) {
    const Json entry{
        {"device_id", grip},
        {"state",
         {{"orientation", {{"w", grip_[0]}, {"x", grip_[1]}, {"y", grip_[2]}, {"z", grip_[3]}}},
          {"buttons",
           {{"a", (buttons & 1u) != 0}, {"b", (buttons & 2u) != 0}, {"c", (buttons & 4u) != 0}}}}}};
    grips += (grips.empty() ? "" : ",") + entry.dump();
  }
  if (failure == Failure::kNoGrip) {
    grips.clear();
  }
  const std::string text =
      fmt::format(R"({{"inverse3":[{}],"wireless_verse_grip":[{}]}})", devices, grips);
  return failure == Failure::kMalformed ? text.substr(0, text.size() / 2) : text;
}

}  // namespace haptrial::test
