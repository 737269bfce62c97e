#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "core/base/child_process.h"
#include "core/base/whole_file.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "experiments/studio/studio.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

struct StudioCommandOptions {
  std::string folder{"."};
  std::optional<int> port;
  bool no_browser{false};
};

/// Opens the page in the browser of this desktop. The address reaches it in a file that nobody else
/// may read, since the words of a command can be read by every user of the machine.
class OpenedBrowser {
 public:
  explicit OpenedBrowser(const std::string& url) {
    std::string folder = (fs::temp_directory_path() / "haptrial-studio-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) {
      return;
    }
    folder_ = folder;
    const fs::path page = folder_ / "studio.html";
    write_whole(page, fmt::format("<!doctype html>\n<meta charset=\"utf-8\">\n"
                                  "<meta http-equiv=\"refresh\" content=\"0; url={}\">\n"
                                  "<title>haptrial studio</title>\n",
                                  url));
    try {  // in a session of its own, so that the browser outlives this program
      opener_ = std::make_unique<ChildProcess>(
          Program{.words = {"setsid", "--fork", "xdg-open", page.string()}, .folder = folder_});
    } catch (const std::system_error&) {
    }  // the address was printed
  }
  ~OpenedBrowser() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  OpenedBrowser(const OpenedBrowser&) = delete;
  OpenedBrowser& operator=(const OpenedBrowser&) = delete;

 private:
  fs::path folder_;
  std::unique_ptr<ChildProcess> opener_;
};

bool has_desktop() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

int studio(const StudioCommandOptions& options) {
  watch_for_interrupt();
  StudioOptions studio_options;
  studio_options.folder = options.folder;
  studio_options.port = checked_number("--port", options.port.value_or(0), 0, 65535);
  studio_options.on_refusal = [](const std::string& sentence) {
    fmt::print(stderr, "refused: {}\n", sentence);
  };
  const Studio studio(studio_options);
  fmt::print("studio: {}\nCtrl-C ends it, and what it still runs.\n", studio.url());
  std::fflush(stdout);
  std::unique_ptr<OpenedBrowser> browser;
  if (!options.no_browser && has_desktop()) {
    browser = std::make_unique<OpenedBrowser>(studio.url());
  }
  constexpr std::chrono::milliseconds kSlice(100);
  while (!interrupted()) {
    std::this_thread::sleep_for(kSlice);
  }
  return 0;
}

}  // namespace

void add_studio(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "studio", "Show the studies of a folder on a page of this machine",
                 "haptrial studio my_studies", {"", "guide-studio.md"});
  auto& o = options_of<StudioCommandOptions>(*sub, status, studio);
  sub->add_option("FOLDER", o.folder, "Folder of the definitions (default: here)");
  sub->add_option("--port", o.port, "Port of the page (default: any free port)");
  sub->add_flag("--no-browser", o.no_browser, "Print the address, and start no browser");
}

}  // namespace haptrial::experiments
