#include "protocols/definition/lab_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "core/base/nearest.h"
#include "core/device/certificate.h"
#include "core/device/vendor_devices.h"

namespace haptrial::protocols {
namespace {

using Json = nlohmann::json;

/// The described findings of one part of a handle, of a certificate's file.
struct PartFindings {
  const Json& findings;
  std::string name;  // of the file and the list, for sentences

  /// A number of a finding; nothing if the figure is not defined.
  /// @param unit  in which it is stated, if the file says in which
  /// @throws InputError for another unit, or for something that is no number
  std::optional<double> number(const char* figure, const char* part, const char* unit) const {
    const auto finding = findings.find(figure);
    if (finding == findings.end() || !finding->is_object()) {
      return std::nullopt;
    }
    const auto at = finding->find(part);
    if (at == finding->end() || at->is_null()) {
      return std::nullopt;
    }
    if (!at->is_number()) {
      throw InputError(fmt::format("{}.{}.{} is {}; allowed: a number", name, figure, part,
                                   at->dump(-1, ' ', false, Json::error_handler_t::replace)));
    }
    if (const auto own = finding->find("unit"); own != finding->end() && *own != unit) {
      throw InputError(fmt::format("{}.{}.unit is {}; allowed: {}", name, figure,
                                   own->dump(-1, ' ', false, Json::error_handler_t::replace),
                                   Json(unit).dump()));
    }
    return at->get<double>();
  }

  /// A figure that is never below zero; noise takes the estimate of a small one there.
  std::optional<double> size(const char* figure, const char* unit) const {
    const auto estimate = number(figure, "estimate", unit);
    return estimate ? std::optional(std::max(*estimate, 0.0)) : std::nullopt;
  }
};

/// @param force, stiffness  units of the part
void read_figures(const PartFindings& part, const char* force, const char* stiffness,
                  device::CertifiedForce& c) {
  c.gain = part.number("gain", "estimate", "");
  c.gain_low = part.number("gain", "low_95", "");
  c.gain_high = part.number("gain", "high_95", "");
  if (!c.gain || !c.gain_low || !c.gain_high) {
    c.gain = c.gain_low = c.gain_high = std::nullopt;
  }
  c.dead_zone = part.size("dead_zone", force);
  c.friction = part.size("friction", force);
  c.force_noise = part.size("force_noise", force);
  c.delay = part.size("delay", "s");
  c.stiffest_wall = part.number("stiffest_wall", "low_95", stiffness);
}

/// The key figures of a further part; nothing if the certificate does not state one.
std::optional<device::CertifiedForce> figures_of(const Json& root, const std::string& file,
                                                 const std::string& summary, const char* force,
                                                 const char* stiffness) {
  const auto list = root.find(summary);
  if (list == root.end() || !list->is_object() || !list->contains("findings") ||
      !list->at("findings").is_object()) {
    return std::nullopt;
  }
  device::CertifiedForce c;
  read_figures({list->at("findings"), file + ": " + summary}, force, stiffness, c);
  const bool any =
      c.gain || c.dead_zone || c.friction || c.force_noise || c.delay || c.stiffest_wall;
  return any ? std::optional(c) : std::nullopt;
}

std::string figures_text(const device::CertifiedForce& c) {
  std::string text;
  const auto add = [&text](const char* key, const std::optional<double>& value) {
    if (value) {
      text += fmt::format("{} = {:.9g}\n", key, *value);
    }
  };
  add("gain", c.gain);
  add("gain_low", c.gain_low);
  add("gain_high", c.gain_high);
  add("dead_zone", c.dead_zone);
  add("friction", c.friction);
  add("force_noise", c.force_noise);
  add("delay", c.delay);
  add("stiffest_wall", c.stiffest_wall);
  return text;
}

std::string quoted(const std::string& text) {
  std::string made = "\"";
  for (const char c : text) {
    made += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c < ' ' ? ' ' : c);
  }
  return made + "\"";
}

/// Key figures of a certificate that `haptrial device-test --certificate` wrote.
/// @throws InputError if the file cannot be read, is no certificate or is one of another format
device::Certificate read_certificate(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw InputError(fmt::format(
        "{} is not a file; give certificate.json of `haptrial device-test NAME --certificate "
        "FOLDER`",
        file.string()));
  }
  const std::string text = file_text(file);
  const Json root = Json::parse(text, nullptr, false);
  const bool known =
      root.is_object() && root.contains("certificate") && root["certificate"].is_number_integer() &&
      root.contains("device") && root["device"].is_string() && root.contains("simulated") &&
      root["simulated"].is_boolean() && root.contains("summary") && root["summary"].is_object() &&
      root["summary"].contains("findings") && root["summary"]["findings"].is_object();
  if (!known) {
    throw InputError(fmt::format(
        "{} is no certificate; give certificate.json of `haptrial device-test NAME --certificate "
        "FOLDER`",
        file.string()));
  }
  if (root["certificate"] != device::kCertificateFormat) {
    throw InputError(fmt::format(
        "{} is a certificate of format {}; allowed: format {}; make it again with this version",
        file.string(), root["certificate"].dump(), device::kCertificateFormat));
  }
  device::Certificate c;
  c.file = file.filename().string();
  c.checksum = fmt::format("{:016x}", fnv1a(text));
  c.device = root["device"].get<std::string>();
  c.simulated = root["simulated"].get<bool>();
  const std::string name = file.string();
  read_figures({root["summary"]["findings"], name + ": summary"}, "N", "N/m", c);
  c.rotation = figures_of(root, name, "rotation_summary", "N·m", "N·m/rad");
  c.grip = figures_of(root, name, "grip_summary", "N", "N/m");
  return c;
}

