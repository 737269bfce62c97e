#include "core/scene/read/read_field.h"
#include "core/base/definition/number_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "core/scene/read/field_kinds.h"
#include "core/scene/read/shape_kinds.h"
#include "core/scene/scene.h"
#include "tests/support/message_of.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kRate = 1000.0;

constexpr const char* kEveryKind = R"([fields]
push     = { type = "constant", force = [1.0, 0.0, 0.0] }
slope    = { type = "ramp", to = [0, 2, 0], rise = 0.5, from = [1, 0, 0] }
knock    = { type = "pulse", force = [0, 2, 0], duration = 0.1, delay = 0.2, rise = 0.02 }
guide    = { type = "spring", to = [0.0, 0.02, 0.0], stiffness = 150.0, damping = 8.0, limit = 3.0 }
floor    = { type = "wall", point = [0, 0, 0], normal = [0, 2, 0], stiffness = 300, damping = 2 }
block    = { type = "box", centre = [0, 0, 0], size = [0.1, 0.05, 0.04], turn = [0, 0.5, 0], felt_from = "inside", stiffness = 300, damping = 2 }
ball     = { type = "sphere", centre = [0, 0, 0], radius = 0.02, stiffness = 300, damping = 2 }
bar      = { type = "cylinder", centre = [0, 0, 0], axis = [0, 0, 1], radius = 0.02, length = 0.1, stiffness = 300, damping = 2 }
table    = { type = "channel", axes = ["x", "z"], through = [0.0, 0.01, 0.0], stiffness = 1000.0, damping = 15.0 }
clamp    = { type = "channel", from = [0, 0, 0], to = [0, 0, -0.1], stiffness = 2000.0, damping = 30.0 }
sheet    = { type = "plane", through = [0, 0, 0], normal = [0, 1, 0], stiffness = 1000.0, damping = 15.0 }
oil      = { type = "viscous", damping = 5.0, velocity_filter = 40.0 }
curl     = { type = "matrix_viscous", matrix = [[0, 0, 13.0], [0, 0, 0], [-13.0, 0, 0]], velocity_filter = 30.0, limit = 8.0, fade_in = 0.0 }
mass     = { type = "inertia", mass = 0.3, acceleration_filter = 20.0 }
rub      = { type = "friction", on = "floor", static = 0.6, dynamic = 0.4, stiffness = 1500 }
dry      = { type = "friction", static = 1.0, dynamic = 1.0, model = "dahl" }
ridges   = { type = "grating", on = "floor", direction = [1, 0, 0], amplitude = 0.0003, period = 0.003, profile = "rounded" }
rough    = { type = "texture", on = "ball", normal = [0, 1, 0], roughness = 0.0001, lowest = 100, highest = 800, seed = 7 }
hum      = { type = "vibration", direction = [0, 1, 0], amplitude = 0.5, frequency = 120.0 }
hiss     = { type = "vibration", direction = [0, 1, 0], rms = 0.3, lowest = 50.0, highest = 150.0, seed = 3 }
tap      = { type = "tap", on = "floor", amplitude = 5.0, frequency = 200.0, decay = 0.01 }
notch    = { type = "detent", at = [0, 0, 0], direction = [1, 0, 0], spacing = 0.01, peak = 1.0, count = 5 }
key      = { type = "click", at = [0, 0, 0], direction = [0, -1, 0], peak = 2.0, travel = 0.003, drop = 1.2, drop_travel = 0.0005 }
return   = { type = "minimum_jerk", to = [0, 0, 0], duration = 0.8, stiffness = 300.0, damping = 20.0 }
lead     = { type = "path", points = [[0, 0, 0], [0.03, 0, 0], [0.03, 0, 0.04]], duration = 2.0, stiffness = 900.0, damping = 100.0 }
stray    = { type = "path", curve = { length_x = 0.1, range_z = 0.06, seed = 3 }, duration = 9.0, stiffness = 900.0, damping = 100.0 }
rail     = { type = "curve", points = [[0, 0, 0], [0.03, 0, 0], [0.03, 0, 0.04]], stiffness = 900.0, damping = 10.0 }
)";

