#include "experiments/studio/studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "experiments/server/server.h"
#include "experiments/studio/commands.h"
#include "experiments/studio/line_commands.h"
#include "experiments/studio/study_folder.h"
#include "experiments/studio/views_internal.h"

namespace haptrial::experiments {
namespace {

using nlohmann::json;
using Kind = WebRoute::Kind;

constexpr std::size_t kMaxBody = 4'000'000;  // a definition, with its escapes [bytes]

WebAnswer json_answer(const json& body) {
  return {200, "application/json", body.dump(-1, ' ', false, json::error_handler_t::replace)};
}

/// The value that a request has for a name. @throws InputError for a name that is missing
std::string asked(const WebRequest& request, const std::string& name) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) {
    throw InputError(fmt::format("the address lacks {}=", name));
  }
  return found->second;
}

json body_of(const WebRequest& request) {
  json body = json::parse(request.body, nullptr, false);
  if (!body.is_object()) {
    throw InputError("the body is not a JSON object");
  }
  return body;
}

std::string string_in(const json& body, const char* key) {
  const auto found = body.find(key);
  if (found == body.end() || !found->is_string()) {
    throw InputError(fmt::format("the body lacks the text \"{}\"", key));
  }
  return found->get<std::string>();
}

int number_in(const json& body, const char* key, int low, int high) {
  const auto found = body.find(key);
  const bool whole = found != body.end() && found->is_number_integer();
  const auto number = whole ? found->get<std::int64_t>() : std::int64_t{low} - 1;
  if (number < low || number > high) {
    throw InputError(
        fmt::format("the body's \"{}\" is not a whole number from {} to {}", key, low, high));
  }
  return static_cast<int>(number);
}

/// A text that may be missing.
std::string text_in(const json& body, const char* key) {
  return body.contains(key) ? string_in(body, key) : "";
}

SessionChoice choice_in(const json& body) {
  constexpr int kMostSessions = 1000;
  constexpr std::size_t kMostDevices = 4;
  SessionChoice choice;
  choice.file = string_in(body, "file");
  choice.subject = text_in(body, "subject");
  choice.session = body.contains("session") ? number_in(body, "session", 0, kMostSessions) : 0;
  const json devices = body.value("devices", json::array());
  const auto is_name = [](const json& device) { return device.is_string(); };
  if (!devices.is_array() || devices.size() > kMostDevices ||
      !std::ranges::all_of(devices, is_name)) {
    throw InputError(fmt::format("the body's \"devices\" are not up to {} names", kMostDevices));
  }
  choice.devices = devices.get<std::vector<std::string>>();
  choice.language = text_in(body, "language");
  choice.handedness = text_in(body, "handedness");
  choice.consent = text_in(body, "consent");
  choice.watch = text_in(body, "watch");
  choice.window = body.value("window", json()) == true;
  choice.resume = body.value("resume", json()) == true;
  choice.pilot = body.value("pilot", json()) == true;
  return choice;
}

}  // namespace

class Studio::Implementation {
 public:
  explicit Implementation(const StudioOptions& options)
      : folder_(options.folder),
        commands_(options.program, folder_.path()),
        tried_(options.program, folder_.path()),
        page_maker_(options.program, folder_.path()),
        views_(folder_, commands_, tried_, page_maker_, options.libraries),
        sessions_(folder_, commands_),
        server_(server_options(options), routes()) {}
  ~Implementation() { commands_.stop(); }

  const GuardedServer& server() const { return server_; }

 private:
  static ServerOptions server_options(const StudioOptions& options) {
    constexpr int kRequests = 8;  // at a time; most of them wait for a command
    ServerOptions server;
    server.port = options.port;
    server.request_time = options.request_time;
    server.own_workers = kRequests;
    server.waiting = 256;  // a hundred pages that are opened at once are all answered
    server.max_body = kMaxBody;
    server.on_refusal = options.on_refusal;
    return server;
  }

  static WebRoute get(const std::string& path, std::function<json(const WebRequest&)> view) {
    return {path, Kind::kRead, [view = std::move(view)](const WebRequest& request) {
              return json_answer(view(request));
            }};
  }
  static WebRoute post(const std::string& path, std::function<json(const json&)> act) {
    return {path, Kind::kPost, [act = std::move(act)](const WebRequest& request) {
              return json_answer(act(body_of(request)));
            }};
  }

  std::vector<WebRoute> routes() {
    std::vector<WebRoute> all = looks();
    for (auto more : {acts(), tries(), session_routes()}) {
      std::ranges::move(more, std::back_inserter(all));
    }
    return all;
  }

  std::vector<WebRoute> looks() {
    const auto page = [](const WebRequest&) {
      return page_answer(studio_page_template(), "frame-src 'self'");
    };
    const auto file = [this](const WebRequest& r) {
      return views_.file(asked(r, "file"), r.query.contains("download"));
    };
    const auto preview = [this](const WebRequest& r) {
      return views_.preview_page(asked(r, "page"));
    };
    const auto library = [this](const WebRequest& r) { return views_.library(asked(r, "name")); };
    return {
        {"/", Kind::kPage, page},
        {"/library", Kind::kRead, library},
        {"/file", Kind::kRead, file},
        {"/preview_page", Kind::kRead, preview},
        get("/studies", [this](const WebRequest&) { return views_.studies(); }),
        get("/study", [this](const WebRequest& r) { return views_.study(asked(r, "file")); }),
        get("/examples", [this](const WebRequest&) { return views_.examples(); }),
        get("/machine", [this](const WebRequest&) { return views_.machine(); }),
        get("/schema", [this](const WebRequest& r) { return views_.schema(asked(r, "protocol")); }),
        get("/text", [this](const WebRequest& r) { return views_.text(asked(r, "file")); }),
        get("/sessions", [this](const WebRequest& r) { return views_.sessions(asked(r, "file")); }),
        get("/info", [this](const WebRequest& r) { return views_.info(asked(r, "file")); }),
        get("/jobs", [this](const WebRequest&) { return views_.jobs(); }),
        get("/job", [this](const WebRequest& r) { return views_.job(asked(r, "job")); })};
  }

