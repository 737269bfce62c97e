#include "protocols/psychophysics/objects/trial_object.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/deformable/elements/setup_body.h"
#include "core/deformable/springs/constants_table.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/mesh/procedural.h"
#include "protocols/psychophysics/definition/every_value.h"
#include "protocols/psychophysics/objects/deformable_bodies.h"
#include "protocols/psychophysics/objects/seen_bodies.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::protocols {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

std::vector<TrialObject> read(const std::string& text) {
  Table document = Table::parse("[objects]\n" + text + "\n", "x.toml");
  Table table = document.table("objects");
  std::vector<TrialObject> objects = read_objects(table);
  document.finish();
  return objects;
}

double volume(const std::string& text) {
  const std::vector<TrialObject> objects = read("thing = { " + text + " }");
  EXPECT_TRUE(objects.at(0).body->closed) << text;
  return geometry::signed_volume(objects.at(0).body->mesh);
}

/// Volumes of the smooth shapes, which the meshes fall short of by their facets.
TEST(TrialObjectTest, EveryShapeIsClosedAndHasItsVolume) {
  const auto close = [](double found, double exact) {
    EXPECT_LT(found, exact * (1.0 + 1e-12));
    EXPECT_GT(found, exact * (1.0 - 2e-3));
  };
  close(volume("shape = \"sphere\", radius = 0.02"), 4.0 / 3.0 * kPi * 8e-6);
  close(volume("shape = \"ellipsoid\", size = [0.02, 0.04, 0.06]"), 4.0 / 3.0 * kPi * 6e-6);
  close(volume("shape = \"box\", size = [0.02, 0.04, 0.06]"), 48e-6);
  close(volume("shape = \"cylinder\", radius = 0.02, length = 0.05"), kPi * 20e-6);
  close(volume("shape = \"cone\", radius = 0.02, length = 0.06"), kPi * 8e-6);
  close(volume("shape = \"torus\", radius = 0.03, tube = 0.01"), 2.0 * kPi * kPi * 3e-6);
}

TEST(TrialObjectTest, MistakesOfShapes) {
  const auto told = [](const std::string& text) {
    return test::message_of([&] { read("thing = { " + text + " }"); });
  };
  EXPECT_THAT(told("shape = \"sfere\", radius = 0.02"),
              HasSubstr("objects.thing.shape is 'sfere'"));
  EXPECT_THAT(told("shape = \"sphere\""), HasSubstr("objects.thing.radius is missing"));
  EXPECT_THAT(told("shape = \"torus\", radius = 0.01, tube = 0.02"),
              HasSubstr("tube is 0.02 m; allowed: a number below radius, 0.01 m"));
  EXPECT_THAT(told("shape = \"sphere\", radius = 0.02, mesh = \"x.stl\""),
              HasSubstr("stands beside mesh; keep one of the two"));
}

TEST(TrialObjectTest, AMeshIsReadFromBesideTheDefinition) {
  const test::TemporaryFolder folder;
  geometry::write_mesh(folder.path() / "block.ply", geometry::make_box({0.02, 0.03, 0.04}));
  std::vector<TrialObject> objects = read("thing = { mesh = \"block.ply\" }");
  EXPECT_EQ(objects.at(0).body, nullptr);
  load_objects(objects, folder.path());
  EXPECT_NEAR(geometry::signed_volume(objects.at(0).body->mesh), 24e-6, 1e-12);
  objects = read("thing = { mesh = \"absent.ply\" }");
  EXPECT_THAT(test::message_of([&] { load_objects(objects, folder.path()); }),
              AllOf(HasSubstr("objects.thing: "), HasSubstr("absent.ply")));
}

const std::string kObject =
    "[objects.ball]\nshape = \"sphere\"\nradius = 0.02\nstiffness = 600\ndamping = 1\n";

