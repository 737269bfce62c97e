#include "experiments/console/console.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "experiments/console/console_messages.h"

namespace haptrial::experiments {
namespace {

using Kind = WebRoute::Kind;

void check_names(const protocols::AuxiliaryPages& sides) {
  std::vector<std::string> taken{"events", "picture", "mirror", "ask", "note", "answer"};
  for (const auto& side : sides) {
    const std::string name(side->name());
    const bool letters = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || c == '_';
    });
    if (!letters || std::find(taken.begin(), taken.end(), name) != taken.end()) {
      throw std::invalid_argument(fmt::format(
          "a page beside the console cannot be named '{}': names are of letters a to z and '_', "
          "none twice and none of the console's own",
          name));
    }
    taken.push_back(name);
  }
}

ServerOptions watch_options(const ConsoleOptions& options) {
  ServerOptions server = options;
  server.address = options.watch_address;
  server.port = 0;
  server.allow_remote = true;
  return server;
}

/// The console's page. @param watches  shows nothing that can be pressed
std::function<std::string_view()> console_page(bool watches, bool terminal) {
  std::string page(console_page_template());
  constexpr std::string_view kStart = "<html lang=\"en\"";
  page.insert(page.find(kStart) + kStart.size(),
              fmt::format("{}{}", terminal ? " data-terminal" : "", watches ? " data-watch" : ""));
  return [page = std::move(page)]() -> std::string_view { return page; };
}

/// Answers a request whose body asks for something.
WebRoute post(const std::string& path, std::function<void(const std::string&)> act) {
  return {path, Kind::kPost, [act = std::move(act)](const WebRequest& request) {
            act(request.body);
            return WebAnswer{200, "application/json", "{\"accepted\":true}\n"};
          }};
}

WebRoute page(const std::string& path, std::function<std::string_view()> html) {
  return {path, Kind::kPage,
          [html = std::move(html)](const WebRequest&) { return page_answer(html()); }};
}

/// The picture of the page that is asked at the moment.
WebAnswer picture_answer(SessionControl& control) {
  const auto picture = control.status().asked.picture;
  return picture ? WebAnswer{200, "image/png", *picture} : refusal(404, "no picture is shown now");
}

/// Gives a picture of the participant's window. @throws RunError
WebAnswer mirror_answer(SessionControl& control) {
  const std::string picture = control.mirror();
  return picture.empty() ? refusal(404, "the participant has no window")
                         : WebAnswer{200, "image/png", picture};
}

void add_routes_of(const std::shared_ptr<protocols::AuxiliaryPage>& side,
                   std::vector<WebRoute>& routes) {
  const std::string at = fmt::format("/{}", side->name());
  routes.push_back(page(at, [side] { return side->html(); }));
  routes.push_back({at + "/events", Kind::kRead, {}, [side] { return side->events(); }});
  routes.push_back(post(at + "/ask", [side](const std::string& body) { side->ask(body); }));
}

}  // namespace

class Console::Implementation {
 public:
  Implementation(SessionControl& control, const ConsoleOptions& options)
      : control_(control), server_(options, routes(options)) {
    if (!options.watch_address.empty()) {
      watch_.emplace(watch_options(options), watch_routes(options.terminal));
    }
  }

  const GuardedServer& server() const { return server_; }
  const std::optional<GuardedServer>& watch() const { return watch_; }

 private:
  WebRoute events() {
    return {"/events", Kind::kRead, {}, [this] { return [this] { return status(); }; }};
  }
  WebRoute picture() {
    return {"/picture", Kind::kRead,
            [this](const WebRequest&) { return picture_answer(control_); }};
  }
  std::vector<WebRoute> watch_routes(bool terminal) {
    return {page("/", console_page(true, terminal)), events(), picture()};
  }
  std::vector<WebRoute> routes(const ConsoleOptions& options) {
    check_names(options.sides);
    std::vector<WebRoute> all{
        page("/", console_page(false, options.terminal)),
        events(),
        picture(),
        {"/mirror", Kind::kRead, [this](const WebRequest&) { return mirror_answer(control_); }},
        post("/ask", [this](const std::string& body) { control_.ask(parse_request(body)); }),
        post("/note", [this](const std::string& body) { keep_note(body); }),
        post("/answer", [this](const std::string& body) { give_answer(body); })};
    for (const auto& side : options.sides) {
      add_routes_of(side, all);
    }
    return all;
  }
  std::string status() { return status_json(control_.status(), server_.refused()); }
  void keep_note(const std::string& body) {
    const ConsoleNote note = parse_note(body);
    control_.note(note.text, note.bad_trial);
  }
  void give_answer(const std::string& body) {
    auto [number, text] = parse_answer(body);
    control_.answer(number, std::move(text));
  }

  SessionControl& control_;
  GuardedServer server_;
  std::optional<GuardedServer> watch_;
};

Console::Console(SessionControl& control, ConsoleOptions options)
    : implementation_(std::make_unique<Implementation>(control, options)) {}

Console::~Console() = default;

std::string Console::url() const { return implementation_->server().url(); }
std::string Console::side_url(std::string_view name) const {
  return implementation_->server().url(fmt::format("/{}", name));
}
std::string Console::watch_url() const {
  const auto& watch = implementation_->watch();
  return watch ? watch->url() : "";
}
int Console::port() const { return implementation_->server().port(); }
const std::string& Console::token() const { return implementation_->server().token(); }
std::uint64_t Console::refused() const { return implementation_->server().refused(); }
std::vector<std::string> Console::refusals() const { return implementation_->server().refusals(); }

}  // namespace haptrial::experiments
