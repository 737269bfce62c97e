#include "core/scene/read/read_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/base/random.h"
#include "core/scene/read/field_kinds.h"
#include "core/scene/read/field_reader.h"
#include "core/scene/read/read_shape.h"

namespace haptrial::scene {
namespace {

FieldKind read_constant(const FieldReader& read) {
  return ConstantParameters{read.vector("force", kForceBounds, "N")};
}

FieldKind read_ramp(const FieldReader& read) {
  RampParameters p;
  p.to = read.vector("to", kForceBounds, "N");
  p.rise = read.number("rise", kDurationBounds, "s");
  if (read.table.has("from")) {
    p.from = read.vector("from", kForceBounds, "N");
  }
  return p;
}

FieldKind read_pulse(const FieldReader& read) {
  PulseParameters p;
  p.force = read.vector("force", kForceBounds, "N");
  p.duration = read.number("duration", kDurationBounds, "s");
  p.delay = read.number_or(p.delay, "delay", {0.0, kDurationBounds.high}, "s");
  p.rise = read.number_or(p.rise, "rise", {0.0, kDurationBounds.high}, "s");
  if (p.rise > 0.5 * p.duration) {
    read.table.reject("rise", fmt::format("{} s", p.rise),
                      fmt::format("at most half the duration, {} s", 0.5 * p.duration));
    p.rise = 0.5 * p.duration;
  }
  return p;
}

FieldKind read_spring(const FieldReader& read) {
  return SpringParameters{read.place("to"), read.gains()};
}

FieldKind read_surface(const FieldReader& read, const std::string& kind) {
  SurfaceParameters p;
  p.shape = read_shape(read.table, kind, read.source);
  if (kind != "half_space" && read.table.has("felt_from")) {
    p.felt_from_inside = read.table.choice("felt_from", {"outside", "inside"}) == "inside";
  }
  p.gains = read.gains();
  return p;
}

FieldKind read_wall(const FieldReader& read) { return read_surface(read, "half_space"); }
FieldKind read_solid_box(const FieldReader& read) { return read_surface(read, "box"); }
FieldKind read_solid_sphere(const FieldReader& read) { return read_surface(read, "sphere"); }
FieldKind read_solid_cylinder(const FieldReader& read) { return read_surface(read, "cylinder"); }

FieldKind read_line_channel(const FieldReader& read) {
  LineChannelParameters p{read.place("from"), read.place("to"), read.gains()};
  if (p.from == p.to) {
    read.table.reject("to", "is the same place as from; write another one");
    p.to.x() += 0.1;
  }
  return p;
}

FieldKind read_channel(const FieldReader& read) {
  if (read.table.has("from") || read.table.has("to")) {
    return read_line_channel(read);
  }
  AxisChannelParameters p;
  p.free_x = p.free_y = p.free_z = false;
  const std::vector<std::string> axes = read.table.texts("axes");
  for (const std::string& axis : axes) {
    p.free_x = p.free_x || axis == "x";
    p.free_y = p.free_y || axis == "y";
    p.free_z = p.free_z || axis == "z";
    if (axis != "x" && axis != "y" && axis != "z") {
      read.table.reject("axes", fmt::format("an array with \"{}\"", axis), "\"x\", \"y\", \"z\"");
    }
  }
  if (p.free_x && p.free_y && p.free_z) {
    read.table.reject("axes", "leaves every axis free; write one or two of them");
  }
  p.through = read.place("through");
  p.gains = read.gains();
  return p;
}

FieldKind read_plane(const FieldReader& read) {
  return PlaneParameters{read.place("through"), read.direction("normal"), read.gains()};
}

FieldKind read_viscous(const FieldReader& read) {
  ViscousParameters p;
  p.damping = read.number("damping", kDampingBounds, "N·s/m");
  p.velocity_filter = read.number_or(p.velocity_filter, "velocity_filter", kFilterBounds, "Hz");
  return p;
}

FieldKind read_matrix_viscous(const FieldReader& read) {
  return MatrixViscousParameters{read.source.matrix(read.table, "matrix", {-1e3, 1e3}, "N·s/m"),
                                 read.number("velocity_filter", kFilterBounds, "Hz")};
}

FieldKind read_inertia(const FieldReader& read) {
  return InertiaParameters{read.number("mass", {0.0, 100.0}, "kg"),
                           read.number("acceleration_filter", kFilterBounds, "Hz")};
}

FieldKind read_friction(const FieldReader& read) {
  FrictionParameters p;
  p.on = read.text_or_none("on");
  const char* unit = p.on.empty() ? "N" : "";
  const Bounds bounds{0.0, p.on.empty() ? 100.0 : 10.0};
  p.static_level = read.number("static", bounds, unit);
  p.dynamic_level = read.number("dynamic", bounds, unit);
  p.stiffness = read.number_or(p.stiffness, "stiffness", {0.0, kStiffnessBounds.high, true}, "N/m");
  const bool dahl =
      read.table.has("model") && read.table.choice("model", {"bristle", "dahl"}) == "dahl";
  p.model = dahl ? FrictionParameters::Model::kDahl : FrictionParameters::Model::kBristle;
  const bool good = dahl ? p.static_level == p.dynamic_level : p.static_level >= p.dynamic_level;
  if (!good) {
    read.table.reject(
        "static", fmt::format("{}", p.static_level),
        fmt::format("{} dynamic, {}", dahl ? "the same as" : "at least", p.dynamic_level));
    p.static_level = p.dynamic_level;
  }
  return p;
}

FieldKind read_grating(const FieldReader& read) {
  GratingParameters p;
  p.on = read.table.text("on");
  p.direction = read.direction("direction");
  p.amplitude = read.number("amplitude", {0.0, 0.1}, "m");
  p.period = read.number("period", kLengthBounds, "m");
  p.phase = read.number_or(p.phase, "phase", {-1e3, 1e3}, "periods");
  if (read.table.has("profile") && read.table.choice("profile", {"sine", "rounded"}) == "rounded") {
    p.profile = GratingParameters::Profile::kRounded;
  }
  return p;
}

FieldKind read_texture(const FieldReader& read) {
  TextureParameters p;
  p.on = read.table.text("on");
  p.normal = read.direction("normal");
  p.roughness = read.number("roughness", {0.0, 0.1}, "m");
  p.lowest = read.number("lowest", {0.0, 1e5, true}, "1/m");
  p.highest = read.number("highest", {0.0, 1e5, true}, "1/m");
  p.seed = read.seed();
  if (!(p.highest > p.lowest)) {
    read.table.reject("highest", fmt::format("{}", p.highest),
                      fmt::format("a number above lowest, {}", p.lowest));
    p.highest = 2.0 * p.lowest;
  }
  return p;
}

FieldKind read_noise(const FieldReader& read) {
  NoiseVibrationParameters p;
  p.direction = read.direction("direction");
  p.rms = read.number("rms", kStrengthBounds, "N");
  p.lowest = read.frequency("lowest");
  p.highest = read.frequency("highest");
  p.seed = read.seed();
  if (!(p.highest > p.lowest)) {
    read.table.reject("highest", fmt::format("{} Hz", p.highest),
                      fmt::format("a number above lowest, {} Hz", p.lowest));
    p.highest = 0.5 * (p.lowest + 0.5 * read.rate);
  }
  return p;
}

FieldKind read_vibration(const FieldReader& read) {
  if (read.table.has("rms")) {
    return read_noise(read);
  }
  SineVibrationParameters p;
  p.direction = read.direction("direction");
  p.amplitude = read.number("amplitude", kStrengthBounds, "N");
  p.frequency = read.frequency("frequency");
  p.phase = read.number_or(p.phase, "phase", {-7.0, 7.0}, "rad");
  return p;
}

FieldKind read_tap(const FieldReader& read) {
  TapParameters p;
  p.on = read.text_or_none("on");
  if (p.on.empty()) {
    p.direction = read.direction("direction");
  }
  p.amplitude = read.number("amplitude", {0.0, 1e3}, p.on.empty() ? "N" : "N·s/m");
  p.frequency = read.frequency("frequency");
  p.decay = read.number("decay", kDurationBounds, "s");
  return p;
}

FieldKind read_detent(const FieldReader& read) {
  DetentParameters p;
  p.at = read.place("at");
  p.direction = read.direction("direction");
  p.spacing = read.number("spacing", kLengthBounds, "m");
  p.peak = read.number("peak", {0.0, read.limit}, "N");
  p.count = read.table.has("count") ? static_cast<int>(read.table.integer("count", 1, 1000)) : 0;
  return p;
}

FieldKind read_click(const FieldReader& read) {
  ClickParameters p;
  p.at = read.place("at");
  p.direction = read.direction("direction");
  p.peak = read.number("peak", {0.0, read.limit}, "N");
  p.travel = read.number("travel", kLengthBounds, "m");
  p.drop = read.number("drop", kStrengthBounds, "N");
  p.drop_travel = read.number("drop_travel", kLengthBounds, "m");
  if (p.drop > p.peak) {
    read.table.reject("drop", fmt::format("{} N", p.drop),
                      fmt::format("at most the peak, {} N", p.peak));
    p.drop = p.peak;
  }
  return p;
}

FieldKind read_mover(const FieldReader& read) {
  return MoverParameters{read.place("to"), read.number("duration", kDurationBounds, "s"),
                         read.gains()};
}

/// A random path as the force study draws it.
std::vector<Eigen::Vector3d> read_curve(const FieldReader& read) {
  Table table = read.table.table("curve");
  const FieldReader of{table, read.source, read.rate};
  stimulus::TrajectoryParameters p;
  p.length_x = of.number("length_x", kLengthBounds, "m");
  p.range_z = of.number("range_z", kLengthBounds, "m");
  p.sinusoids = static_cast<int>(of.number_or(p.sinusoids, "sinusoids", {1.0, 1000.0}, ""));
  p.max_spatial_frequency =
      of.number_or(p.max_spatial_frequency, "max_spatial_frequency", {0.1, 1000.0}, "cycles/m");
  RandomStream random(of.seed(), "path");
  return stimulus::SpatialTrajectory(p, random).points();
}

FieldKind read_path(const FieldReader& read) {
  PathParameters p;
  const bool both = read.table.has("points") && read.table.has("curve");
  if (both) {
    read.table.reject("curve", "stands beside points; keep one of the two");
    static_cast<void>(read.source.vectors(read.table, "points", kPlaceBounds, "m"));
  }
  std::vector<Eigen::Vector3d> points =
      read.table.has("curve") ? read_curve(read)
                              : read.source.vectors(read.table, "points", kPlaceBounds, "m");
  const bool moves = std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& each) {
    return each != points.front();
  });
  if (moves) {
    p.points = std::move(points);
  } else {
    read.table.reject("points", "go nowhere; write two places or more that are not the same");
  }
  p.duration = read.number("duration", kDurationBounds, "s");
  p.gains = read.gains();
  return p;
}