TEST(TrialObjectTest, ADefinitionNamesItsObjectsLikeFields) {
  EXPECT_THAT(problems_of_trials(small_trials(kSmallStaircase, kObject)), IsEmpty());
  EXPECT_THAT(problems_of_trials(small_trials(
                  kSmallStaircase,
                  kObject + "[fields.rub]\ntype = \"friction\"\non = \"ball\"\nstatic = 0.5\n"
                            "dynamic = 0.4\n")),
              IsEmpty());
  EXPECT_THAT(problems_of_trials(small_trials(
                  kSmallStaircase, kObject + "[regions.ball]\ntype = \"sphere\"\ncentre = [0, 0, "
                                             "0]\nradius = 0.01\n")),
              Contains(HasSubstr("objects.ball is the name of a table of [regions] as well")));
}

TEST(TrialObjectTest, AMeshInMillimetresIsNoticed) {
  EXPECT_THAT(problems_of_trials(small_trials(kSmallStaircase, kObject + "scale = 60\n")),
              Contains(AllOf(HasSubstr("objects.ball is 4.16 m large; allowed: 0.0005 to 2 [m]"),
                             HasSubstr("scale = 0.001"))));
  EXPECT_THAT(problems_of_trials(small_trials(kSmallStaircase, kObject + "scale = 0.001\n")),
              Contains(HasSubstr("objects.ball is 6.93e-05 m large")));
}

const std::string kTissue =
    "[objects.tissue]\nkind = \"deformable\"\nshape = \"box\"\nsize = [0.04, 0.02, 0.04]\n"
    "cells = 6\nfelt = [\"top\"]\npoisson = 0.45\n";
const std::string kLump = "[objects.tissue.inclusions.lump]\nradius = 0.004\nyoung = 1e5\n";

std::vector<std::string> problems_of_tissue(const std::string& text) {
  return problems_of_trials(small_trials(kSmallStaircase, kTissue + text));
}

TEST(TrialObjectTest, AMeshInMillimetresThatGivesWayIsNoticed) {
  const test::TemporaryFolder folder;
  geometry::write_mesh(folder / "mm.obj", geometry::make_box({50.0, 50.0, 50.0}));
  for (const char* material :
       {"young = 1e4\npoisson = 0.45\n",
        "model = \"springs\"\nconstants = [1e-3, 0, 2e-3]\ndensity = 1000\n"}) {
    TrialsDefinition definition;
    read_small(small_trials(kSmallStaircase,
                            "[objects.ball]\nkind = \"deformable\"\ncells = 4\nmesh = "
                            "\"mm.obj\"\n" +
                                std::string(material)),
               definition);
    load_objects(definition.objects, folder.path());
    EXPECT_THAT(test::message_of([&] { check_every_value(definition); }),
                AllOf(HasSubstr("objects.ball is 86.6 m large; allowed: 0.0005 to 2 [m]"),
                      HasSubstr("mesh repair --scale 0.001")));
  }
}

TEST(TrialObjectTest, ABodyThatGivesWayIsReadAndItsMistakesAreToldInASentenceEach) {
  EXPECT_THAT(problems_of_tissue("young = 1e4\n" + kLump + "centre = [0, 0, 0]\n"), IsEmpty());
  EXPECT_THAT(problems_of_tissue("young = \"100 * $level\"\n"), IsEmpty());
  EXPECT_THAT(problems_of_tissue("young = 0\n"),
              Contains(HasSubstr("objects.tissue.young is 0; allowed: a number above 0")));
  EXPECT_THAT(problems_of_tissue("young = 1e4\n" + kLump + "centre = [0, 0.008, 0]\n"),
              Contains(HasSubstr("the inclusion lump at (0, 0.008, 0) m with a radius of 0.004 m "
                                 "does not lie within the body")));
  std::string text = kTissue + "young = 1e4\n";
  text.replace(text.find("0.45"), 4, "0.5");
  EXPECT_THAT(
      problems_of_trials(small_trials(kSmallStaircase, text)),
      Contains(HasSubstr(
          "objects.tissue.poisson is 0.5; allowed: a number of at least 0 and at most 0.499")));
  EXPECT_THAT(
      problems_of_tissue("young = 1e4\nfixed = [\"top\"]\n"),
      Contains(HasSubstr("no face can be touched; name a side in `felt` that is not fixed")));
  EXPECT_THAT(problems_of_tissue("young = 1e4\nfixed = [\"down\"]\n"),
              Contains(HasSubstr("left, right, bottom, top, back, front")));
  EXPECT_THAT(problems_of_tissue("young = 1e4\nseen = \"moving\"\n"),
              Contains(HasSubstr("yielding, rest")));
}

