#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/control/session_control.h"
#include "experiments/server/server.h"
#include "protocols/interface/auxiliary_page.h"

namespace haptrial::experiments {

struct ConsoleOptions : ServerOptions {
  protocols::AuxiliaryPages sides{};  // pages beside the console's
  std::string watch_address{};        // of a copy of the page that only looks; may be reached from
                                      // other machines. Empty: there is none
  bool terminal{false};  // Escape in the session's terminal stops, too, which the page then says
};

/// The experimenter's console: one page, served on threads of its own, that shows
/// SessionControl::status() and turns clicks into SessionControl::ask() and note(). It knows
/// nothing else of the session, so nothing that a browser does reaches the servo thread but as
/// a message. Who shows the token is served by threads that nobody else can occupy, so that no
/// flood keeps an emergency stop waiting. The HTTP library makes the process ignore SIGPIPE.
///
///     GET /?token=T        the page
///     GET /events?token=T  server-sent events, each a status as JSON
///     POST /ask            {"request": "pause"}, with the header X-Haptrial-Token
///     POST /note           {"text": "..."}, likewise
///
/// For each page beside it (protocols/interface/auxiliary_page.h), by its name:
///
///     GET /NAME?token=T         the page
///     GET /NAME/events?token=T  server-sent events, as the page has them
///     POST /NAME/ask            what the page takes, with the header
///
/// The copy for those who only look is a server of its own with a token of its own, which has no
/// address that takes anything:
///
///     GET /?token=W, /events?token=W, /picture?token=W
class Console {
 public:
  /// Serves when it returns. @param control  outlives the console.
  /// @throws InputError for an address or option that is not allowed; std::invalid_argument for
  /// pages that cannot have addresses of their own; RunError where the port is taken.
  explicit Console(SessionControl& control, ConsoleOptions options = {});
  /// Hangs up on every client and returns within a fraction of a second.
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Address that the experimenter opens; it holds the token.
  std::string url() const;
  /// Address of a page beside it; likewise. @param name  of the page
  std::string side_url(std::string_view name) const;
  /// Address of the copy that only looks, with its token; empty if there is none.
  std::string watch_url() const;
  int port() const;
  const std::string& token() const;

  /// Requests that were refused, and the first ones in a sentence each. Any thread.
  std::uint64_t refused() const;
  std::vector<std::string> refusals() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace haptrial::experiments