constexpr double kSoft = 0.05;

std::vector<KindOfField>& all_kinds() {
  static std::vector<KindOfField> kinds{
      {"constant", read_constant, kSoft},   {"ramp", read_ramp, 0.0},
      {"pulse", read_pulse, 0.0},           {"spring", read_spring, kSoft},
      {"wall", read_wall, kSoft},           {"box", read_solid_box, kSoft},
      {"sphere", read_solid_sphere, kSoft}, {"cylinder", read_solid_cylinder, kSoft},
      {"channel", read_channel, kSoft},     {"plane", read_plane, kSoft},
      {"viscous", read_viscous, kSoft},     {"matrix_viscous", read_matrix_viscous, kSoft},
      {"inertia", read_inertia, kSoft},     {"friction", read_friction, kSoft},
      {"grating", read_grating, kSoft},     {"texture", read_texture, kSoft},
      {"vibration", read_vibration, 0.0},   {"tap", read_tap, 0.0},
      {"detent", read_detent, kSoft},       {"click", read_click, kSoft},
      {"minimum_jerk", read_mover, 0.0},    {"path", read_path, kSoft},
  };
  return kinds;
}

/// Null if there is none.
const KindOfField* named(const std::string& word) {
  const std::vector<KindOfField>& kinds = all_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const KindOfField& kind) { return kind.word == word; });
  return found != kinds.end() ? &*found : nullptr;
}