const std::string kSpringBody =
    "[objects.tissue]\nkind = \"deformable\"\nshape = \"box\"\nsize = [0.04, 0.02, 0.04]\n"
    "cells = 6\nmodel = \"springs\"\n";

TEST(TrialObjectTest, ABodyOfSpringsIsReadAndItsMistakesAreToldInASentenceEach) {
  const auto problems = [](const std::string& text) {
    return problems_of_trials(small_trials(kSmallStaircase, kSpringBody + text));
  };
  EXPECT_THAT(problems("constants = [1e-3, 0, 2e-3]\ndensity = 1000\n"), IsEmpty());
  EXPECT_THAT(problems("constants = [\"1e-5 * $level\", 0, 2e-3]\ndensity = 1000\n"), IsEmpty());
  EXPECT_THAT(problems("constants = [0, 0, 2e-3]\ndensity = 1000\n"),
              Contains(HasSubstr("constants is [0, 0, 0.002] J; allowed: a number above 0")));
  EXPECT_THAT(problems("constants = [1e-3, 0, 2e-3]\n"),
              Contains(HasSubstr("objects.tissue.density is missing")));
  EXPECT_THAT(problems("density = 1000\n"), Contains(HasSubstr("constants is missing")));
  const std::string jelly = "constants = [1e-3, 0, 2e-3]\ndensity = 1000\n";
  EXPECT_THAT(problems(jelly + "rate = 250\n"), IsEmpty());
  EXPECT_THAT(problems(jelly + "rate = 0\n"),
              Contains(HasSubstr("objects.tissue.rate is 0; allowed")));
  EXPECT_THAT(problems("constants = [1e-3, 0, 2e-3]\ndensity = 1000\nyoung = 1e4\n"),
              Contains(HasSubstr("objects.tissue.young")));
}

TEST(TrialObjectTest, ABodyOfSpringsIsFeltByOneDevice) {
  const std::string devices =
      "[devices.left]\nstart = [0, 0, 0]\n[devices.right]\nstart = [0, 0, 0]\n";
  const std::string springs = kSpringBody + "constants = [1e-3, 0, 2e-3]\ndensity = 1000\n";
  const auto refused = Contains(HasSubstr("objects.tissue.device is missing; name the device"));
  EXPECT_THAT(problems_of_trials(small_trials(kSmallStaircase, devices + springs)), refused);
  EXPECT_THAT(
      problems_of_trials(small_trials(kSmallStaircase, devices + springs + "device = \"left\"\n")),
      testing::Not(refused));
}

