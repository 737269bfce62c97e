#include "protocols/definition/certificate_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"

namespace haptrial::protocols {
namespace {

using Json = nlohmann::json;

/// A part of a described finding; nothing if the figure is not defined.
std::optional<double> number_of(const Json& findings, const char* name, const char* part) {
  const auto finding = findings.find(name);
  if (finding == findings.end() || !finding->is_object()) {
    return std::nullopt;
  }
  const auto at = finding->find(part);
  return at == finding->end() || !at->is_number() ? std::nullopt : std::optional(at->get<double>());
}

void read_figures(const Json& findings, device::CertifiedForce& c) {
  c.gain = number_of(findings, "gain", "estimate");
  c.gain_low = number_of(findings, "gain", "low_95");
  c.gain_high = number_of(findings, "gain", "high_95");
  if (!c.gain || !c.gain_low || !c.gain_high) {
    c.gain = c.gain_low = c.gain_high = std::nullopt;
  }
  c.dead_zone = number_of(findings, "dead_zone", "estimate");
  c.friction = number_of(findings, "friction", "estimate");
  c.force_noise = number_of(findings, "force_noise", "estimate");
  c.delay = number_of(findings, "delay", "estimate");
  c.stiffest_wall = number_of(findings, "stiffest_wall", "low_95");
}

/// The key figures of a further part; nothing if the certificate does not state one.
std::optional<device::CertifiedForce> figures_of(const Json& root, const char* summary) {
  const auto list = root.find(summary);
  if (list == root.end() || !list->is_object() || !list->contains("findings") ||
      !list->at("findings").is_object()) {
    return std::nullopt;
  }
  device::CertifiedForce c;
  read_figures(list->at("findings"), c);
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

}  // namespace

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
  const Json& findings = root["summary"]["findings"];
  device::Certificate c;
  c.file = file.filename().string();
  c.checksum = fmt::format("{:016x}", fnv1a(text));
  c.device = root["device"].get<std::string>();
  c.simulated = root["simulated"].get<bool>();
  read_figures(findings, c);
  c.rotation = figures_of(root, "rotation_summary");
  c.grip = figures_of(root, "grip_summary");
  return c;
}

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

}  // namespace haptrial::protocols
