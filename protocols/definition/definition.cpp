#include "protocols/definition/definition.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>

#include "core/base/definition/schema.h"
#include "core/base/definition/table.h"
#include "core/questions/read_pages.h"
#include "protocols/definition/room.h"

namespace haptrial::protocols {
namespace {

void read_devices(Table& root, Definition& setup) {
  const auto read = [&root](const char* key, auto& into, const auto& schema) {
    if (root.has(key)) {
      Table table = root.table(key);
      schema.read(table, into);
    }
  };
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    if (root.has(vendor.table)) {
      Table table = root.table(vendor.table);
      vendor.read(table, setup.vendor);
    }
  }
  read("mouse", setup.mouse, device::mouse_schema());
  read("gamepad", setup.gamepad, device::gamepad_schema());
  read("pedal", setup.pedal, device::pedal_schema());
}

const Schema<Definition>& experiment_schema() {
  using D = Definition;
  static const auto schema =
      Schema<D>()
          .text("name", &D::name, "Name of the study, for reports and new folders")
          .required()
          .text("protocol", &D::protocol, "Kind of experiment")
          .otherwise("force_training")
          .number("rate", &D::rate, {100.0, 20000.0}, "Hz", "Ticks of the servo loop per second")
          .required();
  return schema;
}

const Schema<Definition>& lab_schema() {
  static const auto schema =
      Schema<Definition>()
          .text("use", &Definition::lab,
                "File with tables of devices and screen, relative to the definition; without [lab] "
                "the definition has them")
          .required();
  return schema;
}

const Schema<Definition>& certified_schema() {
  static const auto schema =
      Schema<Definition>()
          .text(
              "certificate", &Definition::certificate_file,
              "Certificate of the device (certificate.json of haptrial device-test --certificate), "
              "relative to the file that names it; reports then give forces as measured, too")
          .otherwise("none");
  return schema;
}

const Schema<Definition>& integrator_schema() {
  static const auto schema =
      Schema<Definition>()
          .choice("integrator", &Definition::integrator,
                  {{"exact", Integrator::kExact}, {"cvode", Integrator::kCvode}},
                  "Integrator of the virtual hand: its exact solution, or CVODE's")
          .required();
  return schema;
}

}  // namespace

void read_common(Table& root, std::string_view file_name, Definition& definition) {
  Table experiment = root.table("experiment");
  Table envelope = root.table("envelope");
  Table device = root.table("device");
  Table hand = root.table("hand");
  Table screen = root.table("screen");
  Table texts = root.table("texts");
  if (root.has("lab")) {
    Table lab = root.table("lab");
    lab_schema().read(lab, definition);
  }
  if (root.has("room")) {
    Table room = root.table("room");
    room_schema().read(room);
  }
  if (root.has("plan")) {
    root.leave("plan");  // of who writes the study's preregistration
  }
  definition.text = root.source();
  definition.document = std::make_shared<Table>(root.unread());
  definition.file_name = std::filesystem::path(file_name).filename().string();
  definition.groups = read_groups(root);
  experiment_schema().read(experiment, definition);
  definition.envelope = device::envelope_schema().read(envelope);
  definition.device = device::virtual_device_schema().read(device);
  certified_schema().read(device, definition);
  if (root.has("certificate")) {
    Table certificate = root.table("certificate");
    definition.certificate = device::certificate_schema().read(certificate);
  }
  integrator_schema().read(hand, definition);
  definition.hand = subject::hand_schema().read(hand);
  if (!envelope.has("holding_force")) {  // friction holds on both sides of a standstill
    definition.envelope.holding_force =
        std::max(definition.envelope.holding_force, 5.0 * definition.hand.coulomb_friction);
  }
  definition.screen = screen_schema().read(screen);
  definition.texts = text_schema().read(texts);
  definition.pages = questions::read_pages(root);
  read_devices(root, definition);
  definition.channels = channel::read_channels(root);
  definition.actuators = sound::read_actuators(root);
  if (root.has("markers")) {
    Table markers = root.table("markers");
    definition.markers = markers::marker_schema().read(markers);
  }
  if (root.has("tutoring")) {
    Table tutoring = root.table("tutoring");
    definition.tutoring = tutoring_schema().read(tutoring);
    check_groups(root, tutoring, "led_in", definition.tutoring.led.groups);
  }
  definition.tutoring.most_force = definition.envelope.max_force;
  if (definition.screen.photodiode == Photodiode::kOnset) {
    definition.markers.used = true;
  }
}

Table Definition::root() const { return document->unread(); }

const SessionPlan& Definition::session_plan(int session) const {
  static const SessionPlan plain;
  const auto at = static_cast<std::size_t>(session - 1);
  return session >= 1 && at < session_plans.size() ? session_plans[at] : plain;
}

std::string Definition::session_name(int session) const {
  const std::string& stated = session_plan(session).name;
  return stated.empty() ? std::to_string(session) : stated;
}