/// Lines of validate about a body of springs: its steps, and the cost of a tick.
TEST(TrialObjectTest, WhatABodyOfSpringsTakesIsSaid) {
  scene::DeformableObjectParameters p;
  p.mesh = std::make_shared<const deformable::HapticMesh>(
      deformable::felt_block({0.04, 0.02, 0.04}, 6, {}, "objects.tissue"));
  p.springs = deformable::SpringTissue{{6e-4, 2e-4, 1e-3}, nullptr, 1000.0, 10.0};
  std::vector<scene::Field> fields(1);
  fields[0].name = "tissue";
  fields[0].kind = p;
  prepare_bodies(fields, 1000.0);
  const std::vector<std::string> lines = words_of_bodies(fields, 1000.0, 15.0);
  ASSERT_GE(lines.size(), 2u);
  EXPECT_THAT(lines[0], AllOf(HasSubstr("540 tetrahedra of springs, "), HasSubstr(" ms on a tick"),
                              HasSubstr("the hand of [hand] has 15")));
  EXPECT_THAT(lines[1], HasSubstr("a tick in contact takes "));
  auto& own = std::get<scene::DeformableObjectParameters>(fields[0].kind);
  own.rate = 250.0;
  prepare_bodies(fields, 1000.0);
  EXPECT_THAT(words_of_bodies(fields, 1000.0, 15.0)[1],
              AllOf(HasSubstr("moves 250 times a second, 4 ticks at once"),
                    HasSubstr("felt 4 to 7 ms later")));
  own.rate = 300.0;
  EXPECT_THAT(
      test::message_of([&] { prepare_moving_bodies(fields, 1000.0); }),
      HasSubstr("objects.tissue: rate is 300 Hz; allowed: the 1000 Hz of the loop divided by"));
  own.springs->density = 0.1;
  EXPECT_THAT(test::message_of([&] { prepare_moving_bodies(fields, 1000.0); }),
              HasSubstr("at most 64 are allowed"));
}

/// Elements that move take one step for a window, however long that is.
TEST(TrialObjectTest, WhatABodyOfImplicitElementsTakesIsSaid) {
  scene::DeformableObjectParameters p;
  p.mesh = std::make_shared<const deformable::HapticMesh>(
      deformable::felt_block({0.04, 0.02, 0.04}, 6, {}, "objects.tissue"));
  p.implicit = deformable::ImplicitTissue{{15e3, 0.45, 1000.0, {}}, 10.0};
  p.rate = 250.0;
  std::vector<scene::Field> fields(1);
  fields[0].name = "tissue";
  fields[0].kind = p;
  prepare_bodies(fields, 1000.0);
  const std::vector<std::string> lines = words_of_bodies(fields, 1000.0, 15.0);
  ASSERT_GE(lines.size(), 2u);
  EXPECT_THAT(lines[0],
              HasSubstr("540 tetrahedra of elements, one implicit step of 4 ms; gives no"));
  EXPECT_THAT(lines[1], HasSubstr("moves 250 times a second, 4 ticks at once"));
}

TEST(TrialObjectTest, CalibratedConstantsAreThoseOfABodyOfTheSameCells) {
  const test::TemporaryFolder folder;
  const auto object = [&](int cells, const std::string& size = "[0.04, 0.04, 0.03]") {
    return read("thing = { kind = \"deformable\", shape = \"box\", size = " + size + ", cells = " +
                std::to_string(cells) + ", model = \"springs\", calibrated = \"constants.csv\" }");
  };
  // Constants as haptrial deform calibrate makes them for [body] block = [0.04, 0.04, 0.03].
  const deformable::SpringBody body = deformable::spring_body(
      deformable::block_body({0.04, 0.04, 0.03}, 4), 1000.0, {1.0, 2.0, 3.0});
  deformable::SpringConstants constants = body.constants;
  constants.area[7] = 0.25;
  write_text(folder / "constants.csv", deformable::constants_csv(body, constants));
  std::vector<TrialObject> objects = object(4);
  EXPECT_EQ(objects.at(0).constants, nullptr);
  load_objects(objects, folder.path());
  ASSERT_NE(objects.at(0).constants, nullptr);
  EXPECT_EQ(objects.at(0).constants->area, constants.area);
  EXPECT_EQ(objects.at(0).constants->volume, constants.volume);
  const auto& felt = objects.at(0).felt->tets;
  ASSERT_TRUE(std::ranges::equal(felt.tetrahedra, body.tetrahedra)) << "the same springs";
  objects = object(5);
  EXPECT_THAT(test::message_of([&] { load_objects(objects, folder.path()); }),
              AllOf(HasSubstr("objects.thing: "), HasSubstr("constants.csv:"),
                    HasSubstr("the constants of a body of volume 4.8e-05 m3")));
  objects = object(4, "[0.08, 0.08, 0.06]");  // as many springs
  EXPECT_THAT(test::message_of([&] { load_objects(objects, folder.path()); }),
              HasSubstr("calibrate this one, too"));
}