std::map<std::string, Field> by_name(const std::vector<Field>& fields) {
  std::map<std::string, Field> found;
  for (const Field& field : fields) {
    found[field.name] = field;
  }
  return found;
}

std::vector<Field> read(const std::string& text, const NumberSource* source = nullptr) {
  Table document = Table::parse(text, "x.toml");
  Table plain = document.table("fields");
  Table fields = source != nullptr ? plain.with(*source) : plain;
  std::vector<Field> found = read_fields(fields, kRate);
  document.finish();
  return found;
}

std::string told(const std::string& line, const NumberSource* source = nullptr) {
  return test::message_of([&] { read("[fields]\n" + line + "\n", source); });
}

TEST(ReadFieldTest, EveryKindIsReadAndMakesAScene) {
  const std::vector<Field> fields = read(kEveryKind);
  EXPECT_NO_THROW(Scene(fields, kRate));
  const auto all = by_name(fields);
  EXPECT_EQ(all.size(), 27u);
  EXPECT_EQ(std::get<PathParameters>(all.at("lead").kind).points[2], Vector3d(0.03, 0.0, 0.04));
  EXPECT_EQ(std::get<CurveParameters>(all.at("rail").kind).points[1], Vector3d(0.03, 0.0, 0.0));
  const auto& spring = std::get<SpringParameters>(all.at("guide").kind);
  EXPECT_EQ(spring.to, Vector3d(0.0, 0.02, 0.0));
  EXPECT_EQ(spring.gains.stiffness, 150.0);
  EXPECT_EQ(spring.gains.damping, 8.0);
  EXPECT_EQ(all.at("guide").limit, 3.0);
  EXPECT_EQ(all.at("guide").fade_in, 0.05) << "default";
  EXPECT_EQ(all.at("floor").limit, 10.0) << "default";
  EXPECT_EQ(all.at("curl").fade_in, 0.0);
  EXPECT_EQ(all.at("hum").fade_out, 0.0) << "default of a vibration";
  const auto& curl = std::get<MatrixViscousParameters>(all.at("curl").kind);
  EXPECT_EQ(curl.matrix(0, 2), 13.0);
  EXPECT_EQ(curl.matrix(2, 0), -13.0);
  EXPECT_EQ(curl.velocity_filter, 30.0);
  const auto& table = std::get<AxisChannelParameters>(all.at("table").kind);
  EXPECT_TRUE(table.free_x && !table.free_y && table.free_z);
  EXPECT_TRUE(std::get<SurfaceParameters>(all.at("block").kind).felt_from_inside);
  EXPECT_TRUE(
      std::holds_alternative<Cylinder>(std::get<SurfaceParameters>(all.at("bar").kind).shape));
  EXPECT_EQ(std::get<FrictionParameters>(all.at("rub").kind).on, "floor");
  EXPECT_EQ(std::get<FrictionParameters>(all.at("dry").kind).model,
            FrictionParameters::Model::kDahl);
  EXPECT_EQ(std::get<NoiseVibrationParameters>(all.at("hiss").kind).seed, 3u);
  EXPECT_EQ(std::get<DetentParameters>(all.at("notch").kind).count, 5);
  EXPECT_EQ(std::get<TextureParameters>(all.at("rough").kind).highest, 800.0);
}

struct Mistake {
  const char* line;
  const char* sentence;
};

