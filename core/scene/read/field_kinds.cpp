#include "core/scene/read/field_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/random.h"
#include "core/scene/read/read_shape.h"

namespace haptrial::scene {
namespace {

using control::PdGains;

/// The keys of a kind that has nothing else to look at.
template <class T, const Schema<T>& (*schema)()>
FieldKind read_plainly(Table& table, const FieldSetting&) {
  return schema().read(table);
}

constexpr const char* kTo =
    "Force of a ramp at its end, place that the hand is pulled to, or end of a channel";
constexpr const char* kToAbsent = "needed, but for a channel with axes";
constexpr const char* kFrom = "Force of a ramp at its beginning, or beginning of a channel";
constexpr const char* kFromAbsent = "no force of a ramp, axes of a channel";

const Schema<ConstantParameters>& constant_schema() {
  static const auto schema = Schema<ConstantParameters>()
                                 .vector("force", &ConstantParameters::force, kForceBounds, "N",
                                         "Force of the field in the world frame")
                                 .required();
  return schema;
}

const Schema<RampParameters>& ramp_schema() {
  using P = RampParameters;
  static const auto schema =
      Schema<P>()
          .vector("to", &P::to, kForceBounds, "N", kTo)
          .required()
          .otherwise(kToAbsent)
          .number("rise", &P::rise, kDurationBounds, "s",
                  "Time over which the force of a ramp or of an edge of a pulse grows")
          .required()
          .vector("from", &P::from, kForceBounds, "N", kFrom)
          .otherwise(kFromAbsent);
  return schema;
}

const Schema<PulseParameters>& pulse_schema() {
  using P = PulseParameters;
  static const auto schema =
      Schema<P>()
          .vector("force", &P::force, kForceBounds, "N", "Force of the field in the world frame")
          .required()
          .number("duration", &P::duration, kDurationBounds, "s",
                  "Duration of a pulse or of a movement")
          .required()
          .number("delay", &P::delay, {0.0, kDurationBounds.high}, "s",
                  "Time from the beginning of the stage to a pulse")
          .number("rise", &P::rise, {0.0, kDurationBounds.high}, "s",
                  "Time over which the force of a ramp or of an edge of a pulse grows")
          .check([](Table& table, P& p) {
            if (p.rise > 0.5 * p.duration) {
              table.reject("rise", fmt::format("{} s", p.rise),
                           fmt::format("at most half the duration, {} s", 0.5 * p.duration));
              p.rise = 0.5 * p.duration;
            }
          });
  return schema;
}

const Schema<SpringParameters>& spring_schema() {
  using P = SpringParameters;
  static const auto schema = Schema<P>()
                                 .vector("to", &P::to, kPlaceBounds, "m", kTo)
                                 .required()
                                 .otherwise(kToAbsent)
                                 .keys_of(&P::gains, field_gains_schema());
  return schema;
}

const Schema<SurfaceParameters>& surface_schema() {
  using P = SurfaceParameters;
  static const auto schema =
      Schema<P>()
          .choice("felt_from", &P::felt_from_inside, {{"outside", false}, {"inside", true}},
                  "Side from which a surface is felt")
          .only_if([](const P& p) { return !std::holds_alternative<HalfSpace>(p.shape); })
          .keys_of(&P::gains, field_gains_schema());
  return schema;
}

FieldKind read_surface(Table& table, const char* shape) {
  SurfaceParameters p;
  p.shape = read_shape(table, shape);
  surface_schema().read(table, p);
  return p;
}

FieldKind read_wall(Table& table, const FieldSetting&) { return read_surface(table, "half_space"); }
FieldKind read_solid_box(Table& table, const FieldSetting&) { return read_surface(table, "box"); }
FieldKind read_solid_sphere(Table& table, const FieldSetting&) {
  return read_surface(table, "sphere");
}
FieldKind read_solid_cylinder(Table& table, const FieldSetting&) {
  return read_surface(table, "cylinder");
}

const Schema<LineChannelParameters>& line_channel_schema() {
  using P = LineChannelParameters;
  static const auto schema =
      Schema<P>()
          .vector("from", &P::from, kPlaceBounds, "m", kFrom)
          .required()
          .otherwise(kFromAbsent)
          .vector("to", &P::to, kPlaceBounds, "m", kTo)
          .required()
          .otherwise(kToAbsent)
          .keys_of(&P::gains, field_gains_schema())
          .check([](Table& table, P& p) {
            if (p.from == p.to) {
              table.reject("to", "is the same place as from; write another one");
              p.to.x() += 0.1;
            }
          });
  return schema;
}

void read_axes(Table& table, AxisChannelParameters& p) {
  p.free_x = p.free_y = p.free_z = false;
  for (const std::string& axis : table.texts("axes")) {
    p.free_x = p.free_x || axis == "x";
    p.free_y = p.free_y || axis == "y";
    p.free_z = p.free_z || axis == "z";
    if (axis != "x" && axis != "y" && axis != "z") {
      table.reject("axes", fmt::format("an array with \"{}\"", axis), "\"x\", \"y\", \"z\"");
    }
  }
  if (p.free_x && p.free_y && p.free_z) {
    table.reject("axes", "leaves every axis free; write one or two of them");
  }
}

const Schema<AxisChannelParameters>& axis_channel_schema() {
  using P = AxisChannelParameters;
  static const auto schema =
      Schema<P>()
          .custom("axes", "Axes along which a channel leaves the hand free: x, y, z",
                  [](Table& table, const std::string&, P& p) { read_axes(table, p); })
          .required()
          .vector("through", &P::through, kPlaceBounds, "m", "Point of a channel or plane")
          .required()
          .keys_of(&P::gains, field_gains_schema());
  return schema;
}

FieldKind read_channel(Table& table, const FieldSetting&) {
  if (table.has("from") || table.has("to")) {
    return line_channel_schema().read(table);
  }
  return axis_channel_schema().read(table);
}

const Schema<PlaneParameters>& plane_schema() {
  using P = PlaneParameters;
  static const auto schema =
      Schema<P>()
          .vector("through", &P::through, kPlaceBounds, "m", "Point of a channel or plane")
          .required()
          .any_direction("normal", &P::normal, kNormal)
          .required()
          .keys_of(&P::gains, field_gains_schema());
  return schema;
}

constexpr const char* kVelocityFilter = "Cut-off of the filter of the hand's velocity";

const Schema<ViscousParameters>& viscous_schema() {
  using P = ViscousParameters;
  static const auto schema =
      Schema<P>()
          .number("damping", &P::damping, kDampingBounds, "N·s/m",
                  "Damping against the hand's motion; a surface's begins over the first 1 mm")
          .required()
          .number("velocity_filter", &P::velocity_filter, kFilterBounds, "Hz", kVelocityFilter);
  return schema;
}

const Schema<MatrixViscousParameters>& matrix_viscous_schema() {
  using P = MatrixViscousParameters;
  static const auto schema =
      Schema<P>()
          .custom("matrix", "Matrix B of the force B v",
                  [](Table& table, const std::string& key, P& p) {
                    p.matrix = read_matrix(table, key, {-1e3, 1e3}, "N·s/m");
                  })
          .required()
          .number("velocity_filter", &P::velocity_filter, kFilterBounds, "Hz", kVelocityFilter)
          .required();
  return schema;
}

const Schema<InertiaParameters>& inertia_schema() {
  using P = InertiaParameters;
  static const auto schema =
      Schema<P>()
          .number("mass", &P::mass, {0.0, 100.0}, "kg", "Virtual mass that the hand feels")
          .required()
          .number("acceleration_filter", &P::acceleration_filter, kFilterBounds, "Hz",
                  "Cut-off of the filter of the hand's acceleration")
          .required();
  return schema;
}

constexpr const char* kOn =
    "Name of the surface, a field, that this field belongs to: it rubs, shapes or strikes there";

/// Levels of friction on a surface are coefficients, those in free space forces.
template <double FrictionParameters::*level>
void read_level(Table& table, const std::string& key, FrictionParameters& p) {
  const bool free = p.on.empty();
  p.*level = table.number(key, {0.0, free ? 100.0 : 10.0}, free ? "N" : "");
}

const Schema<FrictionParameters>& friction_schema() {
  using P = FrictionParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .otherwise("everywhere")
          .custom("static", "Friction before it slips: a force, or on a surface a coefficient",
                  read_level<&P::static_level>)
          .required()
          .custom("dynamic", "Friction while it slips: a force, or on a surface a coefficient",
                  read_level<&P::dynamic_level>)
          .required()
          .number("stiffness", &P::stiffness, {0.0, kStiffnessBounds.high, true}, "N/m",
                  "Stiffness of the spring that holds the hand, or of the bristles of friction")
          .choice("model", &P::model, {{"bristle", P::Model::kBristle}, {"dahl", P::Model::kDahl}},
                  "Model of friction")
          .check([](Table& table, P& p) {
            const bool dahl = p.model == P::Model::kDahl;
            const bool good =
                dahl ? p.static_level == p.dynamic_level : p.static_level >= p.dynamic_level;
            if (!good) {
              table.reject("static", fmt::format("{}", p.static_level),
                           fmt::format("{} dynamic, {}", dahl ? "the same as" : "at least",
                                       p.dynamic_level));
              p.static_level = p.dynamic_level;
            }
          });
  return schema;
}

constexpr const char* kDirection = "Direction in which a field acts or is laid out";

const Schema<GratingParameters>& grating_schema() {
  using P = GratingParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .required()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("amplitude", &P::amplitude, {0.0, 0.1}, "m",
                  "Amplitude of a relief or of a vibration")
          .required()
          .number("period", &P::period, kLengthBounds, "m", "Period of a grating")
          .required()
          .number("phase", &P::phase, {-1e3, 1e3}, "periods",
                  "Phase of a grating or of a vibration")
          .choice("profile", &P::profile,
                  {{"sine", P::Profile::kSine}, {"rounded", P::Profile::kRounded}},
                  "Profile of a grating: a sine, or flat ridges and grooves with soft edges");
  return schema;
}

constexpr const char* kLowest = "Lowest frequency of a texture or of a vibration that is noise";
constexpr const char* kHighest = "Highest frequency of a texture or of a vibration that is noise";
constexpr const char* kSeed = "Seed of the random numbers of a texture, noise or path";

const Schema<TextureParameters>& texture_schema() {
  using P = TextureParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .required()
          .any_direction("normal", &P::normal, kNormal)
          .required()
          .number("roughness", &P::roughness, {0.0, 0.1}, "m",
                  "Root mean square of a texture's height")
          .required()
          .number("lowest", &P::lowest, {0.0, 1e5, true}, "1/m", kLowest)
          .required()
          .number("highest", &P::highest, {0.0, 1e5, true}, "1/m", kHighest)
          .required()
          .seed("seed", &P::seed, kSeed)
          .required()
          .check([](Table& table, P& p) {
            if (!(p.highest > p.lowest)) {
              table.reject("highest", fmt::format("{}", p.highest),
                           fmt::format("a number above lowest, {}", p.lowest));
              p.highest = 2.0 * p.lowest;
            }
          });
  return schema;
}

/// A frequency that the loop cannot present is refused.
void keep_below_half_rate(Table& table, const char* key, double& frequency, double rate) {
  if (!(frequency < 0.5 * rate)) {
    table.reject(key, fmt::format("{} Hz", frequency),
                 fmt::format("a number below half the servo loop's rate, {} Hz", 0.5 * rate));
    frequency = 0.25 * rate;
  }
}

const Schema<NoiseVibrationParameters>& noise_schema() {
  using P = NoiseVibrationParameters;
  static const auto schema = Schema<P>()
                                 .any_direction("direction", &P::direction, kDirection)
                                 .required()
                                 .number("rms", &P::rms, kStrengthBounds, "N",
                                         "Root mean square of a vibration that is noise")
                                 .otherwise("a sine with amplitude")
                                 .number("lowest", &P::lowest, kFilterBounds, "Hz", kLowest)
                                 .required()
                                 .number("highest", &P::highest, kFilterBounds, "Hz", kHighest)
                                 .required()
                                 .seed("seed", &P::seed, kSeed)
                                 .required();
  return schema;
}

const Schema<SineVibrationParameters>& sine_schema() {
  using P = SineVibrationParameters;
  static const auto schema =
      Schema<P>()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("amplitude", &P::amplitude, kStrengthBounds, "N",
                  "Amplitude of a relief or of a vibration")
          .required()
          .number("frequency", &P::frequency, kFilterBounds, "Hz",
                  "Frequency of a vibration or tap")
          .required()
          .number("phase", &P::phase, {-7.0, 7.0}, "rad", "Phase of a grating or of a vibration");
  return schema;
}

FieldKind read_vibration(Table& table, const FieldSetting& setting) {
  if (!table.has("rms")) {
    SineVibrationParameters p = sine_schema().read(table);
    keep_below_half_rate(table, "frequency", p.frequency, setting.rate);
    return p;
  }
  NoiseVibrationParameters p = noise_schema().read(table);
  keep_below_half_rate(table, "lowest", p.lowest, setting.rate);
  keep_below_half_rate(table, "highest", p.highest, setting.rate);
  if (!(p.highest > p.lowest)) {
    table.reject("highest", fmt::format("{} Hz", p.highest),
                 fmt::format("a number above lowest, {} Hz", p.lowest));
    p.highest = 0.5 * (p.lowest + 0.5 * setting.rate);
  }
  return p;
}

const Schema<TapParameters>& tap_schema() {
  using P = TapParameters;
  static const auto schema =
      Schema<P>()
          .text("on", &P::on, kOn)
          .otherwise("everywhere")
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .only_if([](const P& p) { return p.on.empty(); })
          .custom("amplitude", "Amplitude of a relief or of a vibration",
                  [](Table& table, const std::string& key, P& p) {
                    p.amplitude = table.number(key, {0.0, 1e3}, p.on.empty() ? "N" : "N·s/m");
                  })
          .required()
          .number("frequency", &P::frequency, kFilterBounds, "Hz",
                  "Frequency of a vibration or tap")
          .required()
          .number("decay", &P::decay, kDurationBounds, "s", "Time constant at which a tap decays")
          .required();
  return schema;
}

FieldKind read_tap(Table& table, const FieldSetting& setting) {
  TapParameters p = tap_schema().read(table);
  keep_below_half_rate(table, "frequency", p.frequency, setting.rate);
  return p;
}

constexpr const char* kAt = "Place of the first detent, or of the top of a click";
constexpr const char* kPeak = "Greatest force of a detent or click, at most the field's limit";

/// A peak above the field's limit would never be felt.
void keep_peak_below_limit(Table& table, double& peak, double limit) {
  if (peak > limit) {
    table.reject("peak", fmt::format("{}", peak), fmt::format("at most the limit, {} [N]", limit));
    peak = limit;
  }
}

const Schema<DetentParameters>& detent_schema() {
  using P = DetentParameters;
  static const auto schema =
      Schema<P>()
          .vector("at", &P::at, kPlaceBounds, "m", kAt)
          .required()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("spacing", &P::spacing, kLengthBounds, "m", "Distance between detents")
          .required()
          .number("peak", &P::peak, kStrengthBounds, "N", kPeak)
          .required()
          .integer("count", &P::count, 1, 1000, "Number of detents")
          .otherwise("no end");
  return schema;
}

FieldKind read_detent(Table& table, const FieldSetting& setting) {
  DetentParameters p = detent_schema().read(table);
  keep_peak_below_limit(table, p.peak, setting.limit);
  return p;
}

const Schema<ClickParameters>& click_schema() {
  using P = ClickParameters;
  static const auto schema =
      Schema<P>()
          .vector("at", &P::at, kPlaceBounds, "m", kAt)
          .required()
          .any_direction("direction", &P::direction, kDirection)
          .required()
          .number("peak", &P::peak, kStrengthBounds, "N", kPeak)
          .required()
          .number("travel", &P::travel, kLengthBounds, "m", "Way of a click up to its peak")
          .required()
          .number("drop", &P::drop, kStrengthBounds, "N", "Drop of a click's force after its peak")
          .required()
          .number("drop_travel", &P::drop_travel, kLengthBounds, "m",
                  "Way over which a click's force drops")
          .required();
  return schema;
}

FieldKind read_click(Table& table, const FieldSetting& setting) {
  ClickParameters p = click_schema().read(table);
  keep_peak_below_limit(table, p.peak, setting.limit);
  if (p.drop > p.peak) {
    table.reject("drop", fmt::format("{} N", p.drop),
                 fmt::format("at most the peak, {} N", p.peak));
    p.drop = p.peak;
  }
  return p;
}

const Schema<MoverParameters>& mover_schema() {
  using P = MoverParameters;
  static const auto schema = Schema<P>()
                                 .vector("to", &P::to, kPlaceBounds, "m", kTo)
                                 .required()
                                 .otherwise(kToAbsent)
                                 .number("duration", &P::duration, kDurationBounds, "s",
                                         "Duration of a pulse or of a movement")
                                 .required()
                                 .keys_of(&P::gains, field_gains_schema());
  return schema;
}

/// A random path as the force study draws it.
struct RandomCurve {
  stimulus::TrajectoryParameters shape;
  std::uint64_t seed{0};
};

const Schema<stimulus::TrajectoryParameters>& curve_shape_schema() {
  using P = stimulus::TrajectoryParameters;
  static const auto schema =
      Schema<P>()
          .number("length_x", &P::length_x, kLengthBounds, "m",
                  "Extent of a random path from left to right")
          .required()
          .number("range_z", &P::range_z, kLengthBounds, "m", "Extent of a random path across")
          .required()
          .custom("sinusoids", "Number of sinusoids whose sum is a random path",
                  [](Table& table, const std::string& key, P& p) {
                    p.sinusoids = static_cast<int>(table.number(key, {1.0, 1000.0}, ""));
                  })
          .otherwise(fmt::format("{}", P{}.sinusoids))
          .number("max_spatial_frequency", &P::max_spatial_frequency, {0.1, 1000.0}, "cycles/m",
                  "Highest spatial frequency of the sinusoids of a random path");
  return schema;
}

const Schema<RandomCurve>& random_curve_schema() {
  static const auto schema = Schema<RandomCurve>()
                                 .keys_of(&RandomCurve::shape, curve_shape_schema())
                                 .seed("seed", &RandomCurve::seed, kSeed)
                                 .required();
  return schema;
}

std::vector<Eigen::Vector3d> read_curve(Table& table) {
  Table inner = table.table("curve");
  const RandomCurve curve = random_curve_schema().read(inner);
  RandomStream random(curve.seed, "path");
  return stimulus::SpatialTrajectory(curve.shape, random).points();
}

void read_points(Table& table, PathParameters& p) {
  const bool both = table.has("points") && table.has("curve");
  if (both) {
    table.reject("curve", "stands beside points; keep one of the two");
    static_cast<void>(read_vectors(table, "points", kPlaceBounds, "m"));
  }
  std::vector<Eigen::Vector3d> points =
      table.has("curve") ? read_curve(table) : read_vectors(table, "points", kPlaceBounds, "m");
  const bool moves = std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& each) {
    return each != points.front();
  });
  if (moves) {
    p.points = std::move(points);
  } else {
    table.reject("points", "go nowhere; write two places or more that are not the same");
  }
}