TEST(TrialObjectTest, ABodyIsSeenAsItIsPressedUnlessItIsToBeSeenAtRest) {
  for (const auto& [text, yielding] : {std::pair("", true), std::pair("seen = \"rest\"\n", false),
                                       std::pair("seen = \"yielding\"\n", true)}) {
    TrialsDefinition d;
    read_small(small_trials(kSmallStaircase, kTissue + "young = 1e4\n" + text), d);
    ASSERT_EQ(d.objects.size(), 1u);
    EXPECT_EQ(d.objects[0].seen_yielding, yielding) << text;
  }
}

std::string three_objects(const std::string& shown) {
  std::string text = small_trials(kSmallStaircase, kObject);
  for (const char* name : {"a", "b"}) {
    text += "[objects." + std::string(name) +
            "]\nshape = \"sphere\"\nradius = 0.02\nstiffness = 600\ndamping = 1\n";
  }
  const std::string stage = "[[stages]]\n";
  return text.replace(text.find(stage), stage.size(), stage + "show = [" + shown + "]\n");
}

TEST(TrialObjectTest, AStageShowsTwoObjectsAtMost) {
  EXPECT_THAT(problems_of_trials(three_objects("\"ball\", \"a\"")), IsEmpty());
  EXPECT_THAT(problems_of_trials(three_objects("\"ball\", \"a\", \"b\"")),
              Contains(HasSubstr("show 3 objects in the stage")));
}

/// A box from the front shows its four sides; turned by 45 degrees about the view's vertical, two
/// more edges.
TEST(OutlineTest, ABoxHasItsEdges) {
  const geometry::Mesh box = geometry::make_box({0.02, 0.04, 0.06});
  SeenObject seen;
  seen.scale = 2.0F;
  const Outline front = outline_of(box, seen, {0.0, 0.0, -1.0});
  double length = 0.0;
  for (const auto& [from, to] : front) {
    length += (to - from).norm();
    EXPECT_NEAR(std::abs(from.x()), 0.02, 1e-9);
    EXPECT_NEAR(std::abs(from.y()), 0.04, 1e-9);
  }
  EXPECT_NEAR(length, 2.0 * (0.04 + 0.08), 1e-9);
  const float half = static_cast<float>(kPi / 8.0);
  seen.turn = {std::cos(half), 0.0F, std::sin(half), 0.0F};
  double turned = 0.0;
  for (const auto& [from, to] : outline_of(box, seen, {0.0, 0.0, -1.0})) {
    turned += (to - from).norm();
  }
  // Seen are two faces of 0.04 by 0.08 and 0.12 by 0.08 that share an edge.
  EXPECT_NEAR(turned, 3.0 * 0.08 + 2.0 * 0.04 + 2.0 * 0.12, 1e-6);
}

/// A sphere's outline lies on its great circle across the view.
TEST(OutlineTest, ASphereHasItsCircle) {
  const geometry::Mesh sphere = geometry::make_sphere(0.02, 32);
  double length = 0.0;
  for (const auto& [from, to] : outline_of(sphere, {}, {0.0, -1.0, 0.0})) {
    length += (to - from).norm();
    EXPECT_LT(std::abs(from.y()), 0.002);
    EXPECT_NEAR(std::hypot(from.x(), from.z()), 0.02, 0.0002);
  }
  EXPECT_GT(length, 2.0 * kPi * 0.02);
  EXPECT_LT(length, 1.6 * 2.0 * kPi * 0.02);  // in zigzag along the facets
}

}  // namespace
}  // namespace haptrial::protocols