/// The table [certificate] with these figures, and those of rotation and grip, as text of a
/// definition that ends in a newline.
std::string certificate_table(const device::Certificate& c) {
  std::string text =
      fmt::format("[certificate]\nfile = {}\nchecksum = \"{}\"\ndevice = {}\nsimulated = {}\n",
                  quoted(c.file), c.checksum, quoted(c.device), c.simulated);
  text += figures_text(c);
  if (c.rotation) {
    text += "\n[certificate.rotation]\n" + figures_text(*c.rotation);
  }
  if (c.grip) {
    text += "\n[certificate.grip]\n" + figures_text(*c.grip);
  }
  return text;
}

namespace fs = std::filesystem;

/// Behind the definition's last table such a key would belong to that table.
void refuse_key_outside_tables(const std::string& text, const std::string& file) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  std::size_t at = first;
  while (at != std::string::npos && text[at] == '#') {
    at = text.find('\n', at);
    at = at == std::string::npos ? at : text.find_first_not_of(" \t\r\n", at);
  }
  if (at != std::string::npos && text[at] != '[') {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
    throw InputError(
        fmt::format("{}:{}: a key stands before the first table; write a header such as [device] "
                    "above it",
                    file, line));
  }
}

/// Checks for tables that are not a machine's, or are in the definition as well.
void check_tables(Table& lab, const Table& definition, const std::string& definition_file) {
  const std::vector<std::string>& allowed = machine_tables();
  for (const std::string& key : lab.keys()) {
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
      const std::string hint = did_you_mean(key, allowed);
      lab.reject(key, fmt::format("is not a table of a lab file{} allowed: {}; what belongs to the "
                                  "study stays in the definition",
                                  hint.empty() ? ";" : hint, fmt::join(allowed, ", ")));
    } else if (definition.has(key)) {
      lab.reject(key, fmt::format("is in the definition {} as well; keep the table in one of the "
                                  "two files",
                                  definition_file));
    }
  }
  lab.check();
}