const Schema<PathParameters>& path_schema() {
  using P = PathParameters;
  static const auto schema =
      Schema<P>()
          .custom("points", "Places that a path goes through",
                  [](Table& table, const std::string&, P& p) { read_points(table, p); })
          .required()
          .otherwise("needed; or a curve")
          .number("duration", &P::duration, kDurationBounds, "s",
                  "Duration of a pulse or of a movement")
          .required()
          .keys_of(&P::gains, field_gains_schema());
  return schema;
}

constexpr double kSoft = 0.05;

std::vector<KindOfField>& all_kinds() {
  static std::vector<KindOfField> kinds{
      {"constant", read_plainly<ConstantParameters, constant_schema>, kSoft},
      {"ramp", read_plainly<RampParameters, ramp_schema>, 0.0},
      {"pulse", read_plainly<PulseParameters, pulse_schema>, 0.0},
      {"spring", read_plainly<SpringParameters, spring_schema>, kSoft},
      {"wall", read_wall, kSoft},
      {"box", read_solid_box, kSoft},
      {"sphere", read_solid_sphere, kSoft},
      {"cylinder", read_solid_cylinder, kSoft},
      {"channel", read_channel, kSoft},
      {"plane", read_plainly<PlaneParameters, plane_schema>, kSoft},
      {"viscous", read_plainly<ViscousParameters, viscous_schema>, kSoft},
      {"matrix_viscous", read_plainly<MatrixViscousParameters, matrix_viscous_schema>, kSoft},
      {"inertia", read_plainly<InertiaParameters, inertia_schema>, kSoft},
      {"friction", read_plainly<FrictionParameters, friction_schema>, kSoft},
      {"grating", read_plainly<GratingParameters, grating_schema>, kSoft},
      {"texture", read_plainly<TextureParameters, texture_schema>, kSoft},
      {"vibration", read_vibration, 0.0},
      {"tap", read_tap, 0.0},
      {"detent", read_detent, kSoft},
      {"click", read_click, kSoft},
      {"minimum_jerk", read_plainly<MoverParameters, mover_schema>, 0.0},
      {"path", read_plainly<PathParameters, path_schema>, kSoft},
  };
  return kinds;
}

}  // namespace