TEST(ReadFieldTest, EveryMistakeGetsItsSentence) {
  const std::vector<Mistake> mistakes{
      {R"(a = { type = "sprung" })", "fields.a.type is 'sprung'; did you mean spring?"},
      {R"(a = { force = [1, 0, 0] })", "fields.a.type is missing"},
      {R"(a = { type = "constant", force = [1, 0] })", "three numbers: x, y, z"},
      {R"(a = { type = "constant", force = [101, 0, 0] })", "at most 100 [N]"},
      {R"(a = { type = "constant", force = [1, 0, 0], limit = 0 })",
       "fields.a.limit is 0; allowed: a number above 0 and at most 100 [N]"},
      {R"(a = { type = "constant", force = [1, 0, 0], fade_in = -1 })", "fields.a.fade_in is -1"},
      {R"(a = { type = "constant", force = [1, 0, 0], fadein = 1 })", "fade_in"},
      {R"(a = { type = "ramp", to = [0, 1, 0], rise = 0 })", "fields.a.rise is 0"},
      {R"(a = { type = "pulse", force = [0, 1, 0], duration = 0.1, rise = 0.06 })",
       "fields.a.rise is 0.06 s; allowed: at most half the duration, 0.05 s"},
      {R"(a = { type = "spring", to = [0, 0, 0], stiffness = -5, damping = 0 })",
       "fields.a.stiffness is -5"},
      {R"(a = { type = "spring", to = [0, 0, 0], stiffness = 5 })", "fields.a.damping is missing"},
      {R"(a = { type = "spring", to = [0, 0, 0], stiffness = "$k", damping = 0 })",
       "fields.a.stiffness is '$k'"},
      {R"(a = { type = "wall", point = [0, 0, 0], normal = [0, 0, 0], stiffness = 5, damping = 0 })",
       "fields.a.normal is zero; write a direction"},
      {R"(a = { type = "sphere", centre = [0, 0, 0], radius = 0, stiffness = 5, damping = 0 })",
       "fields.a.radius is 0; allowed: a number above 0 and at most 1 [m]"},
      {R"(a = { type = "sphere", centre = [0, 0, 0], radius = 0.1, felt_from = "both", stiffness = 5, damping = 0 })",
       "felt_from is 'both'"},
      {R"(a = { type = "channel", axes = ["w"], through = [0, 0, 0], stiffness = 5, damping = 0 })",
       "fields.a.axes is an array with \"w\""},
      {R"(a = { type = "channel", axes = ["x", "y", "z"], through = [0, 0, 0], stiffness = 5, damping = 0 })",
       "leaves every axis free"},
      {R"(a = { type = "channel", from = [0, 0, 0], to = [0, 0, 0], stiffness = 5, damping = 0 })",
       "fields.a.to is the same place as from"},
      {R"(a = { type = "matrix_viscous", matrix = [[1, 0], [0, 1]], velocity_filter = 30 })",
       "three rows of three numbers"},
      {R"(a = { type = "matrix_viscous", matrix = [[1, 0, 0], [0, 1, true], [0, 0, 1]], velocity_filter = 30 })",
       "an array with true"},
      {R"(a = { type = "matrix_viscous", matrix = 3.0, velocity_filter = 30 })",
       "fields.a.matrix is 3"},
      {R"(a = { type = "matrix_viscous", matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 5000.0]], velocity_filter = 30 })",
       "an array with 5000"},
      {R"(a = { type = "friction", static = 0.3, dynamic = 0.4 })",
       "fields.a.static is 0.3; allowed: at least dynamic, 0.4"},
      {R"(a = { type = "friction", static = 0.5, dynamic = 0.4, model = "dahl" })",
       "allowed: the same as dynamic, 0.4"},
      {R"(a = { type = "friction", on = "floor", static = 0.5, dynamic = 0.4 })",
       "fields.a.on is \"floor\", but the definition has no wall, box, sphere or cylinder; add "
       "one"},
      {R"(a = { type = "grating", direction = [1, 0, 0], amplitude = 0.001, period = 0.01 })",
       "fields.a.on is missing"},
      {R"(a = { type = "texture", on = "b", normal = [0, 1, 0], roughness = 0.1, lowest = 100, highest = 50, seed = 1.5 })",
       "fields.a.highest is 50; allowed: a number above lowest, 100"},
      {R"(a = { type = "texture", on = "b", normal = [0, 1, 0], roughness = 0.1, lowest = 10, highest = 50, seed = 1.5 })",
       "fields.a.seed is 1.5; allowed: a whole number"},
      {R"(a = { type = "vibration", direction = [0, 1, 0], amplitude = 1, frequency = 500 })",
       "below half the servo loop's rate, 500 Hz"},
      {R"(a = { type = "detent", at = [0, 0, 0], direction = [1, 0, 0], spacing = 0.01, peak = 4, limit = 3 })",
       "fields.a.peak is 4; allowed: at most the limit, 3 [N]"},
      {R"(a = { type = "click", at = [0, 0, 0], direction = [1, 0, 0], travel = 0.01, peak = 1, drop = 2, drop_travel = 0.01 })",
       "fields.a.drop is 2 N; allowed: at most the peak, 1 N"},
      {R"(a = { type = "minimum_jerk", to = [0, 0, 3], duration = 1, stiffness = 5, damping = 0 })",
       "fields.a.to is an array with 3"},
      {"a = 3", "fields.a is 3; allowed: a table"},
  };
  for (const Mistake& mistake : mistakes) {
    EXPECT_THAT(told(mistake.line), HasSubstr(mistake.sentence)) << mistake.line;
  }
}