/// The lab file of a definition that names one.
fs::path file_of(Table& root, const fs::path& definition) {
  Table table = root.table("lab");
  const std::string name = table.text("use");
  root.check();
  const fs::path file = definition.parent_path() / name;
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    table.reject("use", fmt::format("names {}, which is not a file; give its path from the "
                                    "definition, or leave [lab] out if the definition itself has "
                                    "the tables of devices and screen",
                                    file.string()));
    root.check();
  }
  return file;
}

std::string without_mark(std::string text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8, which only a first line may have
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

/// The certificate that [device] names; its figures must not stand beside it.
std::optional<fs::path> certificate_of(Table& root, const fs::path& machines) {
  if (!root.is_table("device")) {
    return std::nullopt;
  }
  Table device = root.table("device");
  if (!device.has("certificate")) {
    return std::nullopt;
  }
  const std::string name = device.text("certificate");
  if (root.has("certificate")) {
    root.reject("certificate", "stands beside device.certificate; leave one of the two out");
  }
  root.check();
  return machines.parent_path() / name;
}

Table with_given(Table root, const fs::path& file, const std::vector<GivenKey>& given) {
  return given.empty()
             ? root
             : Table::parse(with_values(root.source(), file.string(), given), file.string());
}

std::string table_of(const std::string& key) { return key.substr(0, key.find('.')); }

/// Whether a key belongs to the lab file: to a table of machines that the definition itself lacks.
bool is_of_lab(const Table& definition, const std::string& key) {
  const std::string table = table_of(key);
  const std::vector<std::string>& machines = machine_tables();
  return definition.has("lab") && !definition.has(table) &&
         std::find(machines.begin(), machines.end(), table) != machines.end();
}

}  // namespace

const std::vector<std::string>& machine_tables() {
  static const std::vector<std::string> kTables = [] {
    std::vector<std::string> tables{"actuators", "certificate", "channels", "device", "mouse",
                                    "gamepad",   "pedal",       "room",     "screen"};
    for (const device::VendorDevice& vendor : device::vendor_devices()) {
      tables.emplace_back(vendor.table);
    }
    std::ranges::sort(tables);
    return tables;
  }();
  return kTables;
}

Table load_with_lab(const fs::path& definition, std::span<const GivenKey> given) {
  Table root = Table::load(definition);
  std::vector<GivenKey> own;
  std::vector<GivenKey> of_lab;
  for (const GivenKey& each : given) {
    (is_of_lab(root, each.key) ? of_lab : own).push_back(each);
  }
  root = with_given(std::move(root), definition, own);
  fs::path machines = definition;  // the file that has [device]
  std::vector<NamedText> parts{{root.source(), definition.string()}};
  if (root.has("lab")) {
    const fs::path file = file_of(root, definition);
    Table lab = with_given(Table::load(file), file, of_lab);
    const std::string text = without_mark(lab.source());
    refuse_key_outside_tables(text, file.string());
    check_tables(lab, root, definition.string());
    machines = root.has("device") ? definition : file;
    parts.front().text += fmt::format("\n# From the lab file {}:\n", file.filename().string());
    parts.push_back({text + "\n", file.string()});
    root = Table::parse(parts);
  }
  const std::optional<fs::path> certificate = certificate_of(root, machines);
  if (!certificate) {
    return root;
  }
  parts.back().text += fmt::format("\n# From {}:\n", certificate->filename().string());
  parts.push_back({certificate_table(read_certificate(*certificate)), certificate->string()});
  return Table::parse(parts);
}

fs::path lab_with(const fs::path& definition, const std::string& key) {
  Table root = Table::load(definition);
  if (!is_of_lab(root, key)) {
    return {};
  }
  const fs::path file = file_of(root, definition);
  return Table::load(file).has(table_of(key)) ? file : fs::path{};
}

std::string lab_of(std::string_view definition) {
  try {
    Table root = Table::parse(definition, "definition");
    return root.has("lab") ? root.table("lab").text("use") : "";
  } catch (const InputError&) {
    return "";
  }
}

}  // namespace haptrial::protocols
