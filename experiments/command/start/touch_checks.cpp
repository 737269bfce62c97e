#include "experiments/command/start/touch_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using State = MachineCheck::State;

constexpr const char* kDefaultDevice = "Default Device";
constexpr const char* kDefaultPhantom = "Default PHANToM";

/// A Touch on USB and the file through which the driver talks to it.
struct Connection {
  std::string vendor, product;  // four hexadecimal digits
  fs::path file;                // as the user knows it, "/dev/hidraw3"; empty: there is none
  bool hid{false};              // the newer model
};

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> all;
  for (fs::directory_iterator each(folder, error), end; !error && each != end;
       each.increment(error)) {
    all.push_back(each->path());
  }
  std::ranges::sort(all);
  return all;
}

/// Text of a file; empty if it cannot be read.
std::string text_in(const fs::path& file) {
  try {
    return file_text(file);
  } catch (const InputError&) {
    return "";
  }
}

std::string first_line(const fs::path& file) {
  const std::string text = text_in(file);
  return text.substr(0, text.find('\n'));
}

bool is_touch(const Connection& usb) {
  return usb.vendor == "2988" || (usb.vendor == "0301" && usb.product == "2988");
}

/// The USB device to which a folder of /sys belongs.
Connection usb_device_above(const fs::path& link) {
  std::error_code error;
  fs::path folder = fs::canonical(link, error);
  for (int steps = 0; !error && steps < 8 && folder.has_relative_path(); ++steps) {
    if (fs::exists(folder / "idVendor", error)) {
      return {first_line(folder / "idVendor"), first_line(folder / "idProduct"), {}};
    }
    folder = folder.parent_path();
  }
  return {};
}

std::optional<Connection> find_touch(const fs::path& root) {
  for (const char* kind : {"hidraw", "tty"}) {
    const bool hid = std::string_view(kind) == "hidraw";
    for (const fs::path& entry : entries_of(root / "sys/class" / kind)) {
      const std::string name = entry.filename().string();
      Connection usb = usb_device_above(entry / "device");
      if (is_touch(usb) && (hid || name.starts_with("ttyACM"))) {
        usb.file = "/dev/" + name;
        usb.hid = hid;
        return usb;
      }
    }
  }
  for (const fs::path& entry : entries_of(root / "sys/bus/usb/devices")) {
    const Connection usb = usb_device_above(entry);
    if (is_touch(usb)) {
      return usb;
    }
  }
  return std::nullopt;
}

/// The udev rule that names a vendor; empty if there is none.
std::string rule_for(const fs::path& root, const std::string& vendor) {
  for (const char* folder : {"etc/udev/rules.d", "usr/lib/udev/rules.d", "lib/udev/rules.d"}) {
    for (const fs::path& file : entries_of(root / folder)) {
      if (file.extension() == ".rules" &&
          text_in(file).find("\"" + vendor + "\"") != std::string::npos) {
        return "/" + fs::path(folder).string() + "/" + file.filename().string();
      }
    }
  }
  return "";
}

MachineCheck check_connection(const TouchSearch& search, const Connection& usb) {
  const std::string id = usb.vendor + ":" + usb.product;
  if (usb.file.empty()) {
    return {
        "touch", State::kLimited,
        fmt::format("USB device {} is connected, but has neither /dev/hidraw… nor /dev/ttyACM…; "
                    "unplug it and plug it in again",
                    id)};
  }
  const std::string what = fmt::format("Touch {} (USB {}) is connected as {}",
                                       usb.hid ? "HID" : "USB", id, usb.file.string());
  if (search.may_open(search.root / usb.file.relative_path())) {
    return {"touch", State::kReady, what + ", which you may open"};
  }
  if (!usb.hid) {
    return {"touch", State::kLimited,
            what +
                ", which you may not open; run: sudo adduser $USER dialout, then log out and in "
                "again"};
  }
  const std::string rule = rule_for(search.root, usb.vendor);
  if (!rule.empty()) {
    return {
        "touch", State::kLimited,
        fmt::format("{}, which you may not open although {} names it; run: sudo udevadm control "
                    "--reload, plug it in again, and join the group that the rule names",
                    what, rule)};
  }
  return {"touch", State::kLimited,
          fmt::format("{}, which you may not open, and no udev rule names it; write the line "
                      "KERNEL==\"hidraw*\", ATTRS{{idVendor}}==\"{}\", MODE=\"0660\", "
                      "GROUP=\"plugdev\", TAG+=\"uaccess\" into /etc/udev/rules.d/70-touch.rules, "
                      "run: sudo udevadm control --reload, and plug it in again",
                      what, usb.vendor)};
}

/// A library of the vendor with the links to it resolved, below root; empty if it is not there.
fs::path find_library(const fs::path& root, const std::string& name) {
  for (const char* folder : {"usr/lib", "usr/lib/x86_64-linux-gnu", "usr/lib64", "usr/local/lib"}) {
    for (const fs::path& file : entries_of(root / folder)) {
      std::error_code error;
      const fs::path whole = fs::canonical(file, error);
      if (!error && file.filename().string().starts_with(name)) {
        return whole;
      }
    }
  }
  return {};
}

MachineCheck check_library(const fs::path& library) {
  const std::string name = library.filename().string();
  constexpr std::string_view kStem = "libHD.so.";
  if (library.empty()) {
    return {"touch library", State::kLimited,
            "libHD.so is not there; install OpenHaptics for Linux (3.4) from "
            "https://support.3dsystems.com"};
  }
  return {"touch library", State::kReady,
          name.size() > kStem.size() ? "OpenHaptics " + name.substr(kStem.size()) + " is installed"
                                     : name + " is installed; its file name gives no version"};
}

