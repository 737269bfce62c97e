#include "core/device/certificate.h"

#include "core/base/definition/schema.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::device {
namespace {

constexpr const char* kNotFound = "not identified";

void check_gain(Table& table, const CertifiedForce& c) {
  if (c.gain.has_value() != c.gain_low.has_value() ||
      c.gain.has_value() != c.gain_high.has_value()) {
    table.reject("gain", "without one of gain_low and gain_high", "all three, or none of them");
  } else if (c.gain && (*c.gain < *c.gain_low || *c.gain > *c.gain_high)) {
    table.reject("gain", "outside of gain_low to gain_high", "a gain within its interval");
  }
}

/// Adds the figures of one part. @param force  unit of its force.  @param stiffness  of a spring
template <class C>
void add_figures(Schema<C>& schema, const char* force, const char* stiffness) {
  schema
      .number("gain", &C::gain, {0.0, 10.0, true}, "1",
              "Force that the device gives per force commanded")
      .otherwise(kNotFound)
      .number("gain_low", &C::gain_low, {0.0, 10.0, true}, "1",
              "Lower end of the gain's 95 % interval")
      .otherwise(kNotFound)
      .number("gain_high", &C::gain_high, {0.0, 10.0, true}, "1",
              "Upper end of the gain's 95 % interval")
      .otherwise(kNotFound)
      .number("dead_zone", &C::dead_zone, {0.0, 100.0}, force,
              "Length of a commanded force up to which the device gives none")
      .otherwise(kNotFound)
      .number("friction", &C::friction, {0.0, 100.0}, force, "Friction of the device")
      .otherwise(kNotFound)
      .number("force_noise", &C::force_noise, {0.0, 100.0}, force,
              "Ripple of the device's force, root mean square")
      .otherwise(kNotFound)
      .number("delay", &C::delay, {0.0, 1.0}, "s", "Time from a command to its force")
      .otherwise(kNotFound)
      .number("stiffest_wall", &C::stiffest_wall, {0.0, 1e6, true}, stiffness,
              "Stiffness of the stiffest wall that stays passive on the device")
      .otherwise(kNotFound)
      .check([](Table& table, C& c) { check_gain(table, c); });
}

Schema<CertifiedForce> figures_in(const char* force, const char* stiffness) {
  Schema<CertifiedForce> schema;
  add_figures(schema, force, stiffness);
  return schema;
}

}  // namespace

const Schema<Certificate>& certificate_schema() {
  using C = Certificate;
  static const auto rotation = figures_in("N·m", "N·m/rad");
  static const auto grip = figures_in("N", "N/m");
  static const auto schema = [] {
    Schema<C> made;
    made.text("file", &C::file, "File of the certificate that these figures are from")
        .required()
        .text("checksum", &C::checksum, "Checksum of that file (FNV-1a, hexadecimal)")
        .required()
        .text("device", &C::device, "Name of the device that was measured")
        .required()
        .flag("simulated", &C::simulated, "Whether that device was a virtual one");
    add_figures(made, "N", "N/m");
    made.table("rotation", &C::rotation, rotation, "The same figures of the device's rotation")
        .table("grip", &C::grip, grip, "The same figures of the device's grip");
    return made;
  }();
  return schema;
}

std::optional<Certificate> certificate_in(const std::string& definition, const std::string& name) {
  try {
    Table root = Table::parse(definition, name);
    if (!root.is_table("certificate")) {
      return std::nullopt;
    }
    Table table = root.table("certificate");
    const Certificate certificate = certificate_schema().read(table);
    root.check();
    return certificate;
  } catch (const InputError&) {
    return std::nullopt;  // a report of sessions whose definition no longer reads goes without
  }
}

}  // namespace haptrial::device
