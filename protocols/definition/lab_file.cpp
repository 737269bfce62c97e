#include "protocols/definition/lab_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/device/vendor_devices.h"
#include "protocols/definition/certificate_file.h"

namespace haptrial::protocols {
namespace {

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
  if (!given.empty()) {
    root =
        Table::parse(with_values(root.source(), definition.string(), given), definition.string());
  }
  fs::path machines = definition;  // the file that has [device]
  std::vector<NamedText> parts{{root.source(), definition.string()}};
  if (root.has("lab")) {
    const fs::path file = file_of(root, definition);
    Table lab = Table::load(file);
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

std::string lab_of(std::string_view definition) {
  try {
    Table root = Table::parse(definition, "definition");
    return root.has("lab") ? root.table("lab").text("use") : "";
  } catch (const InputError&) {
    return "";
  }
}

}  // namespace haptrial::protocols