TEST(ReadFieldTest, AnUnknownTypeIsOneSentence) {
  const std::string sentence = told(R"(a = { type = "sping", to = [0, 0, 0], stiffness = 5 })");
  EXPECT_THAT(sentence, HasSubstr("spring"));
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
}

TEST(ReadFieldTest, AWordThatIsTakenIsNotAddedAgain) {
  EXPECT_THROW(add_kind_of_field({"spring", nullptr}), std::invalid_argument);
}

TEST(ReadFieldTest, WhatAFieldMayLieOnIsNamed) {
  EXPECT_THAT(
      told("floor = { type = \"wall\", point = [0, 0, 0], normal = [0, 1, 0], stiffness = 5, "
           "damping = 0 }\nrub = { type = \"friction\", on = \"flor\", static = 0.5, dynamic = 0.4 "
           "}"),
      HasSubstr("fields.rub.on is \"flor\"; allowed: floor"));
}

/// Variables of a trial, as a later layer knows them.
class Variables final : public NumberSource {
 public:
  double level{0.0};

  std::optional<double> value_of(std::string_view text) const override {
    return text == "$level"    ? std::optional(level)
           : text == "-$level" ? std::optional(-level)
                               : std::nullopt;
  }
  std::optional<Vector3d> vector_of(std::string_view text) const override {
    return text == "$start" ? std::optional(Vector3d(0.0, level, 0.0)) : std::nullopt;
  }
};

constexpr const char* kWithVariables =
    "[fields]\n"
    "a = { type = \"spring\", to = \"$start\", stiffness = \"$level\", damping = 0 }\n"
    "b = { type = \"sphere\", centre = [0, \"$level\", 0.01], radius = \"$level\", stiffness = 1, "
    "damping = 0 }\n"
    "c = { type = \"matrix_viscous\", matrix = [[0, 0, \"$level\"], [0, 0, 0], [\"-$level\", 0, "
    "0]], velocity_filter = 30 }\n";

TEST(ReadFieldTest, TextsAreWorthWhatTheSourceSays) {
  Variables variables;
  for (const double level : {0.02, 0.5}) {  // as in two trials
    variables.level = level;
    const auto all = by_name(read(kWithVariables, &variables));
    const auto& spring = std::get<SpringParameters>(all.at("a").kind);
    EXPECT_EQ(spring.gains.stiffness, level);
    EXPECT_EQ(spring.to.y(), level);
    const auto& ball = std::get<Sphere>(std::get<SurfaceParameters>(all.at("b").kind).shape);
    EXPECT_EQ(ball.centre, Vector3d(0.0, level, 0.01));
    EXPECT_EQ(ball.radius, level);
    const auto& curl = std::get<MatrixViscousParameters>(all.at("c").kind);
    EXPECT_EQ(curl.matrix(0, 2), level);
    EXPECT_EQ(curl.matrix(2, 0), -level);
  }
}

TEST(ReadFieldTest, ValuesOfVariablesAreHeldToTheSameBounds) {
  Variables variables;
  variables.level = 5.0;
  const std::string told = test::message_of([&] { read(kWithVariables, &variables); });
  EXPECT_THAT(told, HasSubstr("fields.b.radius is 5 (\"$level\"); allowed: a number above 0 and at "
                              "most 1 [m]"));
  EXPECT_THAT(told, HasSubstr("fields.a.to is the text \"$start\""));
  EXPECT_THAT(told, HasSubstr("fields.b.centre is 5 (\"$level\")"));
}