/// Year and month of a file, "2023-11".
std::string month_of(const fs::path& file) {
  std::error_code error;
  const auto written = std::chrono::file_clock::to_sys(fs::last_write_time(file, error));
  const std::chrono::year_month_day day{std::chrono::floor<std::chrono::days>(written)};
  return fmt::format("{}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()));
}

MachineCheck check_driver(const fs::path& driver, const Connection& usb) {
  constexpr const char* kGet =
      "install the Touch Device Driver (TouchDriver_2023_11_15 or later) from "
      "https://support.3dsystems.com";
  if (driver.empty()) {
    return {"touch driver", State::kLimited,
            std::string("libPhantomIOLib42.so is not there, without which OpenHaptics finds no "
                        "device; ") +
                kGet};
  }
  const std::string month = month_of(driver);
  const bool old = usb.hid && month < "2023";  // a copied file may be younger than its contents
  return {"touch driver", old ? State::kLimited : State::kReady,
          "libPhantomIOLib42.so is a file of " + month +
              (old ? std::string(", and a Touch HID needs a driver of 2023 or later; ") + kGet
                   : std::string())};
}

MachineCheck check_settings(const TouchSearch& search) {
  const char* const what = "touch settings";
  if (search.gtdd_home.empty()) {
    return {what, State::kLimited,
            "GTDD_HOME is not set; add the line GTDD_HOME=/usr/share/3DSystems to "
            "/etc/environment and log in again"};
  }
  const std::string config = search.gtdd_home + "/config";
  if (!fs::is_directory(search.root / fs::path(config).relative_path())) {
    return {
        what, State::kLimited,
        fmt::format("GTDD_HOME is {0}, but {1} is not there; run: sudo mkdir -p {1}; sudo chmod "
                    "a+rwx {1}; Touch_Setup",
                    search.gtdd_home, config)};
  }
  return {what, State::kReady, fmt::format("GTDD_HOME is {}", search.gtdd_home)};
}

/// Names that the set-up program gave: NAME.config each.
std::vector<std::string> names_in(const TouchSearch& search) {
  std::vector<std::string> names;
  if (!search.gtdd_home.empty()) {
    const fs::path folder = search.root / fs::path(search.gtdd_home).relative_path() / "config";
    for (const fs::path& file : entries_of(folder)) {
      if (file.extension() == ".config") {
        names.push_back(file.stem().string());
      }
    }
  }
  return names;
}

MachineCheck check_name(const TouchSearch& search) {
  const char* const what = "touch name";
  const std::vector<std::string> names = names_in(search);
  const auto known = [&](const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  const std::string list = fmt::format("\"{}\"", fmt::join(names, "\", \""));
  if (names.empty()) {
    return {
        what, State::kLimited,
        "no device is set up; run Touch_Setup and write the name that you give there as name in "
        "[open_haptics]"};
  }
  const std::string given = search.definition.value_or("");
  if (!given.empty()) {
    return known(given)
               ? MachineCheck{what, State::kReady,
                              fmt::format("[open_haptics] names \"{}\", which is set up", given)}
               : MachineCheck{
                     what, State::kLimited,
                     fmt::format("[open_haptics] names \"{}\", but set up is {}; write that "
                                 "as name, or run Touch_Setup",
                                 given, list)};
  }
  const bool has_default = known(kDefaultDevice) || known(kDefaultPhantom);
  if (search.definition || !has_default) {
    return {
        what, State::kLimited,
        fmt::format("{}; write name = \"{}\" in [open_haptics]; set up is {}",
                    has_default ? "the definition gives no name, and on some systems OpenHaptics "
                                  "opens no device without one"
                                : "no device has the default name, so that none opens without "
                                  "its name",
                    names.front(), list)};
  }
  return {what, State::kReady,
          fmt::format("set up is {}; give it as name in [open_haptics], because on some systems "
                      "OpenHaptics opens no device without one",
                      list)};
}

}  // namespace

TouchSearch this_machine(std::optional<std::string> definition) {
  const auto variable = [](const char* name) {
    const char* const text = std::getenv(name);
    return std::string(text != nullptr ? text : "");
  };
  return {"/", variable("HOME"), variable("GTDD_HOME"), std::move(definition),
          [](const fs::path& file) { return access(file.c_str(), R_OK | W_OK) == 0; }};
}

std::vector<MachineCheck> check_touch(const TouchSearch& search) {
  const fs::path library = find_library(search.root, "libHD.so");
  const std::optional<Connection> usb = find_touch(search.root);
  if (!usb) {
    return library.empty() ? std::vector<MachineCheck>{}
                           : std::vector<MachineCheck>{
                                 {"touch", State::kAbsent,
                                  "no Touch is on USB (2988:0302 or 0301:2988); check cable and "
                                  "power"}};
  }
  std::vector<MachineCheck> checks{
      check_connection(search, *usb), check_library(library),
      check_driver(find_library(search.root, "libPhantomIOLib42.so"), *usb), check_settings(search),
      check_name(search)};
  const fs::path left = search.home / ".3dsystems/config";
  if (fs::is_directory(left) && search.home / ".3dsystems" != search.gtdd_home) {
    checks.push_back(
        {"touch folder", State::kLimited,
         "~/.3dsystems/config is left from when a Touch was first plugged in, and later "
         "starts fail because of it; unplug the Touch, run: mv ~/.3dsystems/config "
         "~/.3dsystems/config.old, plug it in and run Touch_Setup"});
  }
  return checks;
}

}  // namespace haptrial::experiments