/// Null, with the problem noted, if the type is not known.
const KindOfField* kind_of(Table& table) {
  std::vector<std::string> words;
  for (const KindOfField& kind : all_kinds()) {
    words.push_back(kind.word);
  }
  const std::string word = table.choice("type", words);
  if (table.whole_text("type") != word) {
    for (const std::string& key : table.keys()) {
      table.leave(key);  // what it means is not known
    }
    return nullptr;
  }
  return named(word);
}

}  // namespace

const std::vector<KindOfField>& kinds_of_field() { return all_kinds(); }

void add_kind_of_field(const KindOfField& kind) {
  if (named(kind.word) != nullptr) {
    throw std::invalid_argument(
        fmt::format("add_kind_of_field: there is a field '{}' already", kind.word));
  }
  all_kinds().push_back(kind);
}

Field read_field(Table& table, std::string name, double rate, const NumberSource& source) {
  Field field;
  field.name = std::move(name);
  const KindOfField* kind = kind_of(table);
  if (kind == nullptr) {
    return field;
  }
  FieldReader read{table, source, rate};
  const std::string word = kind->word;
  if (word != "grating" && word != "texture") {
    field.limit = read.number_or(field.limit, "limit", {0.0, 100.0, true}, "N");
  }
  read.limit = field.limit;
  field.fade_in = read.number_or(kind->fade, "fade_in", kFadeBounds, "s");
  field.fade_out = read.number_or(kind->fade, "fade_out", kFadeBounds, "s");
  field.kind = kind->read(read);
  return field;
}

std::vector<Field> read_fields(Table& fields, double rate, const NumberSource& source,
                               const std::vector<Field>& objects) {
  std::vector<Field> found;
  std::vector<Table> tables;
  for (const std::string& name : fields.keys()) {
    tables.push_back(fields.table(name));
    found.push_back(read_field(tables.back(), name, rate, source));
  }
  std::vector<std::string> surfaces;
  for (const std::vector<Field>* some : {&std::as_const(found), &objects}) {
    for (const Field& field : *some) {
      if (is_surface(field)) {
        surfaces.push_back(field.name);
      }
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string& on = surface_of(found[i]);
    if (on.empty() || std::find(surfaces.begin(), surfaces.end(), on) != surfaces.end()) {
      continue;
    }
    if (surfaces.empty()) {
      tables[i].reject("on", fmt::format("is \"{}\", but the definition has no wall, box, sphere "
                                         "or cylinder; add one",
                                         on));
    } else {
      tables[i].reject("on", fmt::format("\"{}\"", on),
                       fmt::format("{}", fmt::join(surfaces, ", ")));
    }
  }
  return found;
}

}  // namespace haptrial::scene