  std::vector<WebRoute> acts() {
    constexpr int kMostSubjects = 10'000;
    return {
        post("/validate",
             [this](const json& body) {
               return views_.validate(string_in(body, "file"), string_in(body, "text"));
             }),
        post("/preview",
             [this](const json& body) {
               constexpr int kMostTrials = 1'000'000;
               return views_.preview(string_in(body, "file"), string_in(body, "text"),
                                     number_in(body, "trial", 1, kMostTrials),
                                     body.value("virtual", json()) == true,
                                     body.value("language", json()) == "de" ? "de" : "en");
             }),
        post("/keys",
             [this](const json& body) {
               return views_.keys(string_in(body, "file"), string_in(body, "text"));
             }),
        post("/set",
             [this](const json& body) {
               return views_.set_key(string_in(body, "file"), string_in(body, "text"),
                                     string_in(body, "key"), string_in(body, "edit"),
                                     text_in(body, "value"));
             }),
        post("/save",
             [this](const json& body) {
               return views_.save(string_in(body, "file"), string_in(body, "text"),
                                  string_in(body, "stamp"));
             }),
        post("/new",
             [this](const json& body) {
               return views_.begin(string_in(body, "name"), string_in(body, "from"));
             }),
        post("/rehearse",
             [this](const json& body) {
               constexpr int kMostMinutes = 600;
               return views_.rehearse(
                   string_in(body, "file"), number_in(body, "subjects", 1, kMostSubjects),
                   body.contains("setup") ? std::optional(number_in(body, "setup", 0, kMostMinutes))
                                          : std::nullopt);
             }),
        post("/plan", [this](const json& body) { return views_.plan(string_in(body, "file")); }),
        post("/power", [this](const json& body) { return views_.power(string_in(body, "file")); }),
        post("/analyze",
             [this](const json& body) {
               return views_.analyze(string_in(body, "file"), string_in(body, "folder"));
             }),
        post("/cancel", [this](const json& body) {
          commands_.cancel(number_in(body, "job", 1, 1'000'000));
          return views_.jobs();
        })};
  }

  /// A trial under the pointer of the page.
  std::vector<WebRoute> tries() {
    constexpr int kMost = 1'000'000;
    return {post("/try",
                 [this](const json& body) {
                   return views_.try_trial(string_in(body, "file"), string_in(body, "text"),
                                           number_in(body, "trial", 1, kMost));
                 }),
            post("/try_move",
                 [this](const json& body) {
                   return views_.try_move(number_in(body, "try", 1, kMost),
                                          body.value("lines", json()));
                 }),
            post("/try_end", [this](const json& body) {
              return views_.try_end(number_in(body, "try", 1, kMost));
            })};
  }

  std::vector<WebRoute> session_routes() {
    constexpr int kMostSeconds = 600;
    return {get("/session", [this](const WebRequest&) { return sessions_.session(); }),
            get("/devices", [this](const WebRequest&) { return sessions_.devices(); }),
            post("/checklist", [this](const json& b) { return sessions_.checklist(choice_in(b)); }),
            post("/begin", [this](const json& b) { return sessions_.begin(choice_in(b)); }),
            post("/card", [this](const json& b) { return sessions_.card(choice_in(b)); }),
            post("/device_test",
                 [this](const json& b) {
                   return sessions_.test_device(string_in(b, "device"),
                                                number_in(b, "seconds", 1, kMostSeconds));
                 }),
            post("/withdraw",
                 [this](const json& b) {
                   return sessions_.withdraw(string_in(b, "file"), string_in(b, "subject"),
                                             b.value("sure", json()) == true);
                 }),
            post("/read_device",
                 [this](const json& b) {
                   return sessions_.read_device(string_in(b, "device"),
                                                number_in(b, "seconds", 1, kMostSeconds));
                 }),
            post("/read_channels",
                 [this](const json& b) {
                   return sessions_.read_channels(string_in(b, "file"),
                                                  number_in(b, "seconds", 1, kMostSeconds));
                 }),
            post("/hand_over", [this](const json& b) {
              return sessions_.hand_over(string_in(b, "file"), string_in(b, "folder"),
                                         string_in(b, "format"));
            })};
  }

  StudyFolder folder_;
  Commands commands_;
  LineCommands tried_, page_maker_;
  StudioViews views_;
  SessionViews sessions_;
  GuardedServer server_;
};

Studio::Studio(const StudioOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}

Studio::~Studio() = default;

std::string Studio::url() const { return implementation_->server().url(); }
int Studio::port() const { return implementation_->server().port(); }
const std::string& Studio::token() const { return implementation_->server().token(); }
std::uint64_t Studio::refused() const { return implementation_->server().refused(); }
std::vector<std::string> Studio::refusals() const { return implementation_->server().refusals(); }

}  // namespace haptrial::experiments