TEST(ReadFieldTest, ATextWithoutAWorthIsAMistake) {
  const Variables variables;
  EXPECT_THAT(told("a = { type = \"constant\", force = [0, \"$nothing\", 0] }", &variables),
              HasSubstr("fields.a.force is the text \"$nothing\""));
  EXPECT_THAT(told("a = { type = \"constant\", force = \"$nothing\" }", &variables),
              HasSubstr("fields.a.force is the text \"$nothing\""));
}

TEST(ReadRegionTest, EveryKindIsRead) {
  Table document = Table::parse(R"([regions]
start = { type = "sphere", centre = [0, 0.02, 0], radius = 0.008 }
below = { type = "half_space", point = [0, 0, 0], normal = [0, 1, 0] }
gate  = { type = "box", centre = [0, 0, 0], size = [0.1, 0.02, 0.02] }
tube  = { type = "cylinder", centre = [0, 0, 0], axis = [1, 0, 0], radius = 0.01 }
)",
                                "x.toml");
  Table table = document.table("regions");
  const std::vector<Region> regions = read_regions(table);
  document.finish();
  std::map<std::string, bool> inside;
  for (const Region& region : regions) {
    inside[region.name] = PlacedShape(region.shape).contains({0.04, -0.009, 0.0});
  }
  EXPECT_EQ(inside, (std::map<std::string, bool>{
                        {"below", true}, {"gate", true}, {"start", false}, {"tube", true}}));
}

TEST(ReadRegionTest, MistakesGetTheirSentence) {
  Table document = Table::parse(
      "[regions]\na = { type = \"ball\", radius = 1 }\nb = { type = \"sphere\", centre = [0, 0, "
      "0], "
      "radius = -1 }\n",
      "x.toml");
  Table table = document.table("regions");
  read_regions(table);
  const std::string told = test::message_of([&] { document.finish(); });
  EXPECT_THAT(told, HasSubstr("x.toml:2: regions.a.type is 'ball'"));
  EXPECT_THAT(told, HasSubstr("x.toml:3: regions.b.radius is -1"));
}

/// Places by their names, and one number.
class NamedPlaces final : public NumberSource {
 public:
  std::optional<double> value_of(std::string_view text) const override {
    return text == "$x" ? std::optional(0.05) : std::nullopt;
  }
  std::optional<Vector3d> vector_of(std::string_view text) const override {
    return text == "$start" ? std::optional(Vector3d(0.01, 0.0, 0.0))
           : text == "$far" ? std::optional(Vector3d(3.0, 0.0, 0.0))
                            : std::optional(Vector3d(0.02, 0.0, 0.0));
  }
};

TEST(ReadFieldTest, APathTakesPlacesNumbersAndNames) {
  const std::string rest = ", duration = 1.0, stiffness = 900.0, damping = 10.0 }";
  const NamedPlaces places;
  const auto points = [&](const std::string& list) {
    const auto fields =
        read("[fields]\na = { type = \"path\", points = " + list + rest + "\n", &places);
    return std::get<PathParameters>(fields.front().kind).points;
  };
  const std::vector<Vector3d> expected{{0.01, 0.0, 0.0}, {0.02, 0.0, 0.0}};
  EXPECT_EQ(points("[\"$start\", \"$goal\"]"), expected);
  EXPECT_EQ(points("[[0.01, 0, 0], [\"$x\", 0, 0]]")[1], Vector3d(0.05, 0.0, 0.0));
  const auto said = [&](const std::string& list) {
    return told("a = { type = \"path\", points = " + list + rest, &places);
  };
  EXPECT_THAT(said("[[0, 0, 0], [0, 0]]"), HasSubstr("a list of places, [[x, y, z], …]"));
  EXPECT_THAT(said("[[0, 0, 0], [0, 0, 0]]"), HasSubstr("fields.a.points go nowhere"));
  EXPECT_THAT(said("[0, 0, 0.1]"), HasSubstr("a list of places"));
  EXPECT_THAT(said("[\"$start\", \"$far\"]"), HasSubstr("the text \"$far\"; allowed: "));
  EXPECT_THAT(
      said("[[0, 0, 0], [0, 0, 0.1]], curve = { length_x = 0.1, range_z = 0.05, seed = 1 }"),
      HasSubstr("fields.a.curve stands beside points"));
}

}  // namespace
}  // namespace haptrial::scene