const std::vector<KindOfField>& kinds_of_field() { return all_kinds(); }

void add_kind_of_field(const KindOfField& kind) {
  const std::vector<KindOfField>& kinds = all_kinds();
  if (std::ranges::find(kinds, kind.word, &KindOfField::word) != kinds.end()) {
    throw std::invalid_argument(
        fmt::format("add_kind_of_field: there is a field '{}' already", kind.word));
  }
  all_kinds().push_back(kind);
}

const Schema<PdGains>& field_gains_schema() {
  static const auto schema =
      Schema<PdGains>()
          .number("stiffness", &PdGains::stiffness, kStiffnessBounds, "N/m",
                  "Stiffness of the spring that holds the hand, or of the bristles of friction")
          .required()
          .number("damping", &PdGains::damping, kDampingBounds, "N·s/m",
                  "Damping against the hand's motion; a surface's begins over the first 1 mm")
          .required();
  return schema;
}

const Schema<Field>& field_limit_schema() {
  static const auto schema = Schema<Field>().number(
      "limit", &Field::limit, {0.0, 100.0, true}, "N",
      "Greatest force of the field or object; a longer one is shortened to it");
  return schema;
}

const Schema<Field>& field_fade_schema() {
  static const auto schema =
      Schema<Field>()
          .number("fade_in", &Field::fade_in, kFadeBounds, "s",
                  "Time over which the force grows after the field or object is switched on")
          .number("fade_out", &Field::fade_out, kFadeBounds, "s",
                  "Time over which the force goes after the field or object is switched off");
  return schema;
}

}  // namespace haptrial::scene