bool Definition::comes(int session, std::string_view group) const {
  const std::vector<std::string>& coming = session_plan(session).groups;
  return coming.empty() || std::ranges::find(coming, group) != coming.end();
}

int Definition::sessions_of(std::string_view group) const {
  int all = 0;
  for (int session = 1; session <= sessions(); ++session) {
    all += comes(session, group) ? 1 : 0;
  }
  return all;
}

bool Definition::is_led(int session, const GivenPlace& place) const {
  return session_plan(session).gives && is_given(tutoring.led, in_course(session, place));
}

GivenPlace Definition::in_course(int session, GivenPlace place) const {
  const bool practice = place.trial < 1;
  for (int earlier = 1; earlier < session && !practice; ++earlier) {
    const bool counts = comes(earlier, place.group) && session_plan(earlier).gives;
    place.trial += counts ? trials_in(earlier) : 0;
  }
  return place;
}

void check_common(Table& root, Definition& definition) {
  plan_further(root, definition.groups, definition.design.participants);
  Table envelope = root.table("envelope");
  if (definition.envelope.max_force > definition.device.max_force) {
    envelope.reject("max_force", fmt::format("{}", definition.envelope.max_force),
                    fmt::format("at most device.max_force, {} [N]", definition.device.max_force));
  }
  if (definition.envelope.workspace_radius > definition.device.workspace_radius) {
    envelope.reject(
        "workspace_radius", fmt::format("{}", definition.envelope.workspace_radius),
        fmt::format("at most device.workspace_radius, {} [m]", definition.device.workspace_radius));
  }
  for (const int key : definition.tutoring.pause_keys) {
    if (definition.functions_of({key}) != 0) {
      root.table("tutoring")
          .reject("pause_keys", "a list with a key that has another function",
                  "keys that the definition uses for nothing else");
    }
  }
  if (definition.screen.mistake_key != 0 &&
      definition.bits_of({definition.screen.mistake_key}) != 0) {
    root.table("screen").reject("mistake_key", "a key that has another function",
                                "a key that the definition uses for nothing else");
  }
  const bool plain =
      std::all_of(definition.name.begin(), definition.name.end(),
                  [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
  if (!plain) {
    root.table("experiment")
        .reject("name", fmt::format("'{}'", definition.name), "letters, digits, '-' and '_'");
  }
}

std::vector<markers::MarkerMeaning> Definition::marker_meanings() const {
  using record::MarkerOf;
  const int stage = markers.stage;
  return {{MarkerOf::kTrial, 0, "trial", markers.trial},
          {MarkerOf::kStage, 0, "approach", stage},
          {MarkerOf::kStage, 1, "wait", stage + 1},
          {MarkerOf::kStage, 2, "run", stage + 2},
          {MarkerOf::kStage, 3, "return", stage + 3}};
}

std::uint32_t Definition::bits_of(const std::vector<int>& held) const {
  const bool waits = std::ranges::any_of(
      tutoring.pause_keys, [&](int key) { return std::ranges::find(held, key) != held.end(); });
  return functions_of(held) | (waits ? kPauseBit : 0);
}

void check_markers(Table& root, const Definition& definition) {
  if (definition.markers.used) {
    const char* key = root.has("markers") ? "markers" : root.has("stages") ? "stages" : "screen";
    markers::check_meanings(root, key, definition.marker_meanings());
  }
}

void reject_speed(Table& root, const Definition& d, const char* table, const char* key,
                  double speed) {
  if (speed > d.envelope.max_speed) {
    root.table(table).reject(
        key, fmt::format("{:g}", speed),
        fmt::format("at most envelope.max_speed, {:g} [m/s]", d.envelope.max_speed));
  } else if (speed / d.rate > d.envelope.max_jump) {
    root.table(table).reject(
        key, fmt::format("{:g}, which is {:g} m in a tick", speed, speed / d.rate),
        fmt::format("at most envelope.max_jump in a tick, {:g} [m]", d.envelope.max_jump));
  }
}

control::HandleLoop handle_loop(const Definition& d) {
  control::HandleLoop loop;
  loop.handle_mass = d.hand.handle_mass;
  loop.rate = d.rate;
  loop.force_delay = d.device.force_delay;
  loop.velocity_window = device::readings_in_window(d.device.velocity_window, d.rate);
  loop.velocity_step =
      control::velocity_of_a_step(d.device.position_quantum, loop.velocity_window, d.rate);
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    // A board is driven only if the definition has its table, which names its line.
    const bool stated = d.document != nullptr && d.root().has(vendor.table);
    if (vendor.takes_library || stated) {
      const auto readings =
          static_cast<int>(std::lround(vendor.velocity_window(d.vendor) * d.rate));
      loop.velocity_window = std::max(loop.velocity_window, readings);
    }
  }
  return loop;
}

}  // namespace haptrial::protocols
